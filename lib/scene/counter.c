/*
 * counter.c - the measuring pass: a sink that keeps counts and a box, and no entity.
 *
 * Invariant: counts are exactly the limits with which the scene builder takes the same entities.
 */
#include "scene/entity.h"
#include "scene/shape.h"

#include <string.h>

static aset_status count_background(void *context, const aset_colour *colour) {
    (void)context;
    return aset_entity_check_colour(colour);
}

static aset_status count_view(void *context, const aset_view *view) {
    aset_counter *counter = context;
    aset_status status = aset_entity_check_view(view);
    if (status == ASET_OK) {
        counter->view = *view;
        counter->has_view = true;
    }
    return status;
}

static aset_status count_light(void *context, const aset_light *light) {
    aset_counter *counter = context;
    aset_status status = aset_entity_check_light(light);
    if (status == ASET_OK) {
        counter->counts.lights++;
    }
    return status;
}

static aset_status count_material(void *context, const aset_material *material) {
    aset_counter *counter = context;
    aset_status status = aset_entity_check_material(material);
    if (status == ASET_OK) {
        counter->recent.pending = *material;
        counter->recent.has_pending = true;
    }
    return status;
}

#if ASET_WITH_OBJECTS
static aset_status count_object(aset_counter *counter, uint64_t coordinates, aset_vec3 low, aset_vec3 high) {
    bool is_new;
    counter->outline.open = false; /* a polygon in progress is abandoned, as the builder abandons it */
    if (counter->counts.objects == UINT32_MAX - 1) {
        return ASET_ERR_LIMIT;
    }
    aset_status status = aset_entity_use_material(&counter->recent, UINT32_MAX, &is_new);
    if (status != ASET_OK) {
        return status;
    }
    counter->counts.materials += is_new;
    counter->low = counter->counts.objects == 0 ? low : vec_min(counter->low, low);
    counter->high = counter->counts.objects == 0 ? high : vec_max(counter->high, high);
    counter->counts.objects++;
    counter->counts.coordinates += coordinates;
    return ASET_OK;
}
#endif

#if ASET_WITH_POLYGONS
static aset_status count_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_counter *counter = context;
    aset_status status = aset_outline_begin(&counter->outline, n_points, with_normals);
    if (status == ASET_OK && !counter->recent.has_pending && !counter->recent.has_current) { /* here, as the builder refuses it */
        counter->outline.open = false;
        status = ASET_ERR_ARGUMENT;
    }
    return status;
}

static aset_status count_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    aset_counter *counter = context;
    return aset_outline_point(&counter->outline, point, normal);
}

static aset_status count_polygon_end(void *context) {
    aset_counter *counter = context;
    const aset_outline *outline = &counter->outline;
    uint64_t n = outline->n_given;
    aset_status status = aset_outline_end(&counter->outline);
    if (status == ASET_OK) {
        status = count_object(counter, outline->with_normals ? ASET_COORDINATES_PATCH(n) : ASET_COORDINATES_POLYGON(n),
                              outline->low, outline->high);
    }
    if (status == ASET_OK) {
        *(outline->with_normals ? &counter->counts.patches : &counter->counts.polygons) += 1;
    }
    return status;
}
#endif

#if ASET_WITH_SPHERES
static aset_status count_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_counter *counter = context;
    aset_real at[ASET_COORDINATES_SPHERE];
    aset_vec3 low, high;
    aset_status status = aset_entity_sphere(at, &low, &high, centre, radius);
    if (status == ASET_OK) {
        status = count_object(counter, ASET_COORDINATES_SPHERE, low, high);
    }
    if (status == ASET_OK) {
        counter->counts.spheres++;
    }
    return status;
}
#endif

#if ASET_WITH_CONES
static aset_status count_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                              aset_real apex_radius) {
    aset_counter *counter = context;
    aset_real at[ASET_COORDINATES_CONE];
    aset_vec3 low, high;
    aset_status status = aset_entity_cone(at, &low, &high, base, base_radius, apex, apex_radius);
    if (status == ASET_OK) {
        status = count_object(counter, ASET_COORDINATES_CONE, low, high);
    }
    if (status == ASET_OK) {
        counter->counts.cones++;
    }
    return status;
}
#endif

aset_sink aset_counter_sink(aset_counter *counter) {
    memset(counter, 0, sizeof *counter);
    counter->low = vec(REAL_INFINITY, REAL_INFINITY, REAL_INFINITY);
    counter->high = vec(-REAL_INFINITY, -REAL_INFINITY, -REAL_INFINITY);
    aset_sink sink;
    sink.context = counter;
    sink.background = count_background;
    sink.view = count_view;
    sink.light = count_light;
    sink.material = count_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = count_polygon_begin;
    sink.polygon_point = count_polygon_point;
    sink.polygon_end = count_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = count_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = count_cone;
#endif
    return sink;
}
