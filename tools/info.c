/* info.c - the command `aset info`: what a scene holds, and the bytes that each method needs for it. */
#include "prepare.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "aset info SCENE [--grid N]: counts, bounds, materials and lights of a scene, and the bytes each method needs.\n"
    "Of a model the counts and bounds are its own; the bytes include the ground and the lights that render adds. The row\n"
    "draft is for --cells plane. Everything approximate is --approx all --approx-depth 0.\n"
    "\n"
    "      --grid N    divisions on every axis; or NXxNYxNZ, or auto; default auto\n"
    "      --octree-depth D, --leaf K   limits of octree, arts and excell; default 6, 1\n"
    "      --depth N   rays in a chain, for the scratch; default 5\n"
    "      --ground on|off, --up-axis y|z, --smooth   of models, as for render\n"
    "  -h, --help      this text\n";

static void print_vec(const char *label, aset_vec3 v) {
    (void)printf("%-12s%g %g %g\n", label, (double)v.x, (double)v.y, (double)v.z);
}

static void print_scene(const aset_scene *scene) {
    const aset_counts *c = &scene->counts;
    aset_vec3 low, high;
    (void)printf("objects     %" PRIu32 ": %" PRIu32 " polygons, %" PRIu32 " patches, %" PRIu32 " spheres, %" PRIu32
                 " cones\n",
                 c->objects, c->polygons, c->patches, c->spheres, c->cones);
    (void)printf("coordinates %" PRIu64 "\nmaterials   %" PRIu32 "\nlights      %" PRIu32 "\n", c->coordinates, c->materials,
                 c->lights);
    if (aset_scene_bounds(scene, &low, &high)) {
        print_vec("low", low);
        print_vec("high", high);
    }
}

/* The need of one method, exact and approximate, with the counts that the ASET_BYTES_ expressions take. */
static bool print_method(measured *m, const char *path, const aset_method *method,
                         const aset_space_options *options, uint32_t depth) {
    aset_space_size size;
    size_t summary, scratch = ASET_BYTES_SCRATCH(depth);
    if (!measured_space(m, path, method, options, &size, &summary)) {
        return false;
    }
    size_t before = m->scene_bytes + scratch, kept = size.cells + size.references + size.voxels;
    size_t exact = before + size.total, approximate = before + (kept + summary > size.total ? kept + summary : size.total);
    (void)printf("%-11s %" PRIu32 " x %" PRIu32 " x %" PRIu32 ": exact %zu bytes, approximate %zu bytes\n",
                 aset_method_name(method), size.divisions[0], size.divisions[1], size.divisions[2], exact, approximate);
    (void)printf("            scene %zu, scratch %zu, cells %zu, references %zu, voxels %zu, textures %zu, building %zu\n",
                 m->scene_bytes, scratch, size.cells, size.references, size.voxels, summary, size.scratch);
    if (tool_streams(method, ASET_ALL_KINDS, 0)) {
        size_t flat = 0;
        if (!measured_flat(m, path, method, options, &flat)) {
            return false;
        }
        (void)printf("            everything approximate, no object held: %zu bytes\n", scratch + flat);
    }
    (void)printf("            %" PRIu32 " blocks, %" PRIu32 " cells not empty, %" PRIu32 " references, density %.2f\n",
                 size.n_blocks, size.n_cells, size.n_references,
                 size.n_cells > 0 ? (double)size.n_references / (double)size.n_cells : 0.0);
    return true;
}

/* Of a model by itself: counts are without its ground. */
static void print_model(const tool_source *source, const aset_counts *c) {
    (void)printf("objects     %" PRIu32 ": %" PRIu32 " polygons, %" PRIu32 " patches, 0 spheres, 0 cones\n", c->objects,
                 c->polygons, c->patches);
    if (source->n_skipped > 0) {
        (void)printf("left out    %" PRIu64 " facets\n", source->n_skipped);
    }
    if (source->n_vertices > 0) {
        (void)printf("vertices    %" PRIu64 "\n", source->n_vertices);
    }
    (void)printf("coordinates %" PRIu64 "\nmaterials   %" PRIu32 "\nlights      0\n", c->coordinates, c->materials);
    print_vec("low", source->low);
    print_vec("high", source->high);
    (void)printf("added       %s%" PRIu32 " lights; %c is up\n", source->stage.no_ground ? "" : "a ground and ", c->lights,
                 source->stage.up == ASET_UP_Z ? 'z' : 'y');
}

/* Counts of all that is drawn. Prints a model, whose own counts differ from these, on the way. */
static bool count(tool_source *source, aset_counts *counts) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    bool no_ground = source->stage.no_ground;
    source->stage.no_ground = true;
    bool done = tool_source_read(source, &sink);
    source->stage.no_ground = no_ground;
    if (done && source->format != TOOL_NFF) {
        print_model(source, &counter.counts);
    }
    if (done && source->format != TOOL_NFF && !no_ground) {
        sink = aset_counter_sink(&counter);
        done = tool_source_read(source, &sink);
    }
    *counts = counter.counts;
    return done;
}

