/*
 * scene.h - what there is: entities, the sinks that take them, and the scene built from them.
 *
 * Sources (readers, procedural scenes, your own code) emit entities into a sink and know nothing else. Two sinks are here:
 * the scene builder and the counter, which takes the same entities first and tells how much memory the builder will need.
 */
#ifndef ASET_SCENE_H
#define ASET_SCENE_H

#include "aset/arena.h"

ASET_HEADER_BEGIN

/*
 * Where entities go. A source calls the functions in this order: view, background and lights at any time; a material before
 * the first object, then it holds for every object up to the next material. A polygon is announced with its number of
 * points, then given point by point, then ended, so that no source needs a buffer for the largest one. Every function
 * returns ASET_OK or the error that the source then returns to its caller; after an error of one of its
 * own three functions a polygon in progress is forgotten, as where another object comes before its end.
 */
typedef struct aset_sink {
    void *context; /* the first argument of every function */
    aset_status (*background)(void *context, const aset_colour *colour);
    aset_status (*view)(void *context, const aset_view *view);
    aset_status (*light)(void *context, const aset_light *light);
    aset_status (*material)(void *context, const aset_material *material);
#if ASET_WITH_POLYGONS
    /* n_points 3 or more, in order, counter-clockwise seen from the front, in one plane; may be concave */
    aset_status (*polygon_begin)(void *context, uint32_t n_points, bool with_normals);
    /* normal: of any length but 0 for a patch (0 is taken as the polygon's own normal), NULL for a plain polygon */
    aset_status (*polygon_point)(void *context, const aset_vec3 *point, const aset_vec3 *normal);
    aset_status (*polygon_end)(void *context);
#endif
#if ASET_WITH_SPHERES
    /* A negative radius: only the inside is visible. */
    aset_status (*sphere)(void *context, const aset_vec3 *centre, aset_real radius);
#endif
#if ASET_WITH_CONES
    /* Open at both ends; equal radii make a cylinder; both negative: only the inside is visible. */
    aset_status (*cone)(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                        aset_real apex_radius);
#endif
} aset_sink;

#if ASET_WITH_POLYGONS
/* Emits one polygon of n_points points; normals is NULL or as many. The sink's first error, or ASET_OK. */
aset_status aset_sink_polygon(const aset_sink *sink, const aset_vec3 *points, const aset_vec3 *normals,
                              uint32_t n_points);
#endif

/* How many there are of each; objects is the sum of the four kinds. */
typedef struct aset_counts {
    uint32_t objects, polygons, patches, spheres, cones, materials, lights;
    uint64_t coordinates; /* real numbers that the objects' shapes need, see ASET_COORDINATES_... */
} aset_counts;

/*
 * Real numbers that one object's shape takes in the scene: a polygon of more than three points keeps its normal, one of more
 * than eight its box too, which is quicker to look at than its edges.
 */
#define ASET_COORDINATES_POLYGON(n_points) (3u * (n_points) + ASET_OUTLINE_HEAD(n_points))
#define ASET_COORDINATES_PATCH(n_points) (6u * (n_points) + ASET_OUTLINE_HEAD(n_points))
#define ASET_OUTLINE_HEAD(n_points) ((n_points) > 8 ? 9u : (n_points) > 3 ? 3u : 0u)
#define ASET_COORDINATES_SPHERE 4u
#define ASET_COORDINATES_CONE 8u

/* Bytes in the arena of a scene of so many objects, coordinates, materials and lights: a constant expression. */
#define ASET_BYTES_SCENE(objects, coordinates, materials, lights)                                                      \
    (ASET_ROUND((size_t)(objects) * sizeof(aset_object)) + ASET_ROUND((size_t)(coordinates) * sizeof(aset_real)) +     \
     ASET_ROUND((size_t)(materials) * sizeof(aset_material)) + ASET_ROUND((size_t)(lights) * sizeof(aset_light)))

