/*
 * plan_header.c - a plan as a C header: the switches of what the scene does not use, and the sizes of exactly this scene
 * and setting as constant expressions. A program and the library are both compiled with it (-include); a size that does not
 * come out to the byte does not compile.
 */
#include "plan.h"

#include <inttypes.h>

static bool any_reflects(const aset_scene *scene) {
    for (uint32_t i = 0; i < scene->counts.materials; i++) {
        if (scene->materials[i].specular > 0) {
            return true;
        }
    }
    return false;
}

static bool any_transmits(const aset_scene *scene) {
    for (uint32_t i = 0; i < scene->counts.materials; i++) {
        if (scene->materials[i].transmittance > 0) {
            return true;
        }
    }
    return false;
}

/*
 * Reflected rays are sent where there is something to reflect with, by the SPD's rules what transmits too, and a level for them; the
 * highlight stays either way.
 */
static void print_switches(FILE *f, const aset_scene *scene, const plan_setting *s, const plan_wish *wish) {
    const aset_counts *c = &scene->counts;
    bool reflects = any_reflects(scene) || (wish->spd_rules && any_transmits(scene));
    (void)fprintf(f, "#define ASET_WITH_POLYGONS %d\n", c->polygons + c->patches > 0);
    (void)fprintf(f, "#define ASET_WITH_PATCHES %d\n", c->patches > 0);
    (void)fprintf(f, "#define ASET_WITH_SPHERES %d\n", c->spheres > 0);
    (void)fprintf(f, "#define ASET_WITH_CONES %d\n", c->cones > 0);
    (void)fprintf(f, "#define ASET_WITH_REFLECTION %d\n", reflects && wish->depth > 1);
    (void)fprintf(f, "#define ASET_WITH_REFRACTION %d\n", any_transmits(scene));
    (void)fprintf(f, "#define ASET_WITH_APPROXIMATION %d\n", s->approx_kinds != 0);
}

/* The space's part of the bytes, as an expression of the header's own constants. */
static void print_space(FILE *f, const plan_setting *s) {
    static const struct {
        const aset_method *method;
        const char *macro;
    } macros[] = {{&aset_mset, "ASET_BYTES_MSET"}, {&aset_set, "ASET_BYTES_SET"}, {&aset_grid, "ASET_BYTES_GRID"}};
    for (size_t i = 0; i < sizeof macros / sizeof macros[0]; i++) {
        if (macros[i].method == s->method) {
            (void)fprintf(f, "     %s(%" PRIu32 ", %" PRIu32 ", %" PRIu32 ", "
                             "PLAN_BLOCKS, PLAN_REFERENCES, PLAN_OBJECTS) + \\\n",
                          macros[i].macro, s->size.divisions[0], s->size.divisions[1], s->size.divisions[2]);
        }
    } /* brute force has no bytes of its own */
}

static void print_sizes(FILE *f, const aset_scene *scene, const plan_setting *s, const plan_wish *wish) {
    const aset_counts *c = &scene->counts;
    (void)fprintf(f, "#define PLAN_OBJECTS %" PRIu32 "\n#define PLAN_COORDINATES %" PRIu64 "\n", c->objects, c->coordinates);
    (void)fprintf(f, "#define PLAN_MATERIALS %" PRIu32 "\n#define PLAN_LIGHTS %" PRIu32 "\n", c->materials, c->lights);
    (void)fprintf(f, "#define PLAN_METHOD aset_%s\n#define PLAN_DIVISIONS %" PRIu32 ", %" PRIu32 ", %" PRIu32 "\n",
                  aset_method_name(s->method), s->grid[0], s->grid[1], s->grid[2]);
    (void)fprintf(f, "#define PLAN_BLOCKS %" PRIu32 "\n", s->size.n_blocks);
    (void)fprintf(f, "#define PLAN_CELLS %" PRIu32 "\n#define PLAN_REFERENCES %" PRIu32 "\n", s->size.n_cells,
                  s->size.n_references);
    (void)fprintf(f, "#define PLAN_TEXTURES %" PRIu32 "\n#define PLAN_DEPTH %" PRIu32 "\n", s->textures, wish->depth);
    (void)fprintf(f, "#define PLAN_APPROX_KINDS %" PRIu32 "\n#define PLAN_APPROX_DEPTH %" PRIu32 "\n", s->approx_kinds,
                  s->approx_depth);
    (void)fprintf(f, "#define PLAN_CURTAIL %.9g\n#define PLAN_CURTAIL_MORE %d\n", wish->curtail, wish->curtail_more);
    (void)fprintf(f, "#define PLAN_SAMPLES %" PRIu32 "\n#define PLAN_SPD_RULES %d\n", wish->samples, wish->spd_rules);
    (void)fprintf(f,
                  "\n/* The arena, to the byte: use it where aset/aset.h is included. */\n"
                  "#define PLAN_BYTES \\\n"
                  "    (ASET_BYTES_SCENE(PLAN_OBJECTS, PLAN_COORDINATES, PLAN_MATERIALS, PLAN_LIGHTS) + \\\n");
    print_space(f, s);
    (void)fprintf(f, "     %sASET_BYTES_SCRATCH(PLAN_DEPTH))\n",
                  s->approx_kinds != 0 ? "ASET_BYTES_SUMMARY(PLAN_CELLS, PLAN_TEXTURES) + " : "");
}

bool plan_write_header(const char *path, const measured *m, const char *scene_path, const plan_setting *s,
                       const plan_wish *wish) {
    tool_output output;
    if (!tool_output_open(&output, path)) {
        return false;
    }
    FILE *f = output.stream;
    (void)fputs("/*\n * ", f);
    tool_print_in_comment(f, scene_path);
    (void)fputs("\n * Written by `aset plan --header`: compile the library and the program with -include of this file.\n */\n"
                "#ifndef ASET_PLAN_HEADER\n#define ASET_PLAN_HEADER\n\n/* Only what the scene uses. */\n", f);
    print_switches(f, &m->scene, s, wish);
    (void)fputs("\n/* Exactly this scene and setting. */\n", f);
    print_sizes(f, &m->scene, s, wish);
    (void)fputs("\n#endif\n", f);
    if (ferror(f)) {
        tool_output_fail(&output, 0);
        tool_output_abort(&output);
        return false;
    }
    return tool_output_close(&output);
}
