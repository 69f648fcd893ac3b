/*
 * planned.c - a program made for one scene and one budget: everything it needs comes from the header that
 * `aset plan SCENE.nff --memory BYTES --header plan.h` writes, and the library is compiled with it too:
 *     cc -std=c99 -include plan.h -Iinclude -Ilib examples/planned.c lib/[a-z]*[a-z]/[a-z]*.c -lm -o planned
 * planned SCENE.nff > OUT.ppm. The arena is to the byte: one of less, or a scene with one object more, and it says so.
 */
#include <aset/aset.h>
#include <aset/load.h>

#include <stdio.h>

#ifndef PLAN_BYTES
#error "compile with -include of a header that aset plan wrote"
#endif

static ASET_ARENA_BLOCK(block, PLAN_BYTES);
static unsigned char row[65535 * 3];

static ptrdiff_t read_file(void *context, void *buffer, size_t size) {
    size_t n = fread(buffer, 1, size, context);
    return n == 0 && ferror((FILE *)context) ? -1 : (ptrdiff_t)n;
}

static int write_row(void *context, uint32_t y, const void *pixels) {
    const uint32_t *columns = context;
    (void)y;
    return fwrite(pixels, 3, *columns, stdout) != *columns;
}

static int fail(aset_status status) {
    fprintf(stderr, "planned: %s\n", aset_status_text(status));
    return 1;
}

int main(int argc, char **argv) {
    static aset_arena arena;
    static aset_scene scene;
    static aset_space space;
    aset_scratch scratch;
    aset_load_report report;
    aset_tracer tracer = {.scene = &scene, .space = &space, .depth = PLAN_DEPTH, .samples = PLAN_SAMPLES, .spd_rules = PLAN_SPD_RULES};
    uint32_t columns, rows;
    aset_picture picture = {.pixels = row, .on_row = write_row, .context = &columns};
    const aset_load_options reading = {.one_sided_opaque = PLAN_SPD_RULES && !ASET_WITH_PATCHES};
    const aset_counts limits = {.objects = PLAN_OBJECTS, .coordinates = PLAN_COORDINATES, .materials = PLAN_MATERIALS,
                                .lights = PLAN_LIGHTS};
    const aset_space_options options = {.divisions = {PLAN_DIVISIONS}};
    FILE *file = argc > 1 ? fopen(argv[1], "rb") : NULL;
    if (file == NULL) {
        fprintf(stderr, "planned: expected a scene file\n");
        return 2;
    }
    aset_status status = aset_arena_init(&arena, block, PLAN_BYTES);
    if (status == ASET_OK) status = aset_scene_init(&scene, &arena, &limits);
    aset_sink sink = aset_scene_sink(&scene);
    if (status == ASET_OK) status = aset_load_nff(&sink, read_file, file, &reading, &report);
    if (status == ASET_OK) status = aset_scratch_init(&scratch, PLAN_DEPTH, &arena);
    if (status == ASET_OK) status = aset_space_build(&space, &scene, &PLAN_METHOD, &options, &arena);
#if ASET_WITH_APPROXIMATION
    static aset_summary summary;
    if (status == ASET_OK) status = aset_summary_build(&summary, &space, 0, &arena);
    tracer.summary = &summary;
    tracer.approx_kinds = PLAN_APPROX_KINDS;
    tracer.approx_depth = PLAN_APPROX_DEPTH;
    tracer.curtail = (aset_real)PLAN_CURTAIL;
    tracer.curtail_more = PLAN_CURTAIL_MORE;
#endif
    if (status != ASET_OK) return fail(status);
    picture.width = scene.view.width_px;
    picture.height = scene.view.height_px;
    columns = picture.width + PLAN_SPD_RULES;
    rows = picture.height + PLAN_SPD_RULES;
    printf("P6\n%u %u\n255\n", (unsigned)columns, (unsigned)rows);
    status = aset_render_rows(&tracer, &scene.view, &picture, 0, rows, &scratch, NULL);
    return status == ASET_OK ? 0 : fail(status);
}
