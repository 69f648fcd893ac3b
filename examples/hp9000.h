/*
 * hp9000.h - what the hp9000 examples share: a scene drawn exactly (MSET) and approximately (ASET) out of one static arena
 * of the size that the paper published for the HP9000, side by side in one picture, and what it cost beside the paper's
 * figures.
 */
#ifndef EXAMPLES_HP9000_H
#define EXAMPLES_HP9000_H

#include <aset/aset.h>
#include <aset/procedural.h>

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PANEL 256 /* pixels along a side of each of the pictures */
#define GAP 4
#define PANELS_MAX 4

/* One way of drawing; the first one of a sheet is the exact one that the others are compared with. */
typedef struct panel {
    const char *label;
    uint32_t approx_kinds, approx_depth;
} panel;

typedef struct sheet {
    const char *scene, *file; /* the procedural scene and the picture's name */
    uint32_t size, divisions;
    size_t published_mset, published_aset; /* Table 3; 0 where the paper prints none */
    size_t budget;                         /* bytes of the arena */
    const panel *panels;
    int n_panels;
} sheet;

static unsigned char pixels[PANEL][PANELS_MAX * (PANEL + GAP)][3];

static void fail(const char *what, aset_status status) {
    fprintf(stderr, "%s: %s\n", what, aset_status_text(status));
    exit(1);
}

static void write_png(const char *path, int n_panels) {
    png_image image;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = (png_uint_32)(n_panels * (PANEL + GAP) - GAP);
    image.height = PANEL;
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&image, path, 0, pixels, (png_int_32)sizeof pixels[0], NULL)) {
        fprintf(stderr, "%s: %s\n", path, image.message);
        exit(1);
    }
}

/* Draws one panel from nothing: the arena holds just what this way of drawing needs. Seconds of build and picture. */
static double draw_panel(const sheet *s, int index, void *block, aset_statistics *statistics, size_t *peak) {
    const panel *p = s->panels + index;
    const aset_procedural *source = aset_procedural_find(s->scene);
    aset_arena arena;
    aset_counter counter;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
    aset_status status = aset_arena_init(&arena, block, s->budget);
    aset_sink sink = aset_counter_sink(&counter);
    if (status == ASET_OK) status = source->emit(&sink, s->size);
    if (status == ASET_OK) status = aset_scene_init(&scene, &arena, &counter.counts);
    sink = aset_scene_sink(&scene);
    if (status == ASET_OK) status = source->emit(&sink, s->size);
    if (status != ASET_OK) fail(s->scene, status);

    clock_t start = clock();
    const aset_space_options options = {.divisions = {s->divisions, s->divisions, s->divisions}};
    status = aset_space_build(&space, &scene, &aset_mset, &options, &arena);
    if (status == ASET_OK && p->approx_kinds != 0) status = aset_summary_build(&summary, &space, 0, &arena);
    if (status == ASET_OK) status = aset_scratch_init(&scratch, 0, &arena);
    if (status != ASET_OK) fail(p->label, status);
    const aset_tracer tracer = {.scene = &scene,
                                .space = &space,
                                .summary = p->approx_kinds != 0 ? &summary : NULL,
                                .approx_kinds = p->approx_kinds,
                                .approx_depth = p->approx_depth,
                                .curtail = 0.5f};
    const aset_picture picture = {
        .width = PANEL, .height = PANEL, .pixels = pixels[0][index * (PANEL + GAP)], .stride = sizeof pixels[0]};
    memset(statistics, 0, sizeof *statistics);
    status = aset_render_rows(&tracer, &scene.view, &picture, 0, PANEL, &scratch, statistics);
    if (status != ASET_OK) fail(p->label, status);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    const aset_report report = {.tracer = &tracer, .arena = &arena, .statistics = statistics, .method = "mset",
                                .cells = "flat", .render_s = seconds};
    char text[4096];
    aset_report_text(text, sizeof text, &report);
    printf("--- %s, %u divisions: %s\n%s\n", s->scene, (unsigned)s->divisions, p->label, text);
    *peak = arena.peak;
    return seconds;
}

static void draw_sheet(const sheet *s, void *block, const char *directory) {
    double seconds[PANELS_MAX];
    size_t peak[PANELS_MAX];
    aset_statistics statistics[PANELS_MAX];
    char path[4096];
    memset(pixels, 255, sizeof pixels);
    for (int i = 0; i < s->n_panels; i++) {
        seconds[i] = draw_panel(s, i, block, &statistics[i], &peak[i]);
    }
    snprintf(path, sizeof path, "%s/%s.png", directory, s->file);
    write_png(path, s->n_panels);
    printf("=== %s: %zu bytes of static arena, from left to right:\n", path, s->budget);
    for (int i = 0; i < s->n_panels; i++) {
        const aset_statistics *t = &statistics[i];
        size_t published = s->panels[i].approx_kinds == 0 ? s->published_mset : s->published_aset;
        printf("  %-44s %8zu bytes", s->panels[i].label, peak[i]);
        if (published > 0) {
            printf(" (published %zu: %.0f %%)", published, 100.0 * (double)peak[i] / (double)published);
        }
        printf(", %.2f of MSET's time, %llu rays\n", seconds[i] / seconds[0],
               (unsigned long long)(t->primary + t->shadow + t->reflected + t->refracted));
    }
    printf("\n");
}

#endif
