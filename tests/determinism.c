/*
 * determinism.c - one line for each of some hundred small pictures, to be compared between compilers and machines.
 *
 *     32 gears:1/mset-exact 6d0f...  91c4...  123456
 *     |  scene   case       |        |        bytes that the case took of its arena, at the most
 *     |                     |        all counts: statistics of the rays, and of the structure or the bake
 *     bits of a real        pixels, or for "rays" and "entities" the bits of every number themselves
 *
 * Needs no file: scenes by rule, and models written here for the readers. Hashes are FNV-1a (Fowler, Noll and Vo 1991) of
 * values, lowest byte first, so they say nothing about the machine's byte order. Whatever the arena holds at first, argument
 * 1 of the program (a byte, 0 if it is not given), must not show anywhere either.
 */
#include "aset/aset.h"
#include "aset/load.h"
#include "aset/procedural.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 48, DIVISIONS = 20, BAKED = 24, RAYS = 2000, ARENA_BYTES = 4 << 20, MODEL_SIDE = 9, MODEL_BYTES = 1 << 16 };

static const char *const scenes[] = {"balls:2", "gears:1", "mount:4", "rings:2",  "tetra:4",   "tree:5",
                                     "teapot:3", "snow",   "skull",   "tetra-moon"};
enum { N_SCENES = sizeof scenes / sizeof scenes[0] };

static int fill; /* what the arenas hold before anything is in them */

static void need(bool good, const char *scene, const char *name, const char *why) {
    if (!good) {
        fprintf(stderr, "determinism: %s/%s: %s\n", scene, name, why);
        exit(1);
    }
}

/* --- hashes --- */

typedef uint64_t hash;
#define HASH_START UINT64_C(0xcbf29ce484222325)

static void hash_number(hash *h, uint64_t x, int bytes) {
    for (int i = 0; i < bytes; i++) {
        *h = (*h ^ (x >> (8 * i) & 0xff)) * UINT64_C(0x100000001b3);
    }
}

/* The bits, but all NaN alike: IEEE 754 leaves sign and payload to the machine. */
static void hash_real(hash *h, aset_real x) {
#if ASET_REAL_BITS == 32
    uint32_t bits = 0;
#else
    uint64_t bits = 0;
#endif
    if (x == x) {
        memcpy(&bits, &x, sizeof bits);
    } else {
        bits = ~bits;
    }
    hash_number(h, bits, (int)sizeof bits);
}

static void hash_vec(hash *h, const aset_vec3 *v) {
    hash_real(h, v->x);
    hash_real(h, v->y);
    hash_real(h, v->z);
}

static void hash_colour(hash *h, const aset_colour *c) {
    hash_real(h, c->r);
    hash_real(h, c->g);
    hash_real(h, c->b);
}

static void hash_statistics(hash *h, const aset_statistics *s) {
    const uint64_t all[] = {s->primary,       s->primary_hit, s->shadow,        s->shadow_hit,       s->reflected,
                            s->refracted,     s->secondary_hit, s->curtailed,   s->cells_visited,    s->nonempty_visited,
                            s->tests,         s->test_hits,   s->approx_hits};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        hash_number(h, all[i], 8);
    }
}

static void hash_structure(hash *h, const aset_space *space) {
    const aset_structure *s = &space->structure;
    const uint64_t all[] = {s->interior, s->leaves, s->nonempty, s->references, s->merged};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        hash_number(h, all[i], 8);
    }
}

/* --- a sink that hashes what it is given --- */

static aset_status on_background(void *context, const aset_colour *colour) {
    hash_number(context, 'b', 1);
    hash_colour(context, colour);
    return ASET_OK;
}

static aset_status on_view(void *context, const aset_view *view) {
    hash_number(context, 'v', 1);
    hash_vec(context, &view->from);
    hash_vec(context, &view->at);
    hash_vec(context, &view->up);
    hash_real(context, view->angle_deg);
    hash_real(context, view->height);
    hash_number(context, view->width_px, 4);
    hash_number(context, view->height_px, 4);
    return ASET_OK;
}

static aset_status on_light(void *context, const aset_light *light) {
    hash_number(context, 'l', 1);
    hash_vec(context, &light->position);
    if (light->has_colour) {
        hash_colour(context, &light->colour);
    }
    hash_number(context, light->directional, 1);
    return ASET_OK;
}

