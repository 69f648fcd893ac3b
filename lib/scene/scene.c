/*
 * scene.c - the scene builder: entities into four arrays of the arena.
 *
 *   objects      first | kind, material     8 bytes each, in the order of adding
 *   coordinates  a run for each object, in the same order, so that where one ends the next begins
 *   materials    each distinct one (within the last ASET_RECENT) once
 *   lights
 *
 * Coordinates are kept times scene->scale, a power of two: 1 for any ordinary scene, else such that its box's largest is between
 * 2^-24 and 2^48 (in double 2^-192 and 2^384), where products of two differences of coordinates neither overflow nor lose bits to
 * underflow, nor do the products of these and a length. So a scene multiplied by a power of two gives the same picture, bit for
 * bit. As objects come one by one, the scale is changed when the first one comes that is out of its range, twice at the most. Only
 * what is taken counts, as in the counter, from which a flat picture takes its scale: so a polygon in progress keeps the caller's
 * lengths until it is complete, and the scene's box is that of the caller's numbers, scaled.
 *
 * Invariant: counts never exceed limits, and an entity is counted only when it is complete; what an abandoned polygon wrote
 * lies behind the counted coordinates.
 */
#include "base/whole.h"
#include "scene/entity.h"
#include "scene/shape.h"

#include <string.h>

/* Above SCALE_HIGH lengths are kept times SCALE_DOWN, below SCALE_LOW times its inverse. */
#if ASET_REAL_BITS == 32
#define SCALE_LOW R(0x1p-24)
#define SCALE_HIGH R(0x1p48)
#define SCALE_DOWN R(0x1p-72)
#else
#define SCALE_LOW R(0x1p-192)
#define SCALE_HIGH R(0x1p384)
#define SCALE_DOWN R(0x1p-576)
#endif

aset_real aset_scene_scale_for(aset_vec3 low, aset_vec3 high) {
    aset_real largest = real_max(vec_largest(low), vec_largest(high));
    if (largest >= SCALE_HIGH) {
        return SCALE_DOWN;
    }
    return largest >= SCALE_LOW || largest == 0 ? 1 : 1 / SCALE_DOWN;
}

#if ASET_WITH_OBJECTS
static void scale_object(aset_scene *scene, uint32_t object, aset_real factor) {
    shape s = shape_of(scene, object);
    aset_real *at = scene->coordinates + scene->objects[object].first;
#if ASET_WITH_POLYGONS
    if (s.kind == KIND_POLYGON || s.kind == KIND_PATCH) {
        aset_polygon_scale(at, s.n, s.kind == KIND_PATCH ? 6 : 3, factor);
        return;
    }
#endif
    for (uint32_t i = 0; i < s.n; i++) {
        at[i] *= factor;
    }
}

/* Makes the scene's box and scale ready for one more object with this box in the caller's lengths, before it is stored. */
static void make_room(aset_scene *scene, aset_vec3 low, aset_vec3 high) {
    if (scene->counts.objects > 0) {
        aset_real per_scale = 1 / scene->scale;
        low = vec_min(vec_scale(scene->low, per_scale), low);
        high = vec_max(vec_scale(scene->high, per_scale), high);
    }
    aset_real wanted = aset_scene_scale_for(low, high);
    while (scene->scale != wanted) {
        aset_real factor = wanted < scene->scale ? SCALE_DOWN : 1 / SCALE_DOWN;
        for (uint32_t i = 0; i < scene->counts.objects; i++) {
            scale_object(scene, i, factor);
        }
        scene->scale *= factor;
    }
    scene->low = scene_point(scene, low);
    scene->high = scene_point(scene, high);
    scene->margin = aset_object_margin(scene->low, scene->high);
}
#endif

static aset_status take_background(void *context, const aset_colour *colour) {
    aset_scene *scene = context;
    aset_status status = aset_entity_check_colour(colour);
    if (status == ASET_OK) {
        scene->background = *colour;
    }
    return status;
}

static aset_status take_view(void *context, const aset_view *view) {
    aset_scene *scene = context;
    aset_status status = aset_entity_check_view(view);
    if (status == ASET_OK) {
        scene->view = *view;
        scene->has_view = true;
    }
    return status;
}

