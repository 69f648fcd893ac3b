/* smallest.c - a whole program: a scene in code, 9 kB of static memory, an approximate picture on standard output (PPM). */
#include <aset/aset.h>

#include <stdio.h>

#define SIDE 256
#define CHECK(call)                                                                                                    \
    do {                                                                                                               \
        aset_status status = (call);                                                                                   \
        if (status != ASET_OK) {                                                                                       \
            fprintf(stderr, "%s\n", aset_status_text(status));                                                         \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

static ASET_ARENA_BLOCK(block, 9 * 1024 * sizeof(aset_real) / sizeof(float));
static unsigned char row[SIDE * 3];

static int write_row(void *context, uint32_t y, const void *pixels) {
    (void)y;
    return fwrite(pixels, 3, SIDE, context) != SIDE;
}

int main(void) {
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
    const aset_counts limits = {.objects = 28, .coordinates = 28 * ASET_COORDINATES_SPHERE, .materials = 2, .lights = 1};
    CHECK(aset_arena_init(&arena, block, sizeof block));
    CHECK(aset_scene_init(&scene, &arena, &limits));
    aset_sink sink = aset_scene_sink(&scene);
    CHECK(sink.background(sink.context, &(aset_colour){0.1f, 0.2f, 0.4f}));
    CHECK(sink.light(sink.context, &(aset_light){.position = {5, -8, 9}}));
    const aset_material orange = {.fill = {1, 0.6f, 0.3f}, .diffuse = 0.8f, .specular = 0.3f, .shine = 20};
    CHECK(sink.material(sink.context, &orange));
    for (int i = 0; i < 27; i++) {
        aset_vec3 centre = {(aset_real)(i % 3) - 1, (aset_real)(i / 3 % 3) - 1, (aset_real)(i / 9) - 1};
        CHECK(sink.sphere(sink.context, &centre, 0.4f));
    }
    CHECK(sink.material(sink.context, &(aset_material){.fill = {0.5f, 0.7f, 0.5f}, .diffuse = 0.9f}));
    CHECK(sink.sphere(sink.context, &(aset_vec3){0, 0, -21.5f}, 20));
    CHECK(aset_space_build(&space, &scene, &aset_mset, &(aset_space_options){.divisions = {24, 24, 24}}, &arena));
    CHECK(aset_summary_build(&summary, &space, 0, &arena));
    CHECK(aset_scratch_init(&scratch, 0, &arena));
    const aset_view view = {.from = {3, -7, 3}, .at = {0, 0, -0.2f}, .up = {0, 0, 1}, .angle_deg = 40};
    const aset_tracer tracer = {.scene = &scene, .space = &space, .summary = &summary,
                                .approx_kinds = ASET_ALL_KINDS, .approx_depth = 1, .curtail = 0.5f};
    const aset_picture picture = {.width = SIDE, .height = SIDE, .pixels = row, .on_row = write_row, .context = stdout};
    printf("P6\n%d %d\n255\n", SIDE, SIDE);
    CHECK(aset_render_rows(&tracer, &view, &picture, 0, SIDE, &scratch, NULL));
    fprintf(stderr, "%zu of %zu bytes\n", arena.peak, arena.size);
    return 0;
}