static aset_status on_material(void *context, const aset_material *material) {
    hash_number(context, 'f', 1);
    hash_colour(context, &material->fill);
    hash_real(context, material->diffuse);
    hash_real(context, material->specular);
    hash_real(context, material->shine);
    hash_real(context, material->transmittance);
    hash_real(context, material->refraction_index);
    hash_number(context, material->one_sided, 1);
    return ASET_OK;
}

static aset_status on_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    hash_number(context, 'p', 1);
    hash_number(context, n_points, 4);
    hash_number(context, with_normals, 1);
    return ASET_OK;
}

static aset_status on_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    hash_vec(context, point);
    if (normal != NULL) {
        hash_vec(context, normal);
    }
    return ASET_OK;
}

static aset_status on_polygon_end(void *context) {
    hash_number(context, 'e', 1);
    return ASET_OK;
}

static aset_status on_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    hash_number(context, 's', 1);
    hash_vec(context, centre);
    hash_real(context, radius);
    return ASET_OK;
}

static aset_status on_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                           aset_real apex_radius) {
    hash_number(context, 'c', 1);
    hash_vec(context, base);
    hash_real(context, base_radius);
    hash_vec(context, apex);
    hash_real(context, apex_radius);
    return ASET_OK;
}

static aset_sink hash_sink(hash *h) {
    const aset_sink sink = {.context = h,
                            .background = on_background,
                            .view = on_view,
                            .light = on_light,
                            .material = on_material,
                            .polygon_begin = on_polygon_begin,
                            .polygon_point = on_polygon_point,
                            .polygon_end = on_polygon_end,
                            .sphere = on_sphere,
                            .cone = on_cone};
    *h = HASH_START;
    return sink;
}

/* --- scenes --- */

typedef struct source {
    const char *text; /* NAME or NAME:SIZE */
    const aset_procedural *procedural;
    uint32_t size;
    aset_scene scene;
    void *scene_block, *block;
    size_t dirty; /* bytes of block that hold what an earlier case left */
} source;

static void *filled(size_t bytes) {
    void *block = malloc(bytes);
    need(block != NULL, "memory", "malloc", "the machine has no memory left");
    memset(block, fill, bytes);
    return block;
}

static void source_emit(const source *s, const aset_sink *sink) {
    aset_status status = s->procedural->emit(sink, s->size);
    need(status == ASET_OK, s->text, "emit", aset_status_text(status));
}

static void source_open(source *s, const char *text) {
    char name[32];
    const char *colon = strchr(text, ':');
    size_t length = colon != NULL ? (size_t)(colon - text) : strlen(text);
    aset_counter counter;
    aset_arena arena;
    aset_sink sink = aset_counter_sink(&counter);
    memcpy(name, text, length);
    name[length] = '\0';
    s->text = text;
    s->procedural = aset_procedural_find(name);
    s->size = colon != NULL ? (uint32_t)strtoul(colon + 1, NULL, 10) : 0;
    need(s->procedural != NULL, text, "find", "there is no such scene");
    source_emit(s, &sink);
    const aset_counts *n = &counter.counts;
    size_t bytes = ASET_BYTES_SCENE(n->objects, n->coordinates, n->materials, n->lights);
    s->scene_block = filled(bytes);
    aset_status status = aset_arena_init(&arena, s->scene_block, bytes);
    need(status == ASET_OK, text, "arena", aset_status_text(status));
    need(aset_scene_init(&s->scene, &arena, n) == ASET_OK, text, "scene", "its bytes are too few");
    sink = aset_scene_sink(&s->scene);
    source_emit(s, &sink);
}

static void say(const char *scene, const char *name, hash values, hash counts, size_t bytes) {
    printf("%d %s/%s %016" PRIx64 " %016" PRIx64 " %zu\n", ASET_REAL_BITS, scene, name, values, counts, bytes);
}

static void say_entities(const source *s) {
    hash h;
    aset_sink sink = hash_sink(&h);
    source_emit(s, &sink);
    say(s->text, "entities", h, 0, 0);
}

/* --- pictures --- */

typedef struct job {
    const char *name;
    const aset_method *method; /* NULL: the draft is all there is */
    uint32_t divisions;        /* 0: automatic */
    bool approximate, draft, sides, transparent, spd;
    uint32_t level, samples;
    aset_format format;
} job;

