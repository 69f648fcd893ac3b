/*
 * trade.c - the command `aset trade`: speed, memory and error of many settings, measured side by side.
 *
 * Every round measures every setting once, so that a slow minute of the machine falls on all settings alike. Within a round
 * settings are taken in steps of about 0.618 of their number: neighbours in the table are far apart in time, and the time
 * left is estimated from a fair mixture.
 */
#include "trade.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define ROUNDS_MAX 99u

static const char help[] =
    "aset trade SCENE... [-o DIRECTORY]: draws each scene by many settings; tells what each costs and how far off it is.\n"
    "SCENE is an .nff, .obj, .stl or .ply file, or the name of a procedural scene (aset scene --help), such as snow or\n"
    "gears:2 for size 2.\n"
    "\n"
    "  -o, --output DIR         where the results go; made if missing; default trade\n"
    "  -m, --methods LIST       of mset,set,grid,octree,arts,excell,brute, or all; default all but brute; aset: mset, and\n"
    "                           alone with --approx all --approx-depth 1, as for render\n"
    "      --grids LIST         divisions of mset, set, grid: N, NXxNYxNZ or auto; default 16,32,64\n"
    "      --octree-depths LIST  halvings in octree, arts, excell; default 4,6\n"
    "      --cells LIST         what cells remember: flat (average textures), normal, plane (drafts); default flat,plane\n"
    "      --approx KINDS, --approx-depth L   approximate with these rays (default all) from that depth only; else as below\n"
    "      --curtail F, --curtail-when W      trapped rays, as for render; default 0.5 and not at all, less\n"
    "      --leaf K, --samples N, --depth N, --rules spd   of all settings, as for render; default 1, 1, 5, off\n"
    "      --memory BYTES       settings that need more (K = 1024, M) are left out, but exact ones: all is measured by them\n"
    "  -s, --sizes LIST         pictures, each WxH or N; default 256x256\n"
    "      --from X,Y,Z --at X,Y,Z --up X,Y,Z --angle DEG   another camera than the scenes'\n"
    "      --up-axis y|z, --ground on|off, --smooth   of models, as for render\n"
    "      --rounds N           measurements of each setting; default 3\n"
    "      --quick              mset,grid, 16,32, 128x128 and one round, but for what other options say\n"
    "  -q, --quiet              no progress bar, no words at the end\n"
    "  -h, --help               this text\n"
    "\n"
    "Each space is drawn exactly, and approximately with all rays from depth 1, all from 0, shadow rays from 0 and eye\n"
    "rays from 0, each with trapped rays curtailed at 0.5 of a voxel's diagonal and not at all, unless words say\n"
    "otherwise. mset and grid are drawn as drafts too, with all rays from 0 and shadow rays from 0; nothing is curtailed\n"
    "then. With all rays from 0 a draft of either is the same and needs neither scene nor space: it is drawn once, as\n"
    "mset. Nor do flat cells of mset and grid need the scene then. One thread; an arena of exactly the bytes needed;\n"
    "every round measures all settings once.\n"
    "\n"
    "DIR/trade.csv has a row for each setting; a field that does not apply is empty. build_s and render_s are medians over\n"
    "the rounds, with the smallest and the largest; no reading of the scene is in them. time is build_s + render_s as a\n"
    "multiple of the fastest exact mset's on the same scene and size (without one: of the fastest exact setting's).\n"
    "peak_bytes is the arena with which render draws it so, not one byte more, or for a draft not over a 32nd more, found\n"
    "by trying; with more memory a draft takes fewer passes over the scene. psnr, rmse, ssim, max_difference and differing\n"
    "compare with the exact picture of the same size, as aset compare does. best is 1 where no other row of that scene and\n"
    "size beats the setting: is as good in build_s + render_s, in peak_bytes and in rmse, and better in at least one; else\n"
    "0, as where it needs more than --memory.\n"
    "DIR/trade.html shows it all, with plots if gnuplot is there.\n"
    "\n"
    "An interrupted sweep leaves DIR/trade.csv.partial; the same words again go on from there.\n";

/* --- words --- */

/* Not a method: mset, and if no other is there its approximation alone. */
#define METHOD_ASET (1u << 31)

