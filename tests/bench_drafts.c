/*
 * bench_drafts.c - from triangles in memory to a finished 512 x 512 picture (eye and shadow rays): a draft of ours, baked and
 * drawn, beside Embree 3 (Wald, Woop, Benthin, Johnson and Ernst 2014), built and drawn. One thread, single-ray calls, the same
 * camera, lights and shading formula; rounds are interleaved, and the ratio printed is the median of the rounds' own ratios.
 * Without Embree, ours alone. Embree takes the widest registers that the machine has; the library those that it was compiled for, of which
 * there may be two programs.
 *
 *      bench_drafts [--rounds N] [--grid N] [--side N] [--tiles N] [SIZE ...]
 *
 * Sizes are tetra's, 4^SIZE triangles, 9 and 11 unless given; tiles are the reach's, 64 unless given, and 0 does without reach
 * and beams.
 */
#include "bench_common.h"

#include "trace/camera.h"
#include "trace/light.h"

#include <inttypes.h>

#if BENCH_EMBREE
#include <embree3/rtcore.h>
#endif

#if ASET_REAL_BITS == 32 && ASET_WITH_DRAFTS

enum { ROUNDS_MAX = 99, ARENA_BYTES = 64 << 20, BEAM_VOXELS = 2048 };

/* A model of one material, as a sink takes it. */
typedef struct model {
    float *points; /* 9 a triangle */
    size_t n, room;
    unsigned filled;
    aset_scene stage;
    aset_sink stage_sink;
    aset_material material;
} model;

static aset_status take_background(void *context, const aset_colour *colour) {
    model *m = context;
    return m->stage_sink.background(m->stage_sink.context, colour);
}

static aset_status take_view(void *context, const aset_view *view) {
    model *m = context;
    return m->stage_sink.view(m->stage_sink.context, view);
}

static aset_status take_light(void *context, const aset_light *light) {
    model *m = context;
    return m->stage_sink.light(m->stage_sink.context, light);
}

static aset_status take_material(void *context, const aset_material *material) {
    model *m = context;
    m->material = *material;
    return ASET_OK;
}

static aset_status take_begin(void *context, uint32_t n_points, bool with_normals) {
    model *m = context;
    if (n_points != 3 || with_normals) {
        return ASET_ERR_UNSUPPORTED;
    }
    if (m->n == m->room) {
        m->room = m->room > 0 ? 2 * m->room : 4096;
        m->points = realloc(m->points, m->room * 9 * sizeof *m->points);
    }
    m->filled = 0;
    return m->points != NULL ? ASET_OK : ASET_ERR_NOMEM;
}

static aset_status take_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    model *m = context;
    float *at = m->points + 9 * m->n + m->filled;
    (void)normal;
    at[0] = point->x;
    at[1] = point->y;
    at[2] = point->z;
    m->filled += 3;
    return ASET_OK;
}

static aset_status take_end(void *context) {
    model *m = context;
    m->n++;
    return ASET_OK;
}

static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    (void)context, (void)centre, (void)radius;
    return ASET_ERR_UNSUPPORTED;
}

static aset_status take_cone(void *context, const aset_vec3 *base, aset_real r, const aset_vec3 *apex, aset_real s) {
    (void)context, (void)base, (void)r, (void)apex, (void)s;
    return ASET_ERR_UNSUPPORTED;
}

/* What one round of one contender took and did. */
typedef struct turn {
    double build_s, draw_s;
    uint64_t rays;
    size_t bytes;
} turn;

typedef struct contest {
    const model *m;
    uint32_t side, grid, tiles;
    void *block;
    uint8_t *ours, *theirs;
} contest;