static const job jobs[] = {
    {.name = "brute-exact", .method = &aset_brute},
    {.name = "set-exact", .method = &aset_set},
    {.name = "mset-exact", .method = &aset_mset},
    {.name = "grid-exact", .method = &aset_grid},
    {.name = "octree-exact", .method = &aset_octree},
    {.name = "arts-exact", .method = &aset_arts},
    {.name = "excell-exact", .method = &aset_excell},
    {.name = "mset-spd", .method = &aset_mset, .divisions = DIVISIONS, .spd = true},
    {.name = "mset-0", .method = &aset_mset, .divisions = DIVISIONS, .approximate = true},
    {.name = "mset-1", .method = &aset_mset, .divisions = DIVISIONS, .approximate = true, .level = 1},
    {.name = "grid-0", .method = &aset_grid, .divisions = DIVISIONS, .approximate = true},
    {.name = "grid-1", .method = &aset_grid, .divisions = DIVISIONS, .approximate = true, .level = 1},
    {.name = "set-0", .method = &aset_set, .divisions = DIVISIONS, .approximate = true},
    {.name = "set-1", .method = &aset_set, .divisions = DIVISIONS, .approximate = true, .level = 1},
    {.name = "draft-plane", .draft = true},
    {.name = "draft-sides", .draft = true, .sides = true},
    {.name = "draft-1", .method = &aset_mset, .divisions = DIVISIONS, .draft = true, .level = 1},
    {.name = "rgba", .method = &aset_mset, .format = ASET_RGBA8888, .transparent = true, .samples = 2},
    {.name = "rgb565", .draft = true, .format = ASET_RGB565},
    {.name = "grey", .method = &aset_mset, .approximate = true, .level = 1, .format = ASET_GREY8},
};
enum { N_JOBS = sizeof jobs / sizeof jobs[0] };

/* The words of the draft go into values, what the bake did into counts. */
static void bake(aset_draft *draft, hash *values, hash *counts, const source *s, aset_arena *arena, const char *name) {
    static aset_baker baker;
    const aset_bake_options options = {.divisions = {BAKED, BAKED, BAKED}};
    bool again = true;
    aset_status status = aset_baker_init(&baker, arena, &options);
    while (status == ASET_OK && again) {
        aset_sink sink = aset_baker_sink(&baker);
        source_emit(s, &sink);
        status = aset_baker_pass(&baker, &again);
    }
    const aset_bake_report r = baker.report;
    status = status == ASET_OK ? aset_baker_finish(draft, &baker) : status;
    need(status == ASET_OK, s->text, name, aset_status_text(status));
    for (size_t i = 0; i < draft->n_words; i++) {
        hash_number(values, draft->words[i], 4);
    }
    const uint64_t all[] = {draft->n_words, r.objects, r.unseen, r.kept, r.passes, r.voxels, r.facets, r.textures, r.merged};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        hash_number(counts, all[i], 8);
    }
}

static void build(aset_space *space, const source *s, const aset_method *method, uint32_t n, aset_arena *arena,
                  const char *name) {
    const aset_space_options options = {.divisions = {n, n, n}, .reserve = ARENA_BYTES / 4};
    aset_status status = aset_space_build(space, &s->scene, method, &options, arena);
    need(status == ASET_OK, s->text, name, aset_status_text(status));
}

static void hash_pixels(hash *values, const job *j, const unsigned char *pixels, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (j->format == ASET_RGB565) {
            uint16_t pixel;
            memcpy(&pixel, pixels + 2 * i, sizeof pixel);
            hash_number(values, pixel, 2);
        } else {
            for (size_t k = 0; k < aset_format_bytes(j->format); k++) {
                hash_number(values, pixels[aset_format_bytes(j->format) * i + k], 1);
            }
        }
    }
}

/* What the arena holds is put back to fill where the last case wrote, so that every case starts from the same. */
static void arena_open(aset_arena *arena, source *s) {
    memset(s->block, fill, s->dirty);
    need(aset_arena_init(arena, s->block, ARENA_BYTES) == ASET_OK, s->text, "arena", "not an arena");
}

