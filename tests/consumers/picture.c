/*
 * picture.c - what every consumer project draws: examples/smallest.c's scene, so its very bytes, in words that are both C99 and
 * C++11. WITH_SOURCES: the scene comes in as NFF text and a procedural scene is counted, so that both other libraries are linked.
 */
#ifdef AMALGAMATED
#include "aset.h"
#else
#include <aset/aset.h>
#ifdef WITH_SOURCES
#include <aset/load.h>
#include <aset/procedural.h>
#endif
#endif

#include <stdio.h>
#include <string.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

#define SIDE 256
#define CHECK(call)                                                                                                    \
    do {                                                                                                               \
        aset_status status = (call);                                                                                   \
        if (status != ASET_OK) {                                                                                       \
            fprintf(stderr, "%s\n", aset_status_text(status));                                                         \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

static ASET_ARENA_BLOCK(block, 64 * 1024);
static unsigned char row[SIDE * 3];

static int write_row(void *context, uint32_t y, const void *pixels) {
    (void)y;
    return fwrite(pixels, 3, SIDE, (FILE *)context) != SIDE;
}

static aset_vec3 point(double x, double y, double z) {
    aset_vec3 p;
    p.x = (aset_real)x;
    p.y = (aset_real)y;
    p.z = (aset_real)z;
    return p;
}

#ifdef WITH_SOURCES

typedef struct text {
    char bytes[4096];
    size_t length, at;
} text;

static text scene_text;

static ptrdiff_t read_text(void *context, void *buffer, size_t size) {
    text *t = (text *)context;
    size_t n = t->length - t->at < size ? t->length - t->at : size;
    memcpy(buffer, t->bytes + t->at, n);
    t->at += n;
    return (ptrdiff_t)n;
}

static aset_status emit(const aset_sink *sink) {
    text *t = &scene_text;
    aset_load_report report;
    int n = sprintf(t->bytes, "v\nfrom 3 -7 3\nat 0 0 -0.2\nup 0 0 1\nangle 40\nhither 1\nresolution %d %d\n"
                              "b 0.1 0.2 0.4\nl 5 -8 9\nf 1 0.6 0.3 0.8 0.3 20 0 0\n", SIDE, SIDE);
    for (int i = 0; i < 27; i++) {
        n += sprintf(t->bytes + n, "s %d %d %d 0.4\n", i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    }
    n += sprintf(t->bytes + n, "f 0.5 0.7 0.5 0.9 0 0 0 0\ns 0 0 -21.5 20\n");
    t->length = (size_t)n;
    return aset_load_nff(sink, read_text, t, NULL, &report);
}

/* A tetrahedron of 2 levels has 4^2 triangles. */
static aset_status check_procedural(void) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    const aset_procedural *tetra = aset_procedural_find("tetra");
    aset_status status = tetra == NULL ? ASET_ERR_UNSUPPORTED : tetra->emit(&sink, 2);
    return status == ASET_OK && counter.counts.polygons != 16 ? ASET_ERR_GEOMETRY : status;
}

#else

static aset_status emit_material(const aset_sink *sink, double r, double g, double b, double diffuse, double specular, double shine) {
    aset_material material;
    memset(&material, 0, sizeof material);
    material.fill.r = (aset_real)r;
    material.fill.g = (aset_real)g;
    material.fill.b = (aset_real)b;
    material.diffuse = (aset_real)diffuse;
    material.specular = (aset_real)specular;
    material.shine = (aset_real)shine;
    return sink->material(sink->context, &material);
}

static aset_status emit_sphere(const aset_sink *sink, double x, double y, double z, double radius) {
    aset_vec3 centre = point(x, y, z);
    return sink->sphere(sink->context, &centre, (aset_real)radius);
}

static aset_status emit(const aset_sink *sink) {
    aset_colour background;
    aset_light light;
    memset(&light, 0, sizeof light);
    light.position = point(5, -8, 9);
    background.r = (aset_real)0.1f;
    background.g = (aset_real)0.2f;
    background.b = (aset_real)0.4f;
    aset_status status = sink->background(sink->context, &background);
    status = status != ASET_OK ? status : sink->light(sink->context, &light);
    status = status != ASET_OK ? status : emit_material(sink, 1, 0.6, 0.3, 0.8, 0.3, 20);
    for (int i = 0; i < 27 && status == ASET_OK; i++) {
        status = emit_sphere(sink, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1, 0.4);
    }
    status = status != ASET_OK ? status : emit_material(sink, 0.5, 0.7, 0.5, 0.9, 0, 0);
    return status != ASET_OK ? status : emit_sphere(sink, 0, 0, -21.5, 20);
}

#endif

int main(void) {
    aset_arena arena;
    aset_counts limits;
    aset_scene scene;
    aset_space space;
    aset_space_options options;
    aset_summary summary;
    aset_scratch scratch;
    aset_view view;
    aset_tracer tracer;
    aset_picture picture;
#ifdef WITH_SOURCES
    CHECK(check_procedural());
#endif
#ifdef _WIN32
    _setmode(1, _O_BINARY);
#endif
    memset(&limits, 0, sizeof limits);
    limits.objects = 28;
    limits.coordinates = 28 * ASET_COORDINATES_SPHERE;
    limits.materials = 2;
    limits.lights = 1;
    CHECK(aset_arena_init(&arena, block, sizeof block));
    CHECK(aset_scene_init(&scene, &arena, &limits));
    aset_sink sink = aset_scene_sink(&scene);
    CHECK(emit(&sink));
    memset(&options, 0, sizeof options);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = 24;
    CHECK(aset_space_build(&space, &scene, &aset_mset, &options, &arena));
    CHECK(aset_summary_build(&summary, &space, 0, &arena));
    CHECK(aset_scratch_init(&scratch, 0, &arena));
    memset(&view, 0, sizeof view);
    view.from = point(3, -7, 3);
    view.at = point(0, 0, -0.2);
    view.up = point(0, 0, 1);
    view.angle_deg = 40;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &scene;
    tracer.space = &space;
    tracer.summary = &summary;
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.approx_depth = 1;
    tracer.curtail = (aset_real)0.5;
    memset(&picture, 0, sizeof picture);
    picture.width = picture.height = SIDE;
    picture.pixels = row;
    picture.on_row = write_row;
    picture.context = stdout;
    printf("P6\n%d %d\n255\n", SIDE, SIDE);
    CHECK(aset_render_rows(&tracer, &view, &picture, 0, SIDE, &scratch, NULL));
    return 0;
}