static bool parse_methods(trade_words *w, const char *text) {
    enum { MAX = 17 };
    tool_word words[MAX];
    unsigned n = 0, all = 0, mset = 0;
    for (; n < MAX - 3 && tool_methods[n] != NULL; n++) {
        words[n] = (tool_word){aset_method_name(tool_methods[n]), 1u << n};
        all |= 1u << n;
        mset |= tool_methods[n] == &aset_mset ? 1u << n : 0;
    }
    words[n] = (tool_word){"all", all};
    words[n + 1] = (tool_word){"aset", METHOD_ASET};
    words[n + 2] = (tool_word){NULL, 0};
    if (!tool_parse_words("--methods", text, words, &w->methods)) {
        return false;
    }
    w->is_aset = w->methods == METHOD_ASET;
    if ((w->methods & METHOD_ASET) != 0) {
        w->methods = (w->methods & ~METHOD_ASET) | mset;
    }
    return true;
}

static bool parse_cells(trade_words *w, const char *text) {
    tool_word words[SETTINGS_CELLS + 1] = {{NULL, 0}};
    for (unsigned i = 0; i < SETTINGS_CELLS; i++) {
        words[i] = (tool_word){settings_cells_names[i], 1u << i};
    }
    return tool_parse_words("--cells", text, words, &w->cells);
}

/* True, after an error line, if the last of n values of a list stands there before. */
static bool is_repeated(const char *option, const char *text, const void *values, uint32_t n, size_t size) {
    const unsigned char *at = values;
    for (uint32_t i = 0; i + 1 < n; i++) {
        if (memcmp(at + i * size, at + (n - 1) * size, size) == 0) {
            tool_error(NULL, 0, "%s: %s stands there twice", option, text);
            return true;
        }
    }
    return false;
}

static bool parse_grid(trade_words *w, const char *text) {
    return tool_parse_grid("--grids", text, ASET_DIVISIONS_MAX, w->grids[w->n_grids++]) &&
           !is_repeated("--grids", text, w->grids, w->n_grids, sizeof w->grids[0]);
}

static bool parse_depth(trade_words *w, const char *text) {
    return tool_parse_count("--octree-depths", text, 1, ASET_DEPTH_TREE_MAX, &w->depths[w->n_depths++]) &&
           !is_repeated("--octree-depths", text, w->depths, w->n_depths, sizeof w->depths[0]);
}

static bool parse_size(trade_words *w, const char *text) {
    uint32_t *size = w->sizes[w->n_sizes++];
    if (!tool_parse_size("--sizes", text, TOOL_DRAWN_MAX, &size[0], &size[1])) {
        return false;
    }
    return !is_repeated("--sizes", text, w->sizes, w->n_sizes, sizeof w->sizes[0]);
}

/* Words with commas between them, at most TRADE_LIST_MAX, one after the other to parse. */
static bool parse_list(trade_words *w, const char *option, const char *text,
                       bool (*parse)(trade_words *w, const char *text)) {
    char *copy = malloc(strlen(text) + 1), *word = copy;
    bool done = copy != NULL;
    if (done) {
        memcpy(copy, text, strlen(text) + 1);
    }
    for (uint32_t n = 1; done && word != NULL; n++) {
        char *comma = strchr(word, ',');
        if (comma != NULL) {
            *comma = '\0';
        }
        if (n > TRADE_LIST_MAX) {
            tool_error(NULL, 0, "%s: more than %u words", option, TRADE_LIST_MAX);
            done = false;
        }
        done = done && parse(w, word);
        word = comma != NULL ? comma + 1 : NULL;
    }
    free(copy);
    return done;
}

enum { OPTION_GRIDS = 256, OPTION_DEPTHS, OPTION_CELLS, OPTION_ROUNDS, OPTION_QUICK, OPTION_MEMORY };

static bool parse_option(trade_words *w, int option) {
    switch (option) {
    case 'o':
        if (strcmp(optarg, "-") == 0) {
            tool_error(NULL, 0, "trade: --output: the results are files in a folder, expected its name (./- for one called -)");
            return false;
        }
        return tool_parse_output(optarg, &w->directory);
    case 'm': return parse_methods(w, optarg);
    case OPTION_GRIDS: w->n_grids = 0; return parse_list(w, "--grids", optarg, parse_grid);
    case OPTION_DEPTHS: w->n_depths = 0; return parse_list(w, "--octree-depths", optarg, parse_depth);
    case 's': w->n_sizes = 0; return parse_list(w, "--sizes", optarg, parse_size);
    case OPTION_CELLS: return parse_cells(w, optarg);
    case OPTION_ROUNDS: return tool_parse_count("--rounds", optarg, 1, ROUNDS_MAX, &w->rounds);
    case OPTION_QUICK: w->quick = true; return true;
    case OPTION_MEMORY: w->has_memory = true; return tool_parse_bytes("--memory", optarg, 0, SIZE_MAX / 2, &w->settings.memory);
    case 'q': w->quiet = true; return true;
    case 'h': w->wants_help = true; return true;
    default: return settings_option(&w->settings, option);
    }
}

