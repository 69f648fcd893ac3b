/*
 * scene.c - the command `aset scene`: a procedural scene as NFF.
 */
#include "aset/procedural.h"

#include "tool.h"

#include <inttypes.h>
#include <string.h>

/* The scenes for which the SPD programs write `hither 1`, and not 0.01; no renderer of ours uses it. */
static const char *const far_hither[] = {"gears", "rings", "teapot", "tetra", "tree"};

static const char help[] =
    "\n"
    "Options:\n"
    "  --size N        how large (see above); default: the scene's own\n"
    "  -o, --output F  write to the file F; default and -: standard output\n"
    "  -h, --help      print this text\n"
    "\n"
    "Numbers have six significant digits, as in the files of the SPD programs.\n";

/* One line for each scene, from the library's own list. */
static int print_help(void) {
    const aset_procedural *scene;
    (void)fputs("aset scene NAME [--size N] [-o FILE]: writes a procedural scene in the Neutral File Format.\n\n"
                "Scenes:\n",
                stdout);
    for (size_t i = 0; (scene = aset_procedural_at(i)) != NULL; i++) {
        (void)printf("  %-10s  %s (1 to %" PRIu32 ", default %" PRIu32 ")\n", scene->name, scene->text,
                     scene->largest_size, scene->default_size);
    }
    return tool_help(help);
}

/* The error line for a name that is no scene, with all that are. */
static void unknown_scene(const char *name) {
    char list[512] = "";
    size_t length = 0;
    const aset_procedural *scene;
    for (size_t i = 0; (scene = aset_procedural_at(i)) != NULL && length < sizeof list; i++) {
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", i == 0 ? "" : ", ", scene->name);
    }
    tool_error(NULL, 0, "scene: there is no scene \"%s\"; known are %s", name, list);
}

static double scene_hither(const char *name) {
    for (size_t i = 0; i < sizeof far_hither / sizeof far_hither[0]; i++) {
        if (strcmp(name, far_hither[i]) == 0) {
            return 1.0;
        }
    }
    return 0.01;
}

static int write_scene(const aset_procedural *scene, uint32_t size, const char *path) {
    tool_output output;
    tool_nff nff;
    if (!tool_output_open(&output, path)) {
        return TOOL_FAILED;
    }
    aset_sink sink = tool_nff_sink(&nff, output.stream, scene_hither(scene->name));
    aset_status status = scene->emit(&sink, size);
    if (status == ASET_OK) {
        status = tool_nff_end(&nff);
    }
    if (status != ASET_OK) {
        if (nff.error != 0) {
            tool_output_fail(&output, nff.error);
        } else {
            tool_error(NULL, 0, "scene: %s: %s", scene->name, aset_status_text(status));
        }
        tool_output_abort(&output);
        return TOOL_FAILED;
    }
    return tool_output_close(&output) ? TOOL_DONE : TOOL_FAILED;
}

int command_scene(int argc, char **argv) {
    static const struct option longs[] = {
        {"size", required_argument, NULL, 's'},
        {"output", required_argument, NULL, 'o'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    const char *size_text = NULL, *path = NULL;
    int option;
    while ((option = tool_option_next(argc, argv, "s:o:h", longs)) != -1) {
        switch (option) {
        case 's': size_text = optarg; break;
        case 'o':
            if (!tool_parse_output(optarg, &path)) {
                return TOOL_USAGE;
            }
            break;
        case 'h': return print_help();
        default: return TOOL_USAGE;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "scene: expected the name of one scene, got %d words; aset scene --help lists them",
                   argc - optind);
        return TOOL_USAGE;
    }
    const aset_procedural *scene = aset_procedural_find(argv[optind]);
    if (scene == NULL) {
        unknown_scene(argv[optind]);
        return TOOL_USAGE;
    }
    uint32_t size = scene->default_size;
    /* the library takes 0 as the default size; a user who writes 0 has made a mistake */
    if (size_text != NULL && !tool_parse_count("scene: --size", size_text, 1, scene->largest_size, &size)) {
        return TOOL_USAGE;
    }
    return write_scene(scene, size, path != NULL ? path : "-");
}