/* At depth 1, ray by ray and then by beams and with a reach: what lies side by side is rounded as what is alone. */
static void draw_by_beams(const source *s, const job *j, aset_tracer tracer, aset_picture picture, uint32_t side, aset_arena *arena) {
    static unsigned char pixels[2][(SIDE + 1) * (SIDE + 1) * 4];
    aset_scratch scratch;
    aset_beams beams;
    aset_reach reach;
    need(aset_scratch_init(&scratch, 1, arena) == ASET_OK && aset_beams_init(&beams, 4096, arena) == ASET_OK &&
             aset_reach_init(&reach, tracer.draft, 32, arena) == ASET_OK,
         s->text, j->name, "no beams");
    tracer.depth = 1;
    memset(pixels, fill, sizeof pixels);
    for (int by_beams = 0; by_beams < 2; by_beams++) {
        picture.pixels = pixels[by_beams];
        scratch.beams = by_beams != 0 ? &beams : NULL;
        tracer.reach = by_beams != 0 ? &reach : NULL;
        aset_status status = aset_render_rows(&tracer, &s->scene.view, &picture, 0, side, &scratch, NULL);
        need(status == ASET_OK, s->text, j->name, aset_status_text(status));
    }
    need(memcmp(pixels[0], pixels[1], sizeof pixels[0]) == 0, s->text, j->name, "another picture by beams");
}

static void draw(source *s, const job *j) {
    static unsigned char pixels[(SIDE + 1) * (SIDE + 1) * 4];
    const uint32_t side = j->spd ? SIDE + 1 : SIDE;
    hash values = HASH_START, counts = HASH_START;
    aset_arena arena;
    aset_space space;
    aset_summary summary;
    aset_draft draft;
    aset_scratch scratch;
    aset_statistics statistics = {0};
    aset_tracer tracer = {.approx_kinds = ASET_ALL_KINDS, .approx_depth = j->level, .curtail = (aset_real)0.5,
                          .draft_sides = j->sides, .samples = j->samples, .spd_rules = j->spd};
    arena_open(&arena, s);
    if (j->draft) {
        bake(&draft, &values, &counts, s, &arena, j->name);
        tracer.draft = &draft;
        tracer.scene = &draft.stage;
    }
    if (j->method != NULL) {
        build(&space, s, j->method, j->divisions, &arena, j->name);
        hash_structure(&counts, &space);
        tracer.scene = &s->scene;
        tracer.space = &space;
    }
    if (j->approximate) {
        need(aset_summary_build(&summary, &space, 0, &arena) == ASET_OK, s->text, j->name, "no summary");
        hash_number(&counts, summary.n_textures, 4);
        hash_number(&counts, summary.merged, 4);
        tracer.summary = &summary;
    }
    need(aset_scratch_init(&scratch, 0, &arena) == ASET_OK, s->text, j->name, "no scratch");
    memset(pixels, fill, sizeof pixels);
    const aset_picture picture = {.width = SIDE, .height = SIDE, .format = j->format, .pixels = pixels,
                                  .stride = side * aset_format_bytes(j->format), .transparent = j->transparent};
    aset_status status = aset_render_rows(&tracer, &s->scene.view, &picture, 0, side, &scratch, &statistics);
    need(status == ASET_OK, s->text, j->name, aset_status_text(status));
    hash_pixels(&values, j, pixels, (size_t)side * side);
    hash_statistics(&counts, &statistics);
    say(s->text, j->name, values, counts, arena.peak);
    if (j->draft) {
        draw_by_beams(s, j, tracer, picture, side, &arena);
    }
    s->dirty = arena.peak;
}

/* --- single rays: every bit of hits and of unclamped colours --- */

/* splitmix64 (Steele, Lea and Flood 2014), as a number from -1 to 1 on 2^-22, exact in float too */
static aset_real drawn(uint64_t *state) {
    uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    x ^= x >> 31;
    return (aset_real)((int32_t)(x >> 41) - (1 << 22)) / (aset_real)(1 << 22);
}

static aset_vec3 drawn_vec(uint64_t *state) {
    aset_vec3 v;
    v.x = drawn(state);
    v.y = drawn(state);
    v.z = drawn(state);
    return v;
}

static void hash_ray(hash *values, hash *counts, const aset_tracer *tracer, const aset_ray *ray, aset_scratch *scratch) {
    aset_hit hit;
    bool found = false;
    aset_colour colour = {0, 0, 0};
    aset_statistics statistics = {0};
    aset_status status = aset_closest_hit(&found, &hit, tracer, ray, false, &statistics);
    hash_number(counts, (uint64_t)(status == ASET_OK), 1);
    if (found) {
        hash_real(values, hit.t);
        hash_vec(values, &hit.point);
        hash_vec(values, &hit.normal);
        hash_vec(values, &hit.geometric);
        hash_number(values, hit.object, 4);
    }
    status = aset_ray_colour(&colour, tracer, ray, scratch, &statistics);
    hash_number(counts, (uint64_t)(status == ASET_OK), 1);
    hash_colour(values, &colour);
    hash_statistics(counts, &statistics);
}