/* Only mset and grid have drafts, whose divisions have a limit of their own. */
static bool check_drafts(const trade_words *w) {
    unsigned drafted = 0;
    for (unsigned m = 0; tool_methods[m] != NULL; m++) {
        drafted |= tool_methods[m] == &aset_mset || tool_methods[m] == &aset_grid ? w->methods & 1u << m : 0;
    }
    if (drafted == 0 && (w->cells >> CELLS_FLAT & 1) == 0) {
        tool_error(NULL, 0, "--cells: only mset and grid have drafts, expected one of them in --methods, or flat cells");
        return false;
    }
    for (uint32_t i = 0; drafted != 0 && w->cells != 1u << CELLS_FLAT && i < w->n_grids; i++) {
        for (int a = 0; a < 3; a++) {
            if (w->grids[i][a] > ASET_BAKE_DIVISIONS_MAX) {
                tool_error(NULL, 0, "--grids: %" PRIu32 " are too many for a draft, expected at most %u, or --cells flat",
                           w->grids[i][a], ASET_BAKE_DIVISIONS_MAX);
                return false;
            }
        }
    }
    return true;
}

static bool parse_words(trade_words *w, int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"methods", required_argument, NULL, 'm'},
        {"grids", required_argument, NULL, OPTION_GRIDS},
        {"octree-depths", required_argument, NULL, OPTION_DEPTHS},
        {"cells", required_argument, NULL, OPTION_CELLS},
        {"sizes", required_argument, NULL, 's'},
        {"rounds", required_argument, NULL, OPTION_ROUNDS},
        {"quick", no_argument, NULL, OPTION_QUICK},
        {"memory", required_argument, NULL, OPTION_MEMORY},
        SETTINGS_DRAWING_OPTIONS,
        SETTINGS_CAMERA_OPTIONS,
        SETTINGS_MODEL_OPTIONS,
        SETTINGS_SMOOTH_OPTION,
        {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int option;
    memset(w, 0, sizeof *w);
    w->settings = settings_default();
    while ((option = tool_option_next(argc, argv, "o:m:s:qh", longs)) != -1) {
        if (!parse_option(w, option)) {
            return false;
        }
        if (w->wants_help) {
            return true;
        }
    }
    w->settings.has_approx_depth = w->settings.has_approx_depth || w->is_aset; /* all rays from 1 on, but for what other words say */
    if (optind == argc) {
        tool_error(NULL, 0, "trade: expected at least one scene; aset trade --help tells more");
        return false;
    }
    for (int i = optind; i < argc; i++) {
        for (int k = optind; k < i; k++) {
            if (strcmp(argv[i], argv[k]) == 0) {
                tool_error(NULL, 0, "trade: the scene %s is given twice", argv[i]);
                return false;
            }
        }
    }
    if (!settings_check(&w->settings)) {
        return false;
    }
    w->directory = w->directory != NULL ? w->directory : "trade";
    w->rounds = w->rounds > 0 ? w->rounds : w->quick ? 1 : 3;
    return (w->methods > 0 || parse_methods(w, w->quick ? "mset,grid" : "mset,set,grid,octree,arts,excell")) &&
           (w->cells > 0 || parse_cells(w, "flat,plane")) &&
           (w->n_grids > 0 || parse_list(w, "--grids", w->quick ? "16,32" : "16,32,64", parse_grid)) &&
           (w->n_depths > 0 || parse_list(w, "--octree-depths", w->quick ? "4" : "4,6", parse_depth)) &&
           (w->n_sizes > 0 || parse_list(w, "--sizes", w->quick ? "128x128" : "256x256", parse_size)) && check_drafts(w);
}

/* --- the work --- */