/* The draft at these divisions, baked with more memory until it is enough; without divisions in what the short form has. */
static aset_status bake(aset_draft *draft, aset_arena *arena, void **block, aset_bake_report *report, tool_source *source,
                        const aset_bake_options *options) {
    const uint32_t *n = options->divisions;
    size_t size = n[0] == 0 ? 1u << 20 : ASET_BYTES_BAKE(n[0], n[1], n[2]) + 65536u;
    aset_status status = ASET_ERR_NOMEM;
    for (*block = NULL; status == ASET_ERR_NOMEM && size < SIZE_MAX / 2; size += arena->missing) {
        tool_baking baking;
        free(*block);
        *block = malloc(size);
        if (*block == NULL) {
            return ASET_ERR_NOMEM;
        }
        status = aset_arena_init(arena, *block, size);
        if (status == ASET_OK) {
            status = tool_bake(&baking, source, options, arena);
            *draft = baking.draft;
            *report = baking.report;
            status = baking.told ? ASET_ERR_READ : status;
        }
    }
    return status;
}

static bool print_draft(tool_source *source, const aset_space_options *options) {
    aset_draft draft;
    aset_arena arena;
    aset_bake_options bake_options;
    aset_bake_report report;
    void *block;
    memset(&draft, 0, sizeof draft);
    memset(&report, 0, sizeof report);
    memset(&bake_options, 0, sizeof bake_options);
    memcpy(bake_options.divisions, options->divisions, sizeof bake_options.divisions);
    aset_status status = bake(&draft, &arena, &block, &report, source, &bake_options);
    if (status == ASET_OK) {
        (void)printf("%-11s %" PRIu32 " x %" PRIu32 " x %" PRIu32 ": %zu bytes\n", "draft", draft.n[0], draft.n[1],
                     draft.n[2], draft.n_words * sizeof *draft.words);
        (void)printf("            %" PRIu32 " facets in %" PRIu32 " voxels, %" PRIu32 " textures, %" PRIu32
                     " objects kept; baked in %zu bytes and %" PRIu32 " passes\n",
                     report.facets, report.voxels, report.textures, report.kept, arena.peak, report.passes);
    } else if (status == ASET_ERR_ARGUMENT) { /* the divisions */
        (void)printf("draft       at most %u divisions\n", ASET_BAKE_DIVISIONS_MAX);
    } else if (status == ASET_ERR_GEOMETRY || status == ASET_ERR_PRECISION) {
        (void)printf("draft       none: %s\n", aset_status_text(status));
        status = ASET_OK;
    } else if (status != ASET_ERR_READ) {
        tool_error(source->path, 0, "draft: %s", aset_status_text(status));
    }
    free(block);
    return status == ASET_OK || status == ASET_ERR_ARGUMENT;
}

static bool info_from(tool_source *source, const aset_space_options *options, uint32_t depth) {
    aset_counts counts;
    measured m;
    bool done = true, is_model = source->format != TOOL_NFF;
    if (!count(source, &counts) || !measured_open(&m, source, &counts)) {
        return false;
    }
    if (!is_model) {
        print_scene(&m.scene);
    }
    for (size_t i = 0; tool_methods[i] != NULL && done; i++) {
        done = print_method(&m, source->path, tool_methods[i], options, depth);
    }
    free(m.block);
    return done && (counts.objects == 0 || print_draft(source, options));
}

static int info(const char *path, const settings *s, const aset_space_options *options) {
    tool_source source;
    if (!tool_source_open(&source, path)) {
        return TOOL_FAILED;
    }
    tool_source_set(&source, s);
    bool done = info_from(&source, options, s->depth);
    tool_source_close(&source);
    if (done && fflush(stdout) != 0) {
        tool_error(NULL, 0, "standard output cannot be written");
        done = false;
    }
    return done ? TOOL_DONE : TOOL_FAILED;
}

static bool parse_option(settings *s, aset_space_options *options, int option) {
    switch (option) {
    case 'g': return tool_parse_grid("--grid", optarg, ASET_DIVISIONS_MAX, options->divisions);
    case 't': return tool_parse_count("--octree-depth", optarg, 1, ASET_DEPTH_TREE_MAX, &options->depth);
    case 'l': return tool_parse_count("--leaf", optarg, 1, UINT32_MAX, &options->leaf);
    case 'd': return tool_parse_count("--depth", optarg, 1, ASET_DEPTH_MAX, &s->depth);
    default: return settings_option(s, option);
    }
}

int command_info(int argc, char **argv) {
    static const struct option longs[] = {
        {"grid", required_argument, NULL, 'g'},
        {"depth", required_argument, NULL, 'd'},
        {"octree-depth", required_argument, NULL, 't'},
        {"leaf", required_argument, NULL, 'l'},
        SETTINGS_MODEL_OPTIONS,
        SETTINGS_SMOOTH_OPTION,
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    settings s = settings_default();
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.depth = SETTINGS_TREE_DEPTH;
    int option;
    while ((option = tool_option_next(argc, argv, "g:d:t:l:h", longs)) != -1) {
        if (option == 'h') {
            return tool_help(help);
        }
        if (!parse_option(&s, &options, option)) {
            return TOOL_USAGE;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "info: expected one scene, got %d words; aset info --help tells more", argc - optind);
        return TOOL_USAGE;
    }
    return info(argv[optind], &s, &options);
}