static aset_status take_light(void *context, const aset_light *light) {
    aset_scene *scene = context;
    aset_status status = aset_entity_check_light(light);
    if (status != ASET_OK) {
        return status;
    }
    if (scene->counts.lights == scene->limits.lights) {
        return ASET_ERR_NOMEM;
    }
    scene->lights[scene->counts.lights] = *light;
    if (light->directional) {
        scene->lights[scene->counts.lights].position = aset_vec_unit(light->position);
    }
    scene->n_uncoloured += !light->has_colour;
    scene->counts.lights++;
    return ASET_OK;
}

static aset_status take_material(void *context, const aset_material *material) {
    aset_scene *scene = context;
    aset_status status = aset_entity_check_material(material);
    if (status == ASET_OK) {
        scene->recent.pending = *material;
        scene->recent.has_pending = true;
    }
    return status;
}

#if ASET_WITH_OBJECTS

/* Is there room for one more object of so many coordinates, and a material for it? */
static aset_status check_room(const aset_scene *scene, uint64_t coordinates) {
    if (!scene->recent.has_pending && !scene->recent.has_current) {
        return ASET_ERR_ARGUMENT;
    }
    bool fits = scene->counts.objects < scene->limits.objects &&
                coordinates <= scene->limits.coordinates - scene->counts.coordinates;
    return fits ? ASET_OK : ASET_ERR_NOMEM;
}

/* The material that the next object uses is stored, if it is not yet. */
static aset_status store_material(aset_scene *scene) {
    bool is_new;
    aset_status status = aset_entity_use_material(&scene->recent, scene->limits.materials, &is_new);
    if (is_new) {
        scene->materials[scene->counts.materials++] = scene->recent.pending;
    }
    return status;
}

static void finish_object(aset_scene *scene, unsigned kind, uint64_t coordinates) {
    aset_object *object = scene->objects + scene->counts.objects;
    object->first = (uint32_t)scene->counts.coordinates;
    object->kind_material = scene->recent.current << KIND_BITS | kind;
    scene->counts.coordinates += coordinates;
    scene->counts.objects++;
}

#endif

#if ASET_WITH_POLYGONS

static uint64_t outline_coordinates(const aset_outline *outline) {
    uint64_t n = outline->n_announced;
    return outline->with_normals ? ASET_COORDINATES_PATCH(n) : ASET_COORDINATES_POLYGON(n);
}

static unsigned outline_stride(const aset_outline *outline) {
    return outline->with_normals ? 6 : 3;
}

/* Where the polygon in progress keeps its points: behind its head. */
static aset_real *outline_points(const aset_scene *scene) {
    return scene->coordinates + scene->counts.coordinates + ASET_OUTLINE_HEAD(scene->outline.n_announced);
}

/* A complete polygon's points, from the caller's lengths to the scene's own. */
static void scale_outline(const aset_scene *scene) {
    aset_real *at = outline_points(scene);
    for (uint32_t i = 0; scene->scale != 1 && i < scene->outline.n_given; i++, at += outline_stride(&scene->outline)) {
        at[0] *= scene->scale;
        at[1] *= scene->scale;
        at[2] *= scene->scale;
    }
}

static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_scene *scene = context;
    aset_status status = aset_outline_begin(&scene->outline, n_points, with_normals);
    if (status == ASET_OK) {
        status = check_room(scene, outline_coordinates(&scene->outline));
        scene->outline.open = status == ASET_OK;
    }
    return status;
}

static aset_status take_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    aset_scene *scene = context;
    aset_outline *outline = &scene->outline;
    uint32_t index = outline->n_given;
    aset_status status = aset_outline_point(outline, point, normal);
    if (status != ASET_OK) {
        return status;
    }
    aset_real *at = outline_points(scene) + (size_t)index * outline_stride(outline);
    at[0] = point->x;
    at[1] = point->y;
    at[2] = point->z;
    if (normal != NULL) {
        aset_vec3 unit = aset_vec_unit(*normal);
        at[3] = unit.x;
        at[4] = unit.y;
        at[5] = unit.z;
    }
    return ASET_OK;
}

