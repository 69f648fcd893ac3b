/* plan.c - the command `aset plan`: the best settings for a scene within a budget, and what to expect of them. */
#include "plan.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "aset plan SCENE --memory BYTES [--error DB | --time MS] [--header FILE]: the settings to take within a budget.\n"
    "\n"
    "      --memory BYTES   the arena (K = 1024, M); default 8M\n"
    "      --error DB       the fastest setting of at least this PSNR against the exact picture\n"
    "      --time MS        the most accurate setting within this time on this machine, build and picture\n"
    "                       (neither: the most accurate that fits, and of equals the fastest)\n"
    "      --header FILE    write the sizes of this scene and setting, and the switches it needs, as a C header: of a program\n"
    "                       that holds the scene, as render does not where everything is approximate\n"
    "                       (-: to standard output, instead of the plan)\n"
    "  -m, --method NAME, --grid N                       of mset, grid, set and brute this method alone; these divisions alone\n"
    "                                                    (aset: mset with --approx all --approx-depth 1, as for render)\n"
    "      --approx KINDS, --approx-depth L              with these rays (default all) approximate, and no others\n"
    "      --cells plane|normal                          drafts, of all rays, instead of flat cells; see below\n"
    "      --curtail F, --curtail-when W, --samples N    as for render\n"
    "      --leaf K                                      refused: a plan has no octree, ARTS or EXCELL\n"
    "  -s, --size WxH|N     the picture; default the scene's, else 512x512\n"
    "      --depth N        rays in a chain; default 5\n"
    "      --rules spd      the SPD testing procedure, as for render\n"
    "      --from X,Y,Z --at X,Y,Z --up X,Y,Z --angle DEG   another camera than the scene's\n"
    "      --up-axis y|z, --ground on|off, --smooth   of models, as for render\n"
    "      --all            print every setting that was probed, before the one chosen\n"
    "      --json           the plan as JSON, a line for each setting\n"
    "  -q, --quiet          taken as everywhere; a plan has no progress bar\n"
    "  -h, --help           this text\n"
    "\n"
    "Bytes are exact. Times and PSNR are expected from a sample of the picture's rays; time is said as the ratio to the\n"
    "exact picture by MSET at automatic divisions. Settings are MSET, grid and SET with up to 5 numbers of divisions each,\n"
    "more where none of them fits (then a large scene may take some seconds), and at last brute force; exact, and with\n"
    "--error or --time, or where nothing exact fits, also approximate in three ways, unless words say otherwise. Those that\n"
    "fit are probed for about a second, the finest first. With --samples the error expected is that of one sample. Models\n"
    "in little memory are closest as drafts (--cells plane), whose bytes are enough and, of small models, the least to an eighth.\n";

typedef struct request {
    plan_wish wish;
    settings settings; /* the camera, and what a model gets */
    const char *scene, *header;
    bool all, json, wants_help, is_aset;
} request;

static void print_setting(const plan *p, const plan_setting *s) {
    char kinds[SETTINGS_KINDS_BYTES];
    settings_kinds(kinds, s->approx_kinds);
    (void)printf("--method %-4s --grid %" PRIu32 "x%" PRIu32 "x%" PRIu32 " --approx %-6s --approx-depth %" PRIu32
                 "%s%s: %8zu bytes, %.2f of the exact time, ",
                 aset_method_name(s->method), s->grid[0], s->grid[1], s->grid[2], kinds,
                 s->approx_kinds == 0 ? 1 : s->approx_depth, s->cells != CELLS_FLAT ? " --cells " : "",
                 s->cells != CELLS_FLAT ? settings_cells_names[s->cells] : "", s->bytes, s->seconds / p->exact_seconds);
    if (s->approx_kinds == 0) {
        (void)printf("exact%s\n", s->fits ? "" : ", does not fit");
    } else {
        (void)printf("%.1f dB%s\n", s->psnr, s->fits ? "" : ", does not fit");
    }
}

static void print_json(const plan *p, const plan_setting *s) {
    char kinds[SETTINGS_KINDS_BYTES];
    settings_kinds(kinds, s->approx_kinds);
    (void)printf("{\"method\":\"%s\",\"grid\":\"%" PRIu32 "x%" PRIu32 "x%" PRIu32
                 "\",\"approx\":\"%s\",\"approx_depth\":%" PRIu32 ",\"cells\":\"%s\""
                 ",\"bytes\":%zu,\"relative_time\":%.4f,\"seconds\":%.4f,\"psnr\":%.2f}\n",
                 aset_method_name(s->method), s->grid[0], s->grid[1], s->grid[2], kinds,
                 s->approx_kinds == 0 ? 1 : s->approx_depth, settings_cells_names[s->cells], s->bytes,
                 s->seconds / p->exact_seconds, s->seconds, s->psnr);
}

static bool is_standard(const char *path) {
    return path != NULL && strcmp(path, "-") == 0;
}

#define NEED_TRIALS 6
#define NEED_MOST (UINT64_C(1) << 44)

