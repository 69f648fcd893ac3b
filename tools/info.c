/* info.c - the command `aset info`: what a scene holds, and the bytes that each method needs for it. */
#include "prepare.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "aset info SCENE [--grid N]: counts, bounds, materials and lights of a scene, and the bytes each method needs.\n"
    "\n"
    "      --grid N    divisions on every axis; or NXxNYxNZ, or auto; default auto\n"
    "      --octree-depth D, --leaf K   limits of octree, arts and excell; default 6, 1\n"
    "      --depth N   rays in a chain, for the scratch; default 5\n"
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
    (void)printf("            %" PRIu32 " blocks, %" PRIu32 " cells not empty, %" PRIu32 " references, density %.2f\n",
                 size.n_blocks, size.n_cells, size.n_references,
                 size.n_cells > 0 ? (double)size.n_references / (double)size.n_cells : 0.0);
    return true;
}

static bool info_from(tool_source *source, const aset_space_options *options, uint32_t depth) {
    aset_counter counter;
    measured m;
    aset_sink sink = aset_counter_sink(&counter);
    if (!tool_source_read(source, &sink) || !measured_open(&m, source, &counter.counts)) {
        return false;
    }
    bool done = true;
    print_scene(&m.scene);
    for (size_t i = 0; tool_methods[i] != NULL && done; i++) {
        done = print_method(&m, source->path, tool_methods[i], options, depth);
    }
    free(m.block);
    return done;
}

static int info(const char *path, const aset_space_options *options, uint32_t depth) {
    tool_source source;
    if (!tool_source_open(&source, path)) {
        return TOOL_FAILED;
    }
    bool done = info_from(&source, options, depth);
    tool_source_close(&source);
    if (done && fflush(stdout) != 0) {
        tool_error(NULL, 0, "standard output cannot be written");
        done = false;
    }
    return done ? TOOL_DONE : TOOL_FAILED;
}

int command_info(int argc, char **argv) {
    static const struct option longs[] = {
        {"grid", required_argument, NULL, 'g'},
        {"depth", required_argument, NULL, 'd'},
        {"octree-depth", required_argument, NULL, 't'},
        {"leaf", required_argument, NULL, 'l'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    uint32_t depth = ASET_DEPTH_DEFAULT;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    int option;
    while ((option = tool_option_next(argc, argv, "g:d:t:l:h", longs)) != -1) {
        bool fine = option != '?';
        switch (option) {
        case 'g': fine = tool_parse_grid("--grid", optarg, ASET_DIVISIONS_MAX, options.divisions); break;
        case 't': fine = tool_parse_count("--octree-depth", optarg, 1, ASET_DEPTH_TREE_MAX, &options.depth); break;
        case 'l': fine = tool_parse_count("--leaf", optarg, 1, UINT32_MAX, &options.leaf); break;
        case 'd': fine = tool_parse_count("--depth", optarg, 1, ASET_DEPTH_MAX, &depth); break;
        case 'h': return tool_help(help);
        default: break;
        }
        if (!fine) {
            return TOOL_USAGE;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "info: expected one scene, got %d words; aset info --help tells more", argc - optind);
        return TOOL_USAGE;
    }
    return info(argv[optind], &options, depth);
}