/* From the eye to all sides, and from anywhere around the origin to anywhere. */
static void say_rays(source *s) {
    hash values = HASH_START, counts = HASH_START;
    aset_arena arena;
    aset_space space;
    aset_scratch scratch;
    uint64_t state = 1990;
    arena_open(&arena, s);
    build(&space, s, &aset_mset, DIVISIONS, &arena, "rays");
    need(aset_scratch_init(&scratch, 0, &arena) == ASET_OK, s->text, "rays", "no scratch");
    const aset_tracer tracer = {.scene = &s->scene, .space = &space};
    for (int i = 0; i < RAYS; i++) {
        aset_ray ray;
        ray.origin = i % 2 == 0 ? s->scene.view.from : drawn_vec(&state);
        ray.direction = drawn_vec(&state);
        ray.t_max = (aset_real)1e10;
        hash_ray(&values, &counts, &tracer, &ray, &scratch);
    }
    s->dirty = arena.peak;
    say(s->text, "rays", values, counts, arena.peak);
}

/* --- models: a rough field of MODEL_SIDE x MODEL_SIDE points in every format --- */

typedef struct bytes {
    unsigned char data[MODEL_BYTES];
    size_t n, read;
} bytes;

static void put(bytes *b, uint32_t x, int n, bool big) {
    for (int i = 0; i < n; i++) {
        need(b->n < MODEL_BYTES, "models", "put", "the buffer is too small");
        b->data[b->n++] = (unsigned char)(x >> 8 * (big ? n - 1 - i : i));
    }
}

static void put_float(bytes *b, float x, bool big) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put(b, bits, 4, big);
}

static void put_text(bytes *b, const char *text) {
    for (; *text != '\0'; text++) {
        put(b, (unsigned char)*text, 1, false);
    }
}

/* A decimal that no binary number equals: millionths, and for some an exponent that it is written with. */
static void put_decimal(bytes *b, int32_t millionths) {
    char text[40];
    uint32_t size = millionths < 0 ? (uint32_t)-millionths : (uint32_t)millionths;
    if (size % 3 == 0) {
        snprintf(text, sizeof text, " %s%" PRIu32 "e-6", millionths < 0 ? "-" : "", size);
    } else {
        snprintf(text, sizeof text, " %s%" PRIu32 ".%06" PRIu32, millionths < 0 ? "-" : "", size / 1000000, size % 1000000);
    }
    put_text(b, text);
}

static void point_of(int32_t p[3], int i) {
    uint64_t state = (uint64_t)i + 7;
    p[0] = i % MODEL_SIDE * 333333 - 1234567;
    p[1] = i / MODEL_SIDE * 314159 - 1111111;
    p[2] = (int32_t)(drawn(&state) * 1000000);
}

/* The corners of triangle k: two for each square of the field. */
static void corners_of(int corners[3], int k) {
    int square = k / 2, i = square / (MODEL_SIDE - 1) * MODEL_SIDE + square % (MODEL_SIDE - 1);
    corners[0] = i;
    corners[1] = k % 2 == 0 ? i + 1 : i + MODEL_SIDE + 1;
    corners[2] = k % 2 == 0 ? i + MODEL_SIDE + 1 : i + MODEL_SIDE;
}
enum { N_POINTS = MODEL_SIDE * MODEL_SIDE, N_TRIANGLES = 2 * (MODEL_SIDE - 1) * (MODEL_SIDE - 1) };

static void put_triangles_as_text(bytes *b, bool nff) {
    int32_t p[3];
    for (int i = 0; i < (nff ? 3 * N_TRIANGLES : N_POINTS); i++) {
        int corners[3];
        corners_of(corners, i / 3);
        put_text(b, !nff ? "v" : i % 3 == 0 ? "p 3\n" : "");
        point_of(p, nff ? corners[i % 3] : i);
        for (int a = 0; a < 3; a++) {
            put_decimal(b, p[a]);
        }
        put_text(b, "\n");
    }
    for (int k = 0; !nff && k < N_TRIANGLES; k++) {
        char text[60];
        int corners[3];
        corners_of(corners, k);
        snprintf(text, sizeof text, "f %d %d %d\n", corners[0] + 1, corners[1] + 1, corners[2] + 1);
        put_text(b, text);
    }
}

static void put_point(bytes *b, int i, bool big) {
    int32_t p[3];
    point_of(p, i);
    for (int a = 0; a < 3; a++) {
        put_float(b, (float)p[a] / 1048576, big); /* exact, whatever float arithmetic the machine has */
    }
}