static aset_status take_polygon_end(void *context) {
    aset_scene *scene = context;
    aset_outline *outline = &scene->outline;
    aset_status status = aset_outline_end(outline);
    if (status == ASET_OK) {
        status = store_material(scene);
    }
    if (status != ASET_OK) {
        return status;
    }
    make_room(scene, outline->low, outline->high);
    scale_outline(scene);
    aset_polygon_finish(scene->coordinates + scene->counts.coordinates, (uint32_t)outline_coordinates(outline),
                        outline_stride(outline), scene_point(scene, outline->low), scene_point(scene, outline->high));
    finish_object(scene, outline->with_normals ? KIND_PATCH : KIND_POLYGON, outline_coordinates(outline));
    *(outline->with_normals ? &scene->counts.patches : &scene->counts.polygons) += 1;
    return ASET_OK;
}

#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
/* An object that comes whole; a polygon in progress, whose place it takes, is abandoned. */
static aset_status take_whole(aset_scene *scene, unsigned kind, const aset_real *given, uint32_t n, aset_vec3 low, aset_vec3 high) {
    scene->outline.open = false;
    aset_status status = check_room(scene, n);
    if (status == ASET_OK) {
        status = store_material(scene);
    }
    if (status != ASET_OK) {
        return status;
    }
    make_room(scene, low, high);
    aset_real *at = scene->coordinates + scene->counts.coordinates;
    for (uint32_t i = 0; i < n; i++) {
        at[i] = given[i] * scene->scale;
    }
    finish_object(scene, kind, n);
    *(kind == KIND_SPHERE ? &scene->counts.spheres : &scene->counts.cones) += 1;
    return ASET_OK;
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_real at[ASET_COORDINATES_SPHERE];
    aset_vec3 low, high;
    aset_status status = aset_entity_sphere(at, &low, &high, centre, radius);
    return status == ASET_OK ? take_whole(context, KIND_SPHERE, at, ASET_COORDINATES_SPHERE, low, high) : status;
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    aset_real at[ASET_COORDINATES_CONE];
    aset_vec3 low, high;
    aset_status status = aset_entity_cone(at, &low, &high, base, base_radius, apex, apex_radius);
    return status == ASET_OK ? take_whole(context, KIND_CONE, at, ASET_COORDINATES_CONE, low, high) : status;
}
#endif

aset_status aset_scene_init(aset_scene *scene, aset_arena *arena, const aset_counts *limits) {
    if (scene == NULL || arena == NULL || limits == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    if (limits->objects == UINT32_MAX || limits->coordinates >= UINT32_MAX || limits->materials > UINT32_MAX >> KIND_BITS) {
        return ASET_ERR_LIMIT;
    }
    uint64_t bytes = ASET_ROUND_64((uint64_t)limits->objects * sizeof(aset_object)) +
                     ASET_ROUND_64(limits->coordinates * sizeof(aset_real)) +
                     ASET_ROUND_64((uint64_t)limits->materials * sizeof(aset_material)) +
                     ASET_ROUND_64((uint64_t)limits->lights * sizeof(aset_light)); /* ASET_BYTES_SCENE, whatever a size_t holds */
    if (!aset_arena_fits(arena, whole_bytes(bytes))) {
        return ASET_ERR_NOMEM;
    }
    memset(scene, 0, sizeof *scene);
    scene->scale = 1;
    scene->limits = *limits;
    scene->objects = aset_arena_alloc(arena, limits->objects * sizeof *scene->objects, ASET_CATEGORY_OBJECTS);
    scene->coordinates =
        aset_arena_alloc(arena, (size_t)limits->coordinates * sizeof *scene->coordinates, ASET_CATEGORY_VERTICES);
    scene->materials = aset_arena_alloc(arena, limits->materials * sizeof *scene->materials, ASET_CATEGORY_MATERIALS);
    scene->lights = aset_arena_alloc(arena, limits->lights * sizeof *scene->lights, ASET_CATEGORY_MATERIALS);
    return ASET_OK;
}

aset_sink aset_scene_sink(aset_scene *scene) {
    aset_sink sink;
    sink.context = scene;
    sink.background = take_background;
    sink.view = take_view;
    sink.light = take_light;
    sink.material = take_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = take_polygon_begin;
    sink.polygon_point = take_polygon_point;
    sink.polygon_end = take_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = take_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = take_cone;
#endif
    return sink;
}

bool aset_scene_bounds(const aset_scene *scene, aset_vec3 *low, aset_vec3 *high) {
    if (!(scene->margin > 0)) { /* no object has given it one */
        return false;
    }
    *low = vec_scale(scene->low, 1 / scene->scale);
    *high = vec_scale(scene->high, 1 / scene->scale);
    return true;
}