/* The least of the plan's bytes above low; 0: none. */
static uint64_t least_above(const plan *p, uint64_t low) {
    uint64_t least = 0;
    for (int i = 0; i < p->n; i++) {
        const plan_setting *s = &p->settings[i];
        least = s->fits && s->bytes > low && (least == 0 || s->bytes < least) ? s->bytes : least;
    }
    return least;
}

/*
 * Bytes for which there is an answer to what is asked for, where there is none for what was given: found by planning with more, as
 * what is needed goes by the words. 0: for no memory. False after an error line.
 */
static bool find_need(uint64_t *bytes, const request *r, measured *m, const plan_wish *wish) {
    plan p;
    plan_wish more = *wish;
    uint64_t low = wish->memory;
    *bytes = 0;
    for (more.memory = low > 512 ? 2 * low : 1024; *bytes == 0; more.memory *= 2) {
        if (more.memory > NEED_MOST) {
            return true;
        }
        if (!plan_make(&p, m, r->scene, &more)) {
            return false;
        }
        low = p.chosen < 0 ? more.memory : low;
        *bytes = p.chosen < 0 ? 0 : more.memory;
    }
    for (int i = 0; i < NEED_TRIALS && (more.memory = least_above(&p, low)) > 0 && more.memory < *bytes; i++) {
        plan less;
        if (!plan_make(&less, m, r->scene, &more)) {
            return false;
        }
        if (less.chosen >= 0) {
            *bytes = more.memory;
            return true;
        }
        low = more.memory;
    }
    return true;
}

static bool tell_need(const request *r, const plan *p, measured *m, const plan_wish *wish) {
    bool is_free = wish->method == NULL && wish->grid[0] == 0 && !wish->has_approx && wish->cells == CELLS_FLAT;
    uint64_t need = p->least_bytes;
    if ((!is_free || need <= wish->memory) && !find_need(&need, r, m, wish)) {
        return false;
    }
    if (need == 0) {
        tool_error(r->scene, 0, "of no such setting can the error be told, expected other words");
        return false;
    }
    tool_error(r->scene, 0, "the picture needs %" PRIu64 " bytes, has %" PRIu64, need, wish->memory);
    return false;
}

static bool tell(const request *r, const plan *p, measured *m, const plan_wish *wish) {
    void (*print)(const plan *p, const plan_setting *s) = r->json ? print_json : print_setting;
    for (int i = 0; i < p->n && r->all; i++) {
        print(p, &p->settings[i]);
    }
    if (p->chosen < 0) {
        return tell_need(r, p, m, wish);
    }
    const plan_setting *s = &p->settings[p->chosen];
    if (r->wish.time_ms > 0 && s->seconds * 1000 > r->wish.time_ms) {
        tool_error(r->scene, 0, "no setting takes %g ms, the fastest that fits takes about %.0f ms", r->wish.time_ms,
                   s->seconds * 1000);
        return false;
    }
    if (s->psnr < r->wish.error_db) {
        bool may_draft = r->settings.cells == CELLS_FLAT && r->header == NULL && !r->settings.has_approx && !r->settings.has_approx_depth;
        tool_error(r->scene, 0, "no setting within %" PRIu64 " bytes has %g dB, the best of those that were probed has about %.1f dB%s",
                   r->wish.memory, r->wish.error_db, s->psnr, may_draft ? "; a draft may have (--cells plane)" : "");
        return false;
    }
    if (!is_standard(r->header)) {
        print(p, s);
    }
    return r->header == NULL || plan_write_header(r->header, m, r->scene, s, wish);
}

static bool plan_from(const request *r, tool_source *source) {
    aset_counter counter;
    measured m;
    plan p;
    aset_sink sink = aset_counter_sink(&counter);
    if (!tool_source_read(source, &sink)) {
        return false;
    }
    tool_source_rules(source, &r->settings, &counter.counts);
    if (!measured_open(&m, source, &counter.counts)) {
        return false;
    }
    plan_wish wish = r->wish;
    const settings *given = &r->settings;
    wish.holds_scene = r->header != NULL;
    wish.samples = given->samples;
    wish.curtail = given->curtail;
    wish.curtail_more = given->curtail_more;
    wish.cells = given->cells;
    wish.given = given;
    wish.source = source;
    memcpy(wish.grid, given->grid, sizeof wish.grid);
    wish.has_approx = given->has_approx || given->has_approx_depth;
    wish.approx_kinds = given->has_approx ? given->approx_kinds : ASET_ALL_KINDS;
    wish.approx_depth = given->approx_depth;
    aset_view *view = &m.scene.view;
    wish.width = r->settings.width > 0 ? r->settings.width : view->width_px > 0 ? view->width_px : 512;
    wish.height = r->settings.height > 0 ? r->settings.height : view->height_px > 0 ? view->height_px : 512;
    bool done = settings_view(view, &r->settings, r->scene) && plan_make(&p, &m, r->scene, &wish) && tell(r, &p, &m, &wish);
    free(m.block);
    return done;
}

