/*
 * support.h - what the tests share: seeded random numbers, models (lists of things that can be emitted again, in either
 * order), guarded blocks, stages (a scene with its spaces in an arena between guard bytes), and inputs for readers.
 *
 * Every random test takes its seed from seed_of, prints it when it fails, and can be run with others: ASET_TEST_SEED=7.
 */
#ifndef ASET_TESTS_SUPPORT_H
#define ASET_TESTS_SUPPORT_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "aset/aset.h"
#include "base/real.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Like assert_true, but says in printf's way what the case was: its seed above all. */
#define check(condition, ...)                                                                                          \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            print_error("not so: %s\n", #condition);                                                                   \
            print_error(__VA_ARGS__);                                                                                  \
            print_error("\n");                                                                                         \
            fail();                                                                                                    \
        }                                                                                                              \
    } while (0)

#define SEED "seed %" PRIu64
#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

/* Long runs were asked for (ASET_LONG=1 in the environment), the full counts of what is promised: `make check-extremes`. */
bool long_run(void);

/* --- random numbers (splitmix64, Steele, Lea and Flood 2014) --- */

typedef struct random_state {
    uint64_t seed, state;
} random_state;

/* The seed of a test's case: the number given, shifted by ASET_TEST_SEED if that is set in the environment. */
uint64_t seed_of(uint64_t number);
random_state random_start(uint64_t seed);
uint64_t random_next(random_state *r);
uint32_t random_below(random_state *r, uint32_t n); /* 0 to n - 1; n > 0 */
double random_between(random_state *r, double low, double high);
bool random_chance(random_state *r, double share);
aset_vec3 random_in_cube(random_state *r, double half_edge);
aset_vec3 random_direction(random_state *r); /* of unit length */
/* A ray without end from a point in a cube, in any direction. (No two random numbers in one expression: it has no order.) */
aset_ray random_ray_from(random_state *r, double half_edge);

/* --- double precision, for independent computations --- */

typedef struct dvec {
    double x, y, z;
} dvec;

dvec dvec_make(double x, double y, double z);
dvec dvec_of(aset_vec3 v);
aset_vec3 dvec_real(dvec v);
dvec dvec_sub(dvec a, dvec b);
dvec dvec_along(dvec a, double s, dvec b); /* a + s b */
double dvec_dot(dvec a, dvec b);
dvec dvec_cross(dvec a, dvec b);
double dvec_length(dvec a);
dvec dvec_unit(dvec a);

/* --- models --- */

enum { THING_POLYGON, THING_PATCH, THING_SPHERE, THING_CONE, THING_KINDS };
enum { THING_POINTS_MAX = 12, MODEL_MATERIALS_MAX = 40, MODEL_LIGHTS_MAX = 40 };

/* One object. A sphere has points[0] and radii[0], a cone points[0], points[1] and radii. */
typedef struct thing {
    unsigned kind;
    uint32_t n_points, material;
    aset_vec3 points[THING_POINTS_MAX], normals[THING_POINTS_MAX];
    aset_real radii[2];
} thing;

typedef struct model {
    thing *things;
    uint32_t n_things, capacity;
    aset_material materials[MODEL_MATERIALS_MAX];
    uint32_t n_materials;
    aset_light lights[MODEL_LIGHTS_MAX];
    uint32_t n_lights;
    aset_colour background;
    bool backwards; /* emit the things from the last to the first */
} model;

/* Whether the library was compiled with this kind of thing. */
bool thing_available(unsigned kind);

/* Starts an empty model with one plain material; free it with model_free. */
void model_start(model *m);
void model_free(model *m);
/* A white, diffuse, opaque, two-sided material to change to one's needs. */
aset_material plain_material(void);
/* Adds a material and makes it the one of the things that follow; its number. */
uint32_t model_material(model *m, const aset_material *material);
/* A point light without a colour of its own. */
void model_light(model *m, aset_vec3 position);
thing *model_sphere(model *m, aset_vec3 centre, double radius);
thing *model_cone(model *m, aset_vec3 base, double base_radius, aset_vec3 apex, double apex_radius);
/* normals is NULL or as many as points */
thing *model_polygon(model *m, const aset_vec3 *points, const aset_vec3 *normals, uint32_t n_points);
/* The rectangle corner, corner + u, corner + u + v, corner + v. */
thing *model_rectangle(model *m, aset_vec3 corner, aset_vec3 u, aset_vec3 v);
/* A thing of any available kind, its middle within half_edge of the origin, of about this size; the last material. */
thing *model_random_thing(model *m, random_state *r, double half_edge, double size);
/* Some materials, and n_things things of sizes from smallest to largest. */
void model_random(model *m, random_state *r, uint32_t n_things, double half_edge, double smallest, double largest);