static bool draw_ours(turn *r, const contest *c) {
    aset_arena arena;
    aset_scratch scratch;
    aset_baker baker;
    aset_bake_options options;
    aset_draft draft;
    aset_picture picture;
    aset_tracer tracer;
    aset_statistics counts;
    bool again = true;
    memset(&options, 0, sizeof options);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = c->grid;
    double start = bench_seconds();
    aset_status status = aset_arena_init(&arena, c->block, ARENA_BYTES);
    status = status == ASET_OK ? aset_scratch_init(&scratch, 1, &arena) : status;
    status = status == ASET_OK ? aset_baker_init(&baker, &arena, &options) : status;
    while (status == ASET_OK && again) {
        aset_sink sink = aset_baker_sink(&baker);
        sink.material(sink.context, &c->m->material);
        sink.background(sink.context, &c->m->stage.background);
        for (uint32_t i = 0; i < c->m->stage.counts.lights; i++) {
            sink.light(sink.context, c->m->stage.lights + i);
        }
        status = aset_baker_triangles(&baker, c->m->points, c->m->n);
        status = status == ASET_OK ? aset_baker_pass(&baker, &again) : status;
    }
    status = status == ASET_OK ? aset_baker_finish(&draft, &baker) : status;
    if (status != ASET_OK) {
        fprintf(stderr, "bench_drafts: the bake: %s\n", aset_status_text(status));
        return false;
    }
    double built = bench_seconds();
    memset(&tracer, 0, sizeof tracer);
    memset(&picture, 0, sizeof picture);
    memset(&counts, 0, sizeof counts);
    aset_reach reach;
    aset_beams beams;
    if (c->tiles > 0) {
        status = aset_reach_init(&reach, &draft, c->tiles, &arena);
        status = status == ASET_OK ? aset_beams_init(&beams, BEAM_VOXELS, &arena) : status;
        tracer.reach = &reach;
        scratch.beams = &beams;
    }
    if (status != ASET_OK) {
        return false;
    }
    tracer.scene = &draft.stage;
    tracer.draft = &draft;
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.depth = 1;
    picture.width = picture.height = c->side;
    picture.pixels = c->ours;
    picture.stride = c->side * 3;
    status = aset_render_rows(&tracer, &c->m->stage.view, &picture, 0, c->side, &scratch, &counts);
    r->build_s = built - start;
    r->draw_s = bench_seconds() - built;
    r->rays = counts.primary + counts.shadow;
    r->bytes = arena.peak;
    return status == ASET_OK;
}

#if BENCH_EMBREE

static RTCScene embree_build(RTCDevice device, const model *m, const uint32_t *corners) {
    RTCScene scene = rtcNewScene(device);
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->points, 0, 12, 3 * m->n);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners, 0, 12, m->n);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcCommitScene(scene);
    return scene;
}

static struct RTCRay embree_ray(aset_vec3 origin, aset_vec3 direction, float t_max) {
    struct RTCRay ray;
    memset(&ray, 0, sizeof ray);
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = t_max;
    ray.mask = UINT32_MAX;
    return ray;
}

/* The library's formula (trace.h), without the highlight: the tetrahedra have none. */
static aset_colour embree_colour(RTCScene top, const model *m, aset_vec3 origin, aset_vec3 direction, uint64_t *rays) {
    struct RTCIntersectContext context;
    struct RTCRayHit hit;
    rtcInitIntersectContext(&context);
    hit.ray = embree_ray(origin, direction, REAL_INFINITY);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ++*rays;
    rtcIntersect1(top, &context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return m->stage.background;
    }
    aset_vec3 normal = aset_vec_unit(vec(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z));
    aset_vec3 point = vec_along(origin, hit.ray.tfar, direction);
    normal = vec_dot(normal, direction) > 0 ? vec_scale(normal, -1) : normal;
    aset_vec3 start = vec_along(point, (vec_largest(point) + hit.ray.tfar) * 32 * REAL_UNIT, normal);
    aset_colour fill = m->material.fill, sum = {R(0.1) * fill.r, R(0.1) * fill.g, R(0.1) * fill.b};
    for (uint32_t i = 0; i < m->stage.counts.lights; i++) {
        light_ray towards;
        if (!aset_light_towards(&towards, &m->stage, m->stage.lights + i, point)) {
            continue;
        }
        aset_real n_dot_l = vec_dot(normal, towards.direction) * m->material.diffuse;
        if (!(n_dot_l > 0)) {
            continue;
        }
        struct RTCRay shadow = embree_ray(start, towards.direction, towards.distance);
        ++*rays;
        rtcOccluded1(top, &context, &shadow);
        if (shadow.tfar >= 0) {
            sum.r += fill.r * n_dot_l * towards.colour.r;
            sum.g += fill.g * n_dot_l * towards.colour.g;
            sum.b += fill.b * n_dot_l * towards.colour.b;
        }
    }
    return sum;
}