/* A step near 0.618 n that shares no factor with n, so that n steps visit all. */
static uint32_t choose_step(uint32_t n) {
    for (uint32_t step = (uint32_t)(0.618 * n) + 1;; step++) {
        uint32_t a = n, b = step;
        while (b != 0) {
            uint32_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1) {
            return step;
        }
    }
}

static bool measure_all(trade *t) {
    uint32_t n = t->n_settings, step = choose_step(n);
    uint64_t left = 0, done = 0, at = 0;
    bool fine = true;
    for (uint64_t i = 0; i < (uint64_t)n * t->rounds; i++) {
        left += t->settings[i % n].build[i / n] == 0;
    }
    tool_progress_start("drawn", left, t->quiet);
    for (uint64_t i = 0; fine && i < (uint64_t)n * t->rounds; i++, at = (at + step) % n) {
        trade_setting *s = &t->settings[at];
        uint32_t round = (uint32_t)(i / n);
        if (s->build[round] == 0) {
            fine = trade_measure(t, s, round) && trade_append(t, s, round);
            tool_progress_step(++done);
        }
    }
    tool_progress_end();
    return fine;
}

static bool write_text(const char *path, const char *text) {
    tool_output output;
    if (!tool_output_open(&output, path)) {
        return false;
    }
    (void)tool_output_write(&output, text, strlen(text));
    return tool_output_close(&output);
}

/* The plots as files and in plots; without gnuplot there are none. */
static bool write_plots(const trade *t, char **plots, bool *absent) {
    static const char *const against[TRADE_PLOTS] = {"time", "bytes"};
    for (uint32_t i = 0; i < t->n_groups * TRADE_PLOTS && !*absent; i++) {
        const trade_group *group = &t->groups[i / TRADE_PLOTS];
        plots[i] = trade_plot(t, group, (int)(i % TRADE_PLOTS), absent);
        if (plots[i] == NULL) {
            continue;
        }
        char *path = trade_path(t, "%" PRIu32 "-%s-%" PRIu32 "x%" PRIu32 "-%s.svg", i / TRADE_PLOTS + 1, group->scene->label,
                                group->width, group->height, against[i % TRADE_PLOTS]);
        bool done = path != NULL && write_text(path, plots[i]);
        free(path);
        if (!done) {
            return false;
        }
    }
    return true;
}

static bool write_all(trade *t) {
    bool absent = false, done;
    uint32_t n_best = 0, n_plots = t->n_groups * TRADE_PLOTS;
    char **plots = calloc(n_plots, sizeof *plots);
    trade_judge(t);
    done = trade_write(t) && plots != NULL && write_plots(t, plots, &absent) && trade_page(t, plots) && trade_finish(t);
    for (uint32_t i = 0; plots != NULL && i < n_plots; i++) {
        free(plots[i]);
    }
    free(plots);
    for (uint32_t i = 0; i < t->n_settings; i++) {
        n_best += t->settings[i].best;
    }
    if (done && absent && !t->quiet) {
        (void)puts("no plots, for there is no gnuplot (Debian: gnuplot-nox)");
    }
    if (done && t->n_left_out > 0 && !t->quiet) {
        (void)printf("%" PRIu32 " settings need more than %" PRIu64 " bytes and are left out\n", t->n_left_out, t->memory);
    }
    if (done && !t->quiet) {
        (void)printf("%s: %" PRIu32 " settings, %" PRIu32 " of them best, in trade.csv and trade.html\n", t->directory,
                     t->n_settings, n_best);
    }
    return done && (t->quiet || tool_help("") == TOOL_DONE);
}

static bool make_directory(const char *path) {
    struct stat status;
    if (mkdir(path, 0777) == 0 || (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode))) {
        return true;
    }
    tool_error(path, 0, "cannot be made a folder: %s", strerror(errno));
    return false;
}

int command_trade(int argc, char **argv) {
    trade_words w;
    trade t;
    memset(&t, 0, sizeof t);
    if (!parse_words(&w, argc, argv)) {
        return TOOL_USAGE;
    }
    if (w.wants_help) {
        return tool_help(help);
    }
    bool done = trade_plan(&t, &w, argv + optind, (uint32_t)(argc - optind)) && make_directory(t.directory) &&
                trade_resume(&t) && measure_all(&t) && write_all(&t);
    trade_free(&t);
    return done ? TOOL_DONE : TOOL_FAILED;
}
