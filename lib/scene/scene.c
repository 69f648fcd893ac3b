/*
 * scene.c - the scene builder: entities into four arrays of the arena.
 *
 *   objects      first | kind, material     8 bytes each, in the order of adding
 *   coordinates  a run for each object, in the same order, so that where one ends the next begins
 *   materials    each distinct one (within the last ASET_RECENT) once
 *   lights
 *
 * Invariant: counts never exceed limits, and an entity is counted only when it is complete; what an abandoned polygon wrote
 * lies behind the counted coordinates.
 */
#include "scene/entity.h"
#include "scene/shape.h"

#include <string.h>

static aset_status take_background(void *context, const aset_colour *colour) {
    aset_scene *scene = context;
    aset_status status = entity_check_colour(colour);
    if (status == ASET_OK) {
        scene->background = *colour;
    }
    return status;
}

static aset_status take_view(void *context, const aset_view *view) {
    aset_scene *scene = context;
    aset_status status = entity_check_view(view);
    if (status == ASET_OK) {
        scene->view = *view;
        scene->has_view = true;
    }
    return status;
}

static aset_status take_light(void *context, const aset_light *light) {
    aset_scene *scene = context;
    aset_status status = entity_check_light(light);
    if (status != ASET_OK) {
        return status;
    }
    if (scene->counts.lights == scene->limits.lights) {
        return ASET_ERR_NOMEM;
    }
    scene->lights[scene->counts.lights] = *light;
    if (light->directional) {
        scene->lights[scene->counts.lights].position = vec_unit(light->position);
    }
    scene->n_uncoloured += !light->has_colour;
    scene->counts.lights++;
    return ASET_OK;
}

static aset_status take_material(void *context, const aset_material *material) {
    aset_scene *scene = context;
    aset_status status = entity_check_material(material);
    if (status == ASET_OK) {
        scene->recent.pending = *material;
        scene->recent.has_pending = true;
    }
    return status;
}

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
    aset_recent_materials before = scene->recent;
    bool is_new;
    aset_status status = entity_use_material(&scene->recent, &is_new);
    if (status == ASET_OK && is_new) {
        if (scene->counts.materials == scene->limits.materials) {
            scene->recent = before;
            return ASET_ERR_NOMEM;
        }
        scene->materials[scene->counts.materials++] = scene->recent.list[scene->recent.current % ASET_RECENT];
    }
    return status;
}

static void finish_object(aset_scene *scene, unsigned kind, uint64_t coordinates) {
    aset_object *object = scene->objects + scene->counts.objects;
    aset_vec3 low, high;
    object->first = (uint32_t)scene->counts.coordinates;
    object->kind_material = scene->recent.current << KIND_BITS | kind;
    scene->counts.coordinates += coordinates;
    scene->counts.objects++;
    aset_object_bounds(scene, scene->counts.objects - 1, &low, &high);
    bool is_first = scene->counts.objects == 1;
    scene->low = is_first ? low : vec_min(scene->low, low);
    scene->high = is_first ? high : vec_max(scene->high, high);
    scene->margin = object_margin(scene->low, scene->high);
}

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

static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_scene *scene = context;
    aset_status status = outline_begin(&scene->outline, n_points, with_normals);
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
    aset_status status = outline_point(outline, point, normal);
    if (status != ASET_OK) {
        return status;
    }
    aset_real *at = outline_points(scene) + (size_t)index * outline_stride(outline);
    at[0] = point->x;
    at[1] = point->y;
    at[2] = point->z;
    if (normal != NULL) {
        aset_vec3 unit = vec_unit(*normal);
        at[3] = unit.x;
        at[4] = unit.y;
        at[5] = unit.z;
    }
    return ASET_OK;
}

static aset_status take_polygon_end(void *context) {
    aset_scene *scene = context;
    aset_outline *outline = &scene->outline;
    aset_status status = outline_end(outline);
    if (status == ASET_OK) {
        status = store_material(scene);
    }
    if (status != ASET_OK) {
        return status;
    }
    polygon_finish(scene->coordinates + scene->counts.coordinates, (uint32_t)outline_coordinates(outline),
                   outline_stride(outline), outline->low, outline->high);
    finish_object(scene, outline->with_normals ? KIND_PATCH : KIND_POLYGON, outline_coordinates(outline));
    *(outline->with_normals ? &scene->counts.patches : &scene->counts.polygons) += 1;
    return ASET_OK;
}

#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
/* For an object that comes whole; a polygon in progress, whose place it takes, is abandoned. */
static aset_status prepare_whole(aset_scene *scene, uint64_t coordinates) {
    scene->outline.open = false;
    aset_status status = check_room(scene, coordinates);
    return status == ASET_OK ? store_material(scene) : status;
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_scene *scene = context;
    aset_status status = entity_check_sphere(centre, radius);
    if (status == ASET_OK) {
        status = prepare_whole(scene, ASET_COORDINATES_SPHERE);
    }
    if (status != ASET_OK) {
        return status;
    }
    aset_real *at = scene->coordinates + scene->counts.coordinates;
    at[0] = centre->x;
    at[1] = centre->y;
    at[2] = centre->z;
    at[3] = radius;
    finish_object(scene, KIND_SPHERE, ASET_COORDINATES_SPHERE);
    scene->counts.spheres++;
    return ASET_OK;
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    aset_scene *scene = context;
    aset_status status = entity_check_cone(base, base_radius, apex, apex_radius);
    if (status == ASET_OK) {
        status = prepare_whole(scene, ASET_COORDINATES_CONE);
    }
    if (status != ASET_OK) {
        return status;
    }
    const aset_real at[ASET_COORDINATES_CONE] = {base->x, base->y, base->z, base_radius,
                                                 apex->x, apex->y, apex->z, apex_radius};
    memcpy(scene->coordinates + scene->counts.coordinates, at, sizeof at);
    finish_object(scene, KIND_CONE, ASET_COORDINATES_CONE);
    scene->counts.cones++;
    return ASET_OK;
}
#endif

aset_status aset_scene_init(aset_scene *scene, aset_arena *arena, const aset_counts *limits) {
    if (scene == NULL || arena == NULL || limits == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    if (limits->objects == UINT32_MAX || limits->coordinates >= UINT32_MAX || limits->materials > UINT32_MAX >> KIND_BITS) {
        return ASET_ERR_LIMIT;
    }
    if (!aset_arena_fits(arena, ASET_BYTES_SCENE(limits->objects, limits->coordinates, limits->materials, limits->lights))) {
        return ASET_ERR_NOMEM;
    }
    memset(scene, 0, sizeof *scene);
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
    if (scene->counts.objects == 0) {
        return false;
    }
    *low = scene->low;
    *high = scene->high;
    return true;
}
