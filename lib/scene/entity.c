/* entity.c - the checks of entities, in one place for all sinks. */
#include "scene/entity.h"

#include "scene/shape.h"

#include <string.h>

/*
 * Where a point may be: so that sums and differences of a few, which are all that is computed before a scene is scaled (scene.c),
 * stay within the range of numbers.
 */
#if ASET_REAL_BITS == 32
#define COORDINATE_MAX R(1e30)
#else
#define COORDINATE_MAX R(1e300)
#endif

static bool is_place(aset_vec3 p) {
    return vec_largest(p) <= COORDINATE_MAX && vec_finite(p);
}

/* n numbers, at most MATERIAL_AMOUNTS, of a colour or a material. */
static aset_status check_amounts(const void *amounts, int n) {
    aset_real x[MATERIAL_AMOUNTS];
    bool fine = true;
    memcpy(x, amounts, (size_t)n * sizeof *x);
    for (int i = 0; i < n; i++) {
        fine = fine && x[i] >= 0 && real_finite(x[i]);
    }
    return fine ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_entity_check_colour(const aset_colour *colour) {
    return check_amounts(colour, 3);
}

aset_status aset_entity_check_view(const aset_view *view) {
    if (!is_place(view->from) || !is_place(view->at) || !vec_finite(view->up)) {
        return ASET_ERR_GEOMETRY;
    }
    aset_vec3 along = aset_vec_unit(vec_sub(view->at, view->from));
    if (!(vec_largest(vec_cross(along, aset_vec_unit(view->up))) > 0)) {
        return ASET_ERR_GEOMETRY; /* no direction, no up, or both the same */
    }
    bool perspective = view->height == 0 && view->angle_deg > 0 && view->angle_deg < 180;
    bool orthographic = view->height > 0 && view->height <= COORDINATE_MAX;
    return perspective || orthographic ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_entity_check_light(const aset_light *light) {
    if (!is_place(light->position) || (light->directional && !(vec_largest(light->position) > 0))) {
        return ASET_ERR_GEOMETRY;
    }
    return light->has_colour ? aset_entity_check_colour(&light->colour) : ASET_OK;
}

aset_status aset_entity_check_material(const aset_material *material) {
    return check_amounts(material, MATERIAL_AMOUNTS);
}

aset_status aset_entity_use_material(aset_recent_materials *recent, uint32_t most, bool *is_new) {
    *is_new = false;
    if (!recent->has_pending) {
        return recent->has_current ? ASET_OK : ASET_ERR_ARGUMENT;
    }
    uint32_t oldest = recent->n > ASET_RECENT ? recent->n - ASET_RECENT : 0;
    for (uint32_t k = recent->n; k > oldest; k--) {
        const aset_material *known = &recent->list[(k - 1) % ASET_RECENT];
        if (known->one_sided == recent->pending.one_sided && entity_same_look(known, &recent->pending)) {
            recent->has_pending = false;
            recent->current = k - 1;
            return ASET_OK;
        }
    }
    if (recent->n == most) {
        return ASET_ERR_NOMEM;
    }
    recent->list[recent->n % ASET_RECENT] = recent->pending;
    recent->current = recent->n++;
    recent->has_current = true;
    recent->has_pending = false;
    *is_new = true;
    return ASET_OK;
}

#if ASET_WITH_SPHERES || ASET_WITH_CONES
/* A centre and a radius. */
static bool put_round(aset_real at[4], const aset_vec3 *centre, aset_real radius) {
    at[0] = centre->x;
    at[1] = centre->y;
    at[2] = centre->z;
    at[3] = radius;
    return is_place(*centre) && real_abs(radius) <= COORDINATE_MAX;
}
#endif

#if ASET_WITH_SPHERES
aset_status aset_entity_sphere(aset_real at[ASET_COORDINATES_SPHERE], aset_vec3 *low, aset_vec3 *high, const aset_vec3 *centre,
                               aset_real radius) {
    if (!put_round(at, centre, radius) || radius == 0) {
        return ASET_ERR_GEOMETRY;
    }
    aset_sphere_bounds(at, low, high);
    return ASET_OK;
}
#endif

#if ASET_WITH_CONES
aset_status aset_entity_cone(aset_real at[ASET_COORDINATES_CONE], aset_vec3 *low, aset_vec3 *high, const aset_vec3 *base,
                             aset_real base_radius, const aset_vec3 *apex, aset_real apex_radius) {
    bool finite = put_round(at, base, base_radius) && put_round(at + 4, apex, apex_radius);
    bool one_sign = (base_radius >= 0 && apex_radius >= 0) || (base_radius <= 0 && apex_radius <= 0);
    bool some = base_radius != 0 || apex_radius != 0;
    if (!finite || !one_sign || !some || !(vec_largest(vec_sub(*apex, *base)) > 0)) {
        return ASET_ERR_GEOMETRY;
    }
    aset_cone_bounds(at, low, high);
    return ASET_OK;
}
#endif

aset_status aset_outline_begin(aset_outline *outline, uint32_t n_points, bool with_normals) {
    outline->open = false;
#if !ASET_WITH_PATCHES
    if (with_normals) {
        return ASET_ERR_UNSUPPORTED;
    }
#endif
    if (n_points < 3) {
        return ASET_ERR_GEOMETRY;
    }
    outline->n_announced = n_points;
    outline->n_given = 0;
    outline->with_normals = with_normals;
    outline->open = true;
    return ASET_OK;
}

aset_status aset_outline_point(aset_outline *outline, const aset_vec3 *point, const aset_vec3 *normal) {
    bool fits = outline->open && outline->n_given < outline->n_announced && outline->with_normals == (normal != NULL);
    if (!fits || !is_place(*point) || (normal != NULL && !vec_finite(*normal))) {
        outline->open = false;
        return ASET_ERR_GEOMETRY;
    }
    outline->low = outline->n_given == 0 ? *point : vec_min(outline->low, *point);
    outline->high = outline->n_given == 0 ? *point : vec_max(outline->high, *point);
    outline->n_given++;
    return ASET_OK;
}

aset_status aset_outline_end(aset_outline *outline) {
    bool complete = outline->open && outline->n_given == outline->n_announced;
    outline->open = false;
    return complete ? ASET_OK : ASET_ERR_GEOMETRY;
}