/* Materials kept in mind while entities arrive: one equal to any of the last ASET_RECENT stored ones is not stored again. */
#ifndef ASET_RECENT
#define ASET_RECENT 16u
#endif
#if ASET_RECENT < 1 || (ASET_RECENT != 16 && !ASET_HOSTILE)
#error "ASET_RECENT is 16, for scenes are of one size in library and program; a hostile build may take any number but 0"
#endif

/* --- The fields of the following structs are private: they are public so that you can hold them. --- */

typedef struct aset_object {
    uint32_t first; /* its first coordinate; its last ends where the next object's begin */
    uint32_t kind_material; /* kind in the low 3 bits, material above */
} aset_object;

typedef struct aset_recent_materials {
    aset_material list[ASET_RECENT]; /* material number k stands at k % ASET_RECENT until a newer one takes its place */
    aset_material pending;           /* the last one given; it is stored when an object uses it */
    uint32_t n, current;             /* stored so far; the number of the current one */
    bool has_pending, has_current;
} aset_recent_materials;

typedef struct aset_outline {
    aset_vec3 low, high; /* box of the points given so far */
    uint32_t n_announced, n_given;
    bool open, with_normals;
} aset_outline;

typedef struct aset_counter {
    aset_counts counts; /* readable when the source has ended */
    aset_vec3 low, high; /* box of all objects; low > high while there is none */
    aset_view view;     /* the last one seen */
    bool has_view;
    aset_outline outline;
    aset_recent_materials recent;
} aset_counter;

typedef struct aset_scene {
    aset_counts counts, limits;
    aset_object *objects;
    aset_real *coordinates;
    aset_material *materials;
    aset_light *lights;
    aset_colour background;
    aset_view view;
    bool has_view;
    uint32_t n_uncoloured; /* lights without a colour of their own */
    aset_real scale;  /* a power of two, 1 unless the box is very large or small: coordinates, and the three fields below, are
                         kept times this */
    aset_real margin; /* by which the boxes of objects are grown against rounding */
    aset_vec3 low, high;
    aset_outline outline;
    aset_recent_materials recent;
} aset_scene;

/* --- end of private fields --- */

/* Prepares counter and gives a sink that counts what it takes and checks it like the scene builder does. No memory. */
aset_sink aset_counter_sink(aset_counter *counter);

/*
 * Takes ASET_BYTES_SCENE(limits->objects, limits->coordinates, limits->materials, limits->lights) bytes from the arena for a
 * scene of at most so many; a counter's counts are the exact limits. The scene starts empty, background black, no view.
 * ASET_ERR_NOMEM: too small an arena; ASET_ERR_LIMIT: more than 2^32 - 2 coordinates or objects, or 2^29 materials or more.
 */
aset_status aset_scene_init(aset_scene *scene, aset_arena *arena, const aset_counts *limits);

/*
 * A sink that adds to the scene. Its functions return ASET_ERR_NOMEM where an entity exceeds the limits, ASET_ERR_GEOMETRY
 * for coordinates that are not finite or beyond 10^30 (10^300 in double), polygons of fewer than 3 points or of other than
 * the announced number, spheres of radius 0, cones without length, without any radius or with radii of different sign, and
 * ASET_ERR_ARGUMENT for an object before any material; the scene then is as before that entity. A polygon without area is
 * kept, and no ray hits it.
 */
aset_sink aset_scene_sink(aset_scene *scene);

/* The box of all objects, a stage's (flat.h) too, which holds none. False, and the box untouched, while there is none. */
bool aset_scene_bounds(const aset_scene *scene, aset_vec3 *low, aset_vec3 *high);

/*
 * Gives what is in the scene to a sink: a scene is a source, too. Directions are of unit length, as the scene keeps them, and
 * in a scene beyond 2^48 what is smaller than its own numbers can hold has lost bits, or all length.
 * ASET_OK, or the sink's first error.
 */
aset_status aset_scene_emit(const aset_sink *sink, const aset_scene *scene);

/* The box of one object (number below counts.objects), without any margin: a cone's is the exact box of its two discs. */
void aset_object_bounds(const aset_scene *scene, uint32_t object, aset_vec3 *low, aset_vec3 *high);

ASET_HEADER_END
#endif
