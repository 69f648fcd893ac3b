/*
 * rays.h - what the tests of spaces share: rays of the sorts that walks find hard, scenes that are hard to divide, and
 * duels: a space against brute force on the same rays, bit for bit, and its walk looked into all the way.
 */
#ifndef ASET_TESTS_RAYS_H
#define ASET_TESTS_RAYS_H

#include "support/support.h"

#include "space/walk.h"

/* --- small helpers --- */

aset_vec3 real3(double x, double y, double z);
void set_axis(aset_vec3 *v, int a, aset_real x);
aset_real axis_of(aset_vec3 v, int a);
/* The longest edge of the scene's box; 1 for a scene of no size or without objects. */
double size_of(const aset_scene *scene);
/* A point in the scene's box, grown by so many sizes; without objects in the unit cube. */
dvec random_in_scene(random_state *r, const aset_scene *scene, double grown);
/* The next voxel, x first; false after the last. From 0, 0, 0 on it goes through all. */
bool voxel_next(int32_t v[3], const uint32_t n[3]);

/* --- scenes --- */

typedef struct small_scene {
    const char *name;
    uint32_t size;
} small_scene;

/* Procedural scenes small enough for brute force; the first SPD_SCENES are those of the SPD. */
enum { SPD_SCENES = 7, SMALL_SCENES };
extern const small_scene small_scenes[SMALL_SCENES];

typedef struct far_place {
    double scale;
    dvec offset;
} far_place;

enum { FAR_PLACES = 5 };
extern const far_place far_places[FAR_PLACES];

/* Points times the place's scale, then moved by its offset. */
void model_move(model *m, const far_place *to);
/* Adds n rectangles in one plane across the axis, which with an odd grid also is a slice's. */
void model_in_one_plane(model *m, random_state *r, int axis, uint32_t n);
/* Adds n triangles of no size. */
void model_in_one_point(model *m, aset_vec3 place, uint32_t n);
/* Adds rectangles in whole numbers: in slices of four divisions, in the planes that octrees halve at, and sharing edges. */
void model_in_slices(model *m, random_state *r);

/* --- rays of all sorts --- */

typedef enum ray_sort {
    FROM_OUTSIDE,
    FROM_INSIDE,
    ALONG_AXIS,
    NEARLY_ALONG_AXIS,
    IN_SLICE,
    FROM_SLICE,
    THROUGH_CORNERS,
    ALONG_BOX,
    FROM_WITHIN_OBJECT,
    FROM_SURFACE,
    IN_SURFACE,
    FROM_FAR,
    RAY_SORTS
} ray_sort;

extern const char *const ray_sort_names[RAY_SORTS];

/* Any slice; halving: more often the one in the middle or another that an octree halves at early. */
aset_real random_slice(random_state *r, const aset_space *space, int a, bool halving);
void aim_at(aset_ray *ray, dvec target);
/* Onwards to where it hits this object by itself, if it does. */
bool move_to_hit(aset_ray *ray, const aset_scene *scene, uint32_t object);
/*
 * A ray of those sorts that are the same in every test: FROM_OUTSIDE to FROM_SLICE and ALONG_BOX. For a test's own sorts,
 * and along a box where there is no object, a ray from a point in the scene's box to another. halving: as of random_slice,
 * and a ray in a slice that would have no direction goes either way.
 */
aset_ray random_ray_common(random_state *r, const aset_space *space, ray_sort sort, bool halving);
/* In whole numbers about model_in_slices: straight onto corners and edges. */
aset_ray random_whole_ray(random_state *r);
/* The ray as a query walks it: of unit length, and from outside started near the scene, where margins cover its rounding. */
aset_ray brought_near(const aset_scene *scene, const aset_ray *ray);

/* --- a space against brute force --- */

typedef struct duel {
    const stage *stage;
    aset_tracer brute, other;
    uint8_t *seen; /* by the walk, for each object */
    const char *name;
    uint64_t seed, rays, hits;
    uint32_t depth, leaf; /* as the space was asked for, to be told */
} duel;

#define DUEL_TEXT                                                                                                      \
    "%s %s, " SEED ", ray %" PRIu64 " %s, %" PRIu32 "x%" PRIu32 "x%" PRIu32 ", depth %" PRIu32 ", leaf %" PRIu32
#define DUEL_ARGS(d, sort)                                                                                             \
    aset_method_name((d)->other.space->method), (d)->name, (d)->seed, (d)->rays, ray_sort_names[sort],                 \
        (d)->other.space->slices.n[0], (d)->other.space->slices.n[1], (d)->other.space->slices.n[2], (d)->depth, (d)->leaf

bool same_hit(const aset_hit *a, const aset_hit *b);
/* Do both give the same closest hit, to the last bit, or none? found (may be NULL): b's. */
bool same_closest(const aset_tracer *a, const aset_tracer *b, const aset_ray *ray, bool *found);

void duel_open(duel *d, const stage *s, const aset_space *brute, const aset_space *space);
void duel_close(duel *d);
/*
 * The closest hits must be the same, and at every eighth ray also with the hit's t as t_max. Counts the hits. The statistics
 * (brute's may be NULL) are added to as queries do. Whether there was a hit.
 */
bool duel_closest(duel *d, const aset_ray *ray, ray_sort sort, aset_statistics *brute, aset_statistics *other);

/* --- what a walk goes through --- */

typedef struct inspection {
    walk_request walk; /* first, so that the visitor finds the rest */
    const duel *duel;
    const aset_ray *ray;
    aset_real last_t;
    bool twice, late, backwards;
} inspection;

/* The visitor: keeps which objects were seen. A larger one, whose struct begins with an inspection, may call it. */
aset_real inspect(walk_request *walk, const walk_cell *cell);
/*
 * The exact walk, all the way, of a ray that has been brought near: no object twice, cells in order, and no object met in a
 * cell that begins behind its hit (else a walk that stops at a nearer hit could lose it). in: zeros but for the visitor.
 */
void inspect_walk(inspection *in, duel *d, const aset_ray *ray, ray_sort sort);
/* After it: every object that the ray hits by itself is among those met. */
void inspect_seen(const duel *d, const aset_ray *ray, ray_sort sort);

#endif