static uint8_t to_byte(aset_real x) {
    return (uint8_t)(real_max(0, real_min(x, 1)) * 255 + R(0.5));
}

static bool draw_theirs(turn *r, const contest *c, RTCDevice device, const uint32_t *corners) {
    camera eye;
    double start = bench_seconds();
    RTCScene top = embree_build(device, c->m, corners);
    double built = bench_seconds();
    if (aset_camera_make(&eye, &c->m->stage.view, c->side, c->side) != ASET_OK) {
        return false;
    }
    r->rays = 0;
    for (uint32_t i = 0; i < c->side * c->side; i++) {
        aset_vec3 origin, direction;
        aset_real half = (aset_real)c->side / 2;
        aset_camera_ray(&eye, ((aset_real)(i % c->side) + R(0.5)) / half - 1, ((aset_real)(i / c->side) + R(0.5)) / half - 1,
                        &origin, &direction);
        aset_colour colour = embree_colour(top, c->m, origin, direction, &r->rays);
        c->theirs[3 * i] = to_byte(colour.r);
        c->theirs[3 * i + 1] = to_byte(colour.g);
        c->theirs[3 * i + 2] = to_byte(colour.b);
    }
    r->build_s = built - start;
    r->draw_s = bench_seconds() - built;
    rtcReleaseScene(top);
    return true;
}

#endif

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *x, uint32_t n) {
    qsort(x, n, sizeof *x, ascending);
    return n % 2 == 1 ? x[n / 2] : (x[n / 2 - 1] + x[n / 2]) / 2;
}

/* The median of what is at offset in each round. */
static double median_of(const turn *rounds, uint32_t n, bool draw) {
    double x[ROUNDS_MAX];
    for (uint32_t i = 0; i < n; i++) {
        x[i] = draw ? rounds[i].draw_s : rounds[i].build_s;
    }
    return median(x, n);
}

static void print_round(const char *who, const turn *rounds, uint32_t n, size_t triangles) {
    double build = median_of(rounds, n, false), draw = median_of(rounds, n, true);
    printf("  %-7s build %8.1f ms (%5.1f ns a triangle), draw %6.1f ms, %.2f Mrays/s", who, build * 1e3,
           build * 1e9 / (double)triangles, draw * 1e3, (double)rounds[0].rays / draw / 1e6);
    if (rounds[0].bytes > 0) {
        printf(", %zu bytes at the peak", rounds[0].bytes);
    }
    printf("\n");
}

#if BENCH_EMBREE
static void print_ratios(const turn *ours, const turn *theirs, uint32_t n, const contest *c) {
    double whole[ROUNDS_MAX], rate[ROUNDS_MAX], square = 0;
    size_t n_bytes = (size_t)c->side * c->side * 3;
    for (uint32_t i = 0; i < n; i++) {
        whole[i] = (theirs[i].build_s + theirs[i].draw_s) / (ours[i].build_s + ours[i].draw_s);
        rate[i] = (double)ours[i].rays / ours[i].draw_s / ((double)theirs[i].rays / theirs[i].draw_s);
    }
    for (size_t i = 0; i < n_bytes; i++) {
        square += ((double)c->ours[i] - c->theirs[i]) * ((double)c->ours[i] - c->theirs[i]);
    }
    printf("  ours is finished %.2f times as fast; its rays a second are %.2f times Embree's; the pictures' PSNR is %.1f dB\n",
           median(whole, n), median(rate, n), 10 * log10(255.0 * 255.0 * (double)n_bytes / square));
}
#endif