static bool parse_method(request *r, const char *text) {
    plan_wish *w = &r->wish;
    w->method = tool_method_find(text, &r->is_aset);
    if (w->method != &aset_mset && w->method != &aset_grid && w->method != &aset_set && w->method != &aset_brute) {
        tool_error(NULL, 0, "--method: a plan has no \"%s\", expected mset, aset, grid, set or brute", text);
        return false;
    }
    return true;
}

static bool parse_option(request *r, int option) {
    plan_wish *w = &r->wish;
    switch (option) {
    case 'm': return parse_method(r, optarg);
    case 'g': return tool_parse_grid("--grid", optarg, ASET_DIVISIONS_MAX, r->settings.grid);
    case 'c': return settings_parse_cells(&r->settings, optarg);
    case 'q': return true;
    case 'M': return tool_parse_bytes("--memory", optarg, 0, SIZE_MAX / 2, &w->memory);
    case 'e': return tool_parse_real("--error", optarg, 1, 99, &w->error_db);
    case 't': return tool_parse_real("--time", optarg, 0.001, 1e9, &w->time_ms);
    case 'H': r->header = optarg; return true;
    case 's': return tool_parse_size("--size", optarg, TOOL_DRAWN_MAX, &r->settings.width, &r->settings.height);
    case 'a': r->all = true; return true;
    case 'j': r->json = true; return true;
    case 'h': r->wants_help = true; return true;
    default: return settings_option(&r->settings, option);
    }
}

static bool parse_request(request *r, int argc, char **argv) {
    static const struct option longs[] = {
        {"memory", required_argument, NULL, 'M'}, {"error", required_argument, NULL, 'e'},
        {"method", required_argument, NULL, 'm'}, {"grid", required_argument, NULL, 'g'},
        {"quiet", no_argument, NULL, 'q'},        SETTINGS_DRAWING_OPTIONS,
        {"time", required_argument, NULL, 't'},   {"header", required_argument, NULL, 'H'},
        {"size", required_argument, NULL, 's'},   {"cells", required_argument, NULL, 'c'},
        {"all", no_argument, NULL, 'a'},          {"json", no_argument, NULL, 'j'},
        {"help", no_argument, NULL, 'h'},         SETTINGS_CAMERA_OPTIONS,
        SETTINGS_MODEL_OPTIONS,                   SETTINGS_SMOOTH_OPTION,
        {NULL, 0, NULL, 0},
    };
    int option;
    memset(r, 0, sizeof *r);
    r->settings = settings_default();
    r->wish.memory = 8u << 20;
    while ((option = tool_option_next(argc, argv, "m:s:qh", longs)) != -1) {
        if (option == '?' || !parse_option(r, option)) {
            return false;
        }
        if (r->wants_help) {
            return true;
        }
    }
    r->settings.has_approx_depth = r->settings.has_approx_depth || r->is_aset; /* all rays from 1 on, but for what other words say */
    r->wish.depth = r->settings.depth;
    r->wish.spd_rules = r->settings.spd_rules;
    if (r->settings.leaf > 0) {
        tool_error(NULL, 0, "--leaf: a plan has no octree, ARTS or EXCELL, expected a plan without");
        return false;
    }
    const settings *given = &r->settings;
    bool is_approximate = given->has_approx ? given->approx_kinds != 0 : given->has_approx_depth;
    if (r->wish.method == &aset_brute && (given->grid[0] > 0 || is_approximate)) {
        tool_error(NULL, 0, "plan: --method: brute force has no divisions and approximates nothing here, expected mset, grid or set");
        return false;
    }
    if (!settings_check(given)) {
        return false;
    }
    if (given->cells != CELLS_FLAT && r->wish.method != NULL && r->wish.method != &aset_mset && r->wish.method != &aset_grid) {
        tool_error(NULL, 0, "plan: --cells: only mset and grid have drafts, expected one of them, or flat cells");
        return false;
    }
    if (given->cells != CELLS_FLAT && r->header != NULL) {
        tool_error(NULL, 0, "plan: --cells: a header is of flat cells, expected no --header (a draft in C: aset bake -o FILE.h)");
        return false;
    }
    if (r->wish.error_db > 0 && r->wish.time_ms > 0) {
        tool_error(NULL, 0, "plan: --error and --time are alternatives, expected one of them");
        return false;
    }
    if (is_standard(r->header) && (r->json || r->all)) {
        tool_error(NULL, 0, "plan: --header: standard output takes the header alone, expected a file for it");
        return false;
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "plan: expected one scene, got %d words; aset plan --help tells more", argc - optind);
        return false;
    }
    r->scene = argv[optind];
    return true;
}

int command_plan(int argc, char **argv) {
    request r;
    tool_source source;
    if (!parse_request(&r, argc, argv)) {
        return TOOL_USAGE;
    }
    if (r.wants_help) {
        return tool_help(help);
    }
    if (!tool_source_open(&source, r.scene)) {
        return TOOL_FAILED;
    }
    tool_source_set(&source, &r.settings);
    bool done = plan_from(&r, &source);
    tool_source_close(&source);
    if (done && fflush(stdout) != 0) {
        tool_error(NULL, 0, "standard output cannot be written");
        done = false;
    }
    return done ? TOOL_DONE : TOOL_FAILED;
}