/* Emits everything; context is a model. A stage_source. */
aset_status model_emit(const aset_sink *sink, const void *context);

/* --- guarded blocks --- */

enum { GUARD_BYTES = 64 };

/* size bytes, aligned for an arena, between guard bytes in one malloc'ed piece. */
typedef struct guarded {
    unsigned char *whole;
    void *block;
    size_t size;
} guarded;

guarded guarded_open(size_t size);
bool guarded_intact(const guarded *g);
void guarded_close(guarded *g); /* asserts that the guards are intact */

/* --- stages --- */

typedef aset_status (*stage_source)(const aset_sink *sink, const void *context);

typedef struct stage {
    guarded memory;
    aset_arena arena;
    aset_counter counter;
    aset_scene scene;
} stage;

/* Counts, then builds a scene, with exactly the counter's limits, in an arena of its own; room bytes are left after it. */
void stage_open(stage *s, stage_source source, const void *context, size_t room);
void stage_open_model(stage *s, const model *m, size_t room);
/* A procedural scene by name; false if the library was compiled without what it needs. */
bool stage_open_procedural(stage *s, const char *name, uint32_t size, size_t room);
/* A space in the stage's arena; asserts success. */
void stage_space(stage *s, aset_space *space, const aset_method *method, uint32_t nx, uint32_t ny, uint32_t nz);
void stage_close(stage *s);

/* A tracer of the scene and a space, the rest zero. */
aset_tracer stage_tracer(const stage *s, const aset_space *space);

/* t of the nearest hit on one object by itself, along a direction of unit length; REAL_INFINITY without one. */
aset_real object_hit(const aset_scene *scene, uint32_t object, aset_vec3 origin, aset_vec3 direction);

/* --- an independent marking of MSET's cells, by the rule alone --- */

/* The voxels that the object's box, grown by its margin, touches: found by going through all slices. */
void expected_box(const aset_space *space, uint32_t object, int32_t low[3], int32_t high[3]);
/* Is the side by which a ray enters this voxel (axis * 2, + 1 going down) on the object's box? */
bool expected_marked(const int32_t low[3], const int32_t high[3], const int32_t voxel[3], uint32_t face);
/* The dense number of a cell as the space keeps it, UINT32_MAX if it is empty. */
uint32_t cell_number(const aset_space *space, const int32_t voxel[3], uint32_t face);

/* --- inputs for readers --- */

typedef struct byte_source {
    const char *bytes;
    size_t size, at, chunk;
    size_t fail_at; /* the callback fails instead of giving the byte of this number */
    bool ended;
} byte_source;

/* The sizes of the pieces in which every input is given. */
extern const size_t chunks[4];

byte_source source_of(const char *bytes, size_t size, size_t chunk);
/* An aset_read; context is a byte_source. Asserts that nobody asks again after the end. */
ptrdiff_t give(void *context, void *buffer, size_t size);

typedef struct bad_case {
    const char *text; /* '@' stands before the byte that the report has to name, and is not part of the input */
    uint32_t line;
    aset_status status;
    const char *token, *what; /* what: a part of the sentence */
} bad_case;

/* The input without its mark, to be freed, its size, and where the mark stood. */
char *bad_input(const bad_case *bad, size_t *size, size_t *offset);

/* Text that grows: the block (old may be NULL, with length and capacity 0) with more behind what is in it. */
char *text_append(char *old, size_t *length, size_t *capacity, const char *more);

/* For compilations without what a file is about. */
void test_support__not_compiled(void **state);

#endif