static bool compete(uint32_t size, uint32_t rounds, uint32_t grid, uint32_t side, uint32_t tiles) {
    static turn ours[ROUNDS_MAX], theirs[ROUNDS_MAX];
    model m;
    aset_arena arena;
    static uint64_t stage_block[512];
    const aset_counts limits = {0, 0, 0, 0, 0, 0, 16, 0};
    aset_sink sink = {&m, take_background, take_view, take_light, take_material, take_begin, take_point, take_end, take_sphere,
                      take_cone};
    contest c = {&m, side, grid, tiles, malloc(ARENA_BYTES), malloc((size_t)side * side * 3), malloc((size_t)side * side * 3)};
    memset(&m, 0, sizeof m);
    if (c.block == NULL || c.ours == NULL || c.theirs == NULL || aset_arena_init(&arena, stage_block, sizeof stage_block) != ASET_OK ||
        aset_scene_init(&m.stage, &arena, &limits) != ASET_OK) {
        return false;
    }
    m.stage_sink = aset_scene_sink(&m.stage);
    bool fine = aset_procedural_find("tetra")->emit(&sink, size) == ASET_OK;
    printf("tetra %" PRIu32 ": %zu triangles, %" PRIu32 " divisions, %" PRIu32 " rounds\n", size, m.n, grid, rounds);
    memset(c.block, 1, ARENA_BYTES);
#if BENCH_EMBREE
    RTCDevice device = rtcNewDevice("threads=1,frequency_level=simd256");
    uint32_t *corners = malloc(3 * m.n * sizeof *corners);
    for (size_t i = 0; corners != NULL && i < 3 * m.n; i++) {
        corners[i] = (uint32_t)i;
    }
    fine = fine && corners != NULL && device != NULL;
#endif
    for (uint32_t i = 0; i < rounds && fine; i++) {
        fine = draw_ours(&ours[i], &c);
#if BENCH_EMBREE
        fine = fine && draw_theirs(&theirs[i], &c, device, corners);
#endif
    }
    if (fine) {
        print_round("libaset", ours, rounds, m.n);
#if BENCH_EMBREE
        print_round("Embree", theirs, rounds, m.n);
        print_ratios(ours, theirs, rounds, &c);
#endif
    }
#if BENCH_EMBREE
    free(corners);
    rtcReleaseDevice(device);
#endif
    (void)theirs;
    free(m.points);
    free(c.block);
    free(c.ours);
    free(c.theirs);
    return fine;
}

int main(int argc, char **argv) {
    uint32_t rounds = 7, grid = 64, side = 512, tiles = 64;
    int i = 1;
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
        uint32_t *at = strcmp(argv[i], "--rounds") == 0 ? &rounds : strcmp(argv[i], "--grid") == 0 ? &grid :
                       strcmp(argv[i], "--tiles") == 0 ? &tiles : &side;
        *at = (uint32_t)strtoul(argv[i + 1], NULL, 10);
    }
    rounds = rounds < 1 ? 1 : rounds > ROUNDS_MAX ? ROUNDS_MAX : rounds;
#if !BENCH_EMBREE
    printf("built without Embree: ours alone\n");
#endif
#ifdef BENCH_BUILD
    printf("the library compiled with %s:\n", BENCH_BUILD);
#endif
    bool fine = true;
    if (i == argc) {
        fine = compete(9, rounds, grid, side, tiles) && compete(11, rounds, grid, side, tiles);
    }
    for (; i < argc && fine; i++) {
        fine = compete((uint32_t)strtoul(argv[i], NULL, 10), rounds, grid, side, tiles);
    }
    return fine ? 0 : 1;
}

#else

int main(void) {
    printf("bench_drafts wants float and drafts\n");
    return 0;
}

#endif