static void write_nff(bytes *b) {
    put_text(b, "b 0.078 0.361 0.753\nv\nfrom 2.1 1.3 1.7\nat 0 0 1e-1\nup 0 0 1\nangle 45.1\nhither 0.01\n"
                "resolution 48 48\nl 4.1 3.2 2.3\nf 0.1 0.75 0.33 0.8 0.2 3.0827007755568205 0.7 1.3\n"
                "s 0.1 0.2 0.3 0.333333333333333333333333\nc 1e-7 .1 -.2 1.1\n4.4e0 5 6 0\n");
    put_triangles_as_text(b, true);
}

static void write_obj(bytes *b) {
    put_triangles_as_text(b, false);
}

static void write_stl(bytes *b) {
    for (int i = 0; i < 80; i++) {
        put(b, ' ', 1, false);
    }
    put(b, N_TRIANGLES, 4, false);
    for (int k = 0; k < N_TRIANGLES; k++) {
        int corners[3];
        corners_of(corners, k);
        for (int i = 0; i < 12; i++) {
            put(b, 0, 1, false); /* the normal */
        }
        for (int i = 0; i < 3; i++) {
            put_point(b, corners[i], false);
        }
        put(b, 0, 2, false);
    }
}

static void write_ply(bytes *b, bool big) {
    char text[300];
    snprintf(text, sizeof text,
             "ply\nformat binary_%s_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n"
             "element face %d\nproperty list uchar ushort vertex_indices\nend_header\n",
             big ? "big" : "little", (int)N_POINTS, (int)N_TRIANGLES);
    put_text(b, text);
    for (int i = 0; i < N_POINTS; i++) {
        put_point(b, i, big);
        put(b, (uint32_t)i * 0x30507u, 3, false);
    }
    for (int k = 0; k < N_TRIANGLES; k++) {
        int corners[3];
        corners_of(corners, k);
        put(b, 3, 1, big);
        for (int i = 0; i < 3; i++) {
            put(b, (uint32_t)corners[i], 2, big);
        }
    }
}

static void write_ply_little(bytes *b) {
    write_ply(b, false);
}

static void write_ply_big(bytes *b) {
    write_ply(b, true);
}

/* In pieces, so that numbers lie across the ends of reads. */
static ptrdiff_t read_bytes(void *context, void *buffer, size_t size) {
    bytes *b = context;
    size_t n = b->n - b->read < 101 ? b->n - b->read : 101;
    n = n < size ? n : size;
    memcpy(buffer, b->data + b->read, n);
    b->read += n;
    return (ptrdiff_t)n;
}

static void say_models(void) {
    typedef aset_status loader(const aset_sink *, aset_read, void *, const aset_load_options *, aset_load_report *);
    static const struct {
        const char *name;
        void (*write)(bytes *b);
        loader *load;
    } models[] = {{"nff", write_nff, aset_load_nff},
                  {"obj", write_obj, aset_load_obj},
                  {"stl", write_stl, aset_load_stl},
                  {"ply-little", write_ply_little, aset_load_ply},
                  {"ply-big", write_ply_big, aset_load_ply}};
    static bytes b;
    static aset_real vertices[N_POINTS * 6];
    const aset_vertex_store store = {.block = vertices, .size = sizeof vertices};
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++) {
        hash h, counts = HASH_START;
        aset_sink sink = hash_sink(&h);
        aset_load_report report;
        memset(&b, fill, sizeof b);
        b.n = b.read = 0;
        models[i].write(&b);
        const aset_load_options options = {.vertices = &store, .size = b.n};
        aset_status status = models[i].load(&sink, read_bytes, &b, &options, &report);
        need(status == ASET_OK, "models", models[i].name, aset_status_text(status));
        hash_number(&counts, report.triangles, 8);
        hash_number(&counts, report.vertices, 8);
        say("models", models[i].name, h, counts, 0);
    }
}

int main(int argc, char **argv) {
    fill = argc > 1 ? (int)(strtoul(argv[1], NULL, 0) & 0xff) : 0;
    for (int i = 0; i < N_SCENES; i++) {
        source s = {.dirty = 0};
        source_open(&s, scenes[i]);
        s.block = filled(ARENA_BYTES);
        say_entities(&s);
        say_rays(&s);
        for (int k = 0; k < N_JOBS; k++) {
            draw(&s, jobs + k);
        }
        free(s.block);
        free(s.scene_block);
    }
    say_models();
    return 0;
}
