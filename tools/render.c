/*
 * render.c - the command `aset render`: draws a scene row by row, with any number of threads, into a picture file.
 *
 * Threads take the next row each, of a draft the next sixteen; what is finished waits until all above it is written, so the file is
 * written in order and no thread is ever more than one such turn ahead of the slowest. No frame is held.
 */
#include "prepare.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define THREADS_MAX 256u

static const char help[] =
    "aset render SCENE [-o OUT.png]: draws a scene exactly or approximately, in a fixed block of memory.\n"
    "SCENE is an .nff file, a model (.obj, .stl, .ply), a .draft that aset bake made (which is drawn with --approx all\n"
    "--approx-depth 0 --cells plane), or - for any of these on standard input. Without -o the picture is drawn\n"
    "and thrown away. A model, which has none, gets a view that shows all of it, two lights, a ground and a background.\n"
    "\n"
    "  -o, --output FILE       .png or .ppm; - for PNG on standard output\n"
    "      --png               OUT is a PNG, whatever its name ends in\n"
    "  -m, --method NAME       mset, set, grid, octree, arts, excell or brute; default mset;\n"
    "                          aset stands for mset --approx all --approx-depth 1\n"
    "      --approx KINDS      rays that may be approximate: primary,shadow,reflected,refracted, all or none; default none\n"
    "      --approx-depth L    rays of depth L and deeper are (the eye ray has depth 0); default 1. With --approx all from 0 on\n"
    "                          mset and grid hold no object, and read SCENE several times\n"
    "      --grid N            divisions on every axis; or NXxNYxNZ, or auto (as many as pay and fit); default auto;\n"
    "                          up to 2048, of drafts 512\n"
    "      --octree-depth D    octree, arts, excell: halvings of each axis, 1 to 10; default 6\n"
    "      --leaf K            octree, arts, excell: objects in a leaf that is not halved; default 1\n"
    "      --cells WORD        what a cell remembers: flat, the paper's average texture; normal or plane, drafts of mset\n"
    "                          and grid: the surface's direction besides, or where it lies as well; default flat\n"
    "      --curtail F         trapped rays: fraction of a voxel's diagonal, 0 for off; default 0.5\n"
    "      --curtail-when W    less or more: which side of it is curtailed; default less\n"
    "      --memory BYTES      the arena (K = 1024, M): not one byte more is used; default 8M\n"
    "  -s, --size WxH          picture; N is NxN; default the scene's, else 512x512\n"
    "      --samples N         rays a pixel: 1, 4, 9, 16 ... 4096; default 1\n"
    "      --depth N           rays in a chain, the eye ray being 1, up to 1000; default 5\n"
    "      --rules spd         the SPD testing procedure: (W + 1) x (H + 1) rays through pixel corners, so that\n"
    "                          many pixels; opaque surfaces one-sided\n"
    "      --rows A:B          only the rows A to B - 1 of the picture\n"
    "  -j, --threads N         up to 256; default 1\n"
    "      --from X,Y,Z --at X,Y,Z --up X,Y,Z --angle DEG   the camera, instead of the scene's\n"
    "      --up-axis y|z       models: the axis that points upwards; default z for .stl and .ply, y for .obj\n"
    "      --ground on|off     models: a ground under it; default on\n"
    "      --smooth            models: shaded by the normals at their vertices where they have some\n"
    "      --transparent       pixels that show no object are transparent (PNG); models then have no ground by default\n"
    "      --stats FILE        statistics as JSON; - for standard output\n"
    "      --report            statistics as text on standard output\n"
    "  -q, --quiet             no progress bar\n"
    "  -h, --help              this text\n";

enum {
    OPTION_GRID = 256,
    OPTION_OCTREE_DEPTH,
    OPTION_CELLS,
    OPTION_MEMORY,
    OPTION_ROWS,
    OPTION_TRANSPARENT,
    OPTION_STATS,
    OPTION_REPORT,
    OPTION_PNG
};

static const struct option longs[] = {
    {"output", required_argument, NULL, 'o'},
    {"method", required_argument, NULL, 'm'},
    {"grid", required_argument, NULL, OPTION_GRID},
    {"octree-depth", required_argument, NULL, OPTION_OCTREE_DEPTH},
    {"cells", required_argument, NULL, OPTION_CELLS},
    SETTINGS_DRAWING_OPTIONS,
    {"memory", required_argument, NULL, OPTION_MEMORY},
    {"size", required_argument, NULL, 's'},
    {"rows", required_argument, NULL, OPTION_ROWS},
    {"threads", required_argument, NULL, 'j'},
    SETTINGS_CAMERA_OPTIONS,
    SETTINGS_MODEL_OPTIONS,
    SETTINGS_SMOOTH_OPTION,
    {"transparent", no_argument, NULL, OPTION_TRANSPARENT},
    {"stats", required_argument, NULL, OPTION_STATS},
    {"report", no_argument, NULL, OPTION_REPORT},
    {"png", no_argument, NULL, OPTION_PNG},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

/* What render was asked for beside the settings. */
typedef struct request {
    settings settings;
    const char *scene, *output, *stats;
    bool report, quiet, is_png, has_rows, has_cells, wants_help, is_aset;
    uint32_t first_row, end_row;
} request;

static bool parse_method(request *r, const char *text) {
    const aset_method *method = tool_method_find(text, &r->is_aset);
    if (method == NULL) {
        tool_error(NULL, 0, "--method: \"%s\" is no method, expected mset, aset, set, grid, octree, arts, excell or brute",
                   text);
        return false;
    }
    r->settings.method = method;
    return true;
}

static bool parse_more(request *r, int option) {
    settings *s = &r->settings;
    switch (option) {
    case OPTION_CELLS: r->has_cells = true; return settings_parse_cells(s, optarg);
    case OPTION_ROWS: r->has_rows = true; return tool_parse_range("--rows", optarg, 65536, &r->first_row, &r->end_row);
    case OPTION_STATS: r->stats = optarg; return true;
    case OPTION_REPORT: r->report = true; return true;
    case OPTION_PNG: r->is_png = true; return true;
    case OPTION_TRANSPARENT: s->transparent = true; return true;
    default: return settings_option(s, option);
    }
}

static bool parse_option(request *r, int option) {
    settings *s = &r->settings;
    switch (option) {
    case 'o': return tool_parse_output(optarg, &r->output);
    case 'm': return parse_method(r, optarg);
    case OPTION_GRID: return tool_parse_grid("--grid", optarg, ASET_DIVISIONS_MAX, s->grid);
    case OPTION_OCTREE_DEPTH:
        return tool_parse_count("--octree-depth", optarg, 1, ASET_DEPTH_TREE_MAX, &s->tree_depth);
    case OPTION_MEMORY: return tool_parse_bytes("--memory", optarg, 0, SIZE_MAX / 2, &s->memory);
    case 's': return tool_parse_size("--size", optarg, TOOL_DRAWN_MAX, &s->width, &s->height);
    case 'j': return tool_parse_count("--threads", optarg, 1, THREADS_MAX, &s->threads);
    case 'q': r->quiet = true; return true;
    case 'h': r->wants_help = true; return true;
    default: return parse_more(r, option);
    }
}

/* Words that are right by themselves and not together. */
static bool check_request(const request *r) {
    const settings *s = &r->settings;
    const uint32_t *grid = s->grid;
    bool more = r->report || (r->stats != NULL && strcmp(r->stats, "-") == 0);
    if (r->output != NULL && !r->is_png && !tool_picture_path_ok(r->output)) {
        return false;
    }
    if (r->output != NULL && strcmp(r->output, "-") == 0 && more) {
        tool_error(NULL, 0, "%s: the picture already goes to standard output, expected a file for %s",
                   r->report ? "--report" : "--stats", r->report ? "it" : "one of them");
        return false;
    }
    if (r->report && r->stats != NULL && strcmp(r->stats, "-") == 0) {
        tool_error(NULL, 0, "--report: --stats already goes to standard output, expected a file for that");
        return false;
    }
    if (r->output != NULL && r->stats != NULL && strcmp(r->output, r->stats) == 0 && strcmp(r->output, "-") != 0) {
        tool_error(NULL, 0, "--stats: %s is the picture, expected another file", r->stats);
        return false;
    }
    if (s->cells != CELLS_FLAT && s->method != &aset_mset && s->method != &aset_grid) {
        tool_error(NULL, 0, "--method: %s has no drafts, expected mset or grid, or --cells flat", aset_method_name(s->method));
        return false;
    }
    if (s->cells != CELLS_FLAT && s->approx_kinds != 0 && (grid[0] > ASET_BAKE_DIVISIONS_MAX || grid[1] > ASET_BAKE_DIVISIONS_MAX || grid[2] > ASET_BAKE_DIVISIONS_MAX)) {
        tool_error(NULL, 0, "--grid: too many divisions for a draft, expected at most %u, or --cells flat", ASET_BAKE_DIVISIONS_MAX);
        return false;
    }
    if (!settings_check(s)) {
        return false;
    }
    if (s->transparent && r->output != NULL && !r->is_png && tool_has_extension(r->output, ".ppm")) {
        tool_error(NULL, 0, "--transparent: %s cannot be transparent, expected a .png", r->output);
        return false;
    }
    return true;
}

/* A baked draft has nothing exact to draw but what it keeps, so every ray is approximate. */
static bool set_baked(request *r) {
    settings *s = &r->settings;
    if (s->grid[0] > 0 || s->smooth || s->has_ground || s->has_up_axis) {
        tool_error(NULL, 0, "%s: %s is a draft already, expected it for the model that it was baked from",
                   s->grid[0] > 0 ? "--grid" : s->smooth ? "--smooth" : s->has_ground ? "--ground" : "--up-axis", r->scene);
        return false;
    }
    if ((s->has_approx && s->approx_kinds != ASET_ALL_KINDS) || (s->has_approx_depth && s->approx_depth != 0)) {
        tool_error(NULL, 0, "--approx: %s is a draft, expected --approx all --approx-depth 0, or neither", r->scene);
        return false;
    }
    if (r->has_cells && s->cells == CELLS_FLAT) {
        tool_error(NULL, 0, "--cells: %s is a draft, expected plane or normal, or for flat cells the model that it was baked from",
                   r->scene);
        return false;
    }
    s->approx_kinds = ASET_ALL_KINDS;
    s->approx_depth = 0;
    s->cells = s->cells == CELLS_FLAT ? CELLS_PLANE : s->cells;
    return true;
}

/* as_draft: where the words say nothing else it is one. */
static bool parse_request(request *r, int argc, char **argv, bool as_draft) {
    int option;
    settings *s = &r->settings;
    memset(r, 0, sizeof *r);
    *s = settings_default();
    if (as_draft) {
        s->approx_kinds = ASET_ALL_KINDS;
        s->approx_depth = 0;
        s->cells = CELLS_PLANE;
        s->memory = 1u << 20;
    }
    while ((option = tool_option_next(argc, argv, "o:m:s:j:qh", longs)) != -1) {
        if (option == '?' || !parse_option(r, option)) {
            return false;
        }
        if (r->wants_help) {
            return true;
        }
    }
    if (argc - optind != 1) {
        tool_error(NULL, 0, "render: expected one scene, got %d words; aset render --help tells more", argc - optind);
        return false;
    }
    r->scene = argv[optind];
    if (r->is_aset) {
        s->approx_kinds = s->has_approx ? s->approx_kinds : ASET_ALL_KINDS;
        s->approx_depth = s->has_approx_depth ? s->approx_depth : 1;
        s->cells = r->has_cells ? s->cells : CELLS_FLAT;
    }
    return (!tool_is_draft(r->scene) || set_baked(r)) && check_request(r);
}

/* Rows that a thread draws at a time of a draft, whose beams go through the voxels of as many. */
#define DRAFT_ROWS 16u

/* What the threads share; the lock guards next, written and failed. */
typedef struct crew {
    const prepared *p;
    tool_picture *file; /* NULL: thrown away */
    uint32_t first, end, columns, channels, next, written;
    uint32_t at_once; /* rows that a thread takes */
    bool failed;
    pthread_mutex_t lock;
    pthread_cond_t turn;
} crew;

typedef struct worker {
    crew *crew;
    aset_scratch *scratch;
    aset_statistics statistics;
    uint8_t *rows;
} worker;

/*
 * Rows whose colours are mixed with the background, by coverage, into some whose colours are the objects' own, as PNG has
 * it: else a light rim would show around the object on any other background.
 */
static void unmix(uint8_t *row, uint32_t pixels, const aset_colour *background) {
    const aset_real back[3] = {background->r, background->g, background->b};
    for (uint32_t i = 0; i < pixels; i++, row += 4) {
        float alpha = (float)row[3] / 255;
        for (int k = 0; k < 3; k++) {
            float behind = back[k] < 1 ? (float)back[k] * 255 : 255;
            float own = alpha > 0 ? ((float)row[k] - (1 - alpha) * behind) / alpha + 0.5f : 0;
            row[k] = own > 0 ? own < 255 ? (uint8_t)own : 255 : 0;
        }
    }
}

static void draw_rows(worker *w) {
    crew *c = w->crew;
    aset_picture picture;
    memset(&picture, 0, sizeof picture);
    picture.width = c->p->view.width_px;
    picture.height = c->p->view.height_px;
    picture.format = c->channels == 4 ? ASET_RGBA8888 : ASET_RGB888;
    picture.transparent = c->channels == 4;
    picture.pixels = w->rows;
    picture.stride = (size_t)c->columns * c->channels;
    (void)pthread_mutex_lock(&c->lock);
    while (!c->failed && c->next < c->end) {
        uint32_t row = c->next, whole = c->at_once - row % c->at_once, n = whole < c->end - row ? whole : c->end - row;
        c->next += n;
        (void)pthread_mutex_unlock(&c->lock);
        aset_status status =
            aset_render_rows(&c->p->tracer, &c->p->view, &picture, row, n, w->scratch, &w->statistics);
        if (c->channels == 4) {
            unmix(w->rows, n * c->columns, &c->p->tracer.scene->background);
        }
        (void)pthread_mutex_lock(&c->lock);
        while (!c->failed && c->written != row) {
            (void)pthread_cond_wait(&c->turn, &c->lock);
        }
        if (status != ASET_OK && !c->failed) {
            tool_error(c->p->path, 0, "%s", aset_status_text(status));
            c->failed = true;
        }
        for (uint32_t i = 0; i < n && !c->failed; i++) {
            if (c->file != NULL && !tool_picture_row(c->file, w->rows + i * picture.stride)) {
                c->failed = true;
            }
            c->written++;
            tool_progress_step(c->written - c->first);
        }
        (void)pthread_cond_broadcast(&c->turn);
    }
    (void)pthread_mutex_unlock(&c->lock);
}

static void *work(void *context) {
    draw_rows(context);
    return NULL;
}

/* Draws with as many threads as there are scratches; this thread is the first of them. */
static bool draw(crew *c, uint32_t n_threads, aset_statistics *statistics) {
    worker *workers = calloc(n_threads, sizeof *workers);
    pthread_t *threads = calloc(n_threads, sizeof *threads);
    size_t row_bytes = (size_t)c->columns * c->channels;
    uint8_t *rows = malloc(n_threads * c->at_once * row_bytes);
    uint32_t n_started = 1;
    bool ready = workers != NULL && threads != NULL && rows != NULL;
    if (!ready) {
        tool_error(c->p->path, 0, "no memory for %" PRIu32 " rows of the picture", n_threads * c->at_once);
        c->failed = true;
    }
    for (uint32_t i = 0; ready && i < n_threads; i++) {
        workers[i].crew = c;
        workers[i].scratch = &c->p->scratches[i];
        workers[i].rows = rows + i * c->at_once * row_bytes;
    }
    while (ready && n_started < n_threads && pthread_create(&threads[n_started], NULL, work, &workers[n_started]) == 0) {
        n_started++; /* fewer threads than asked for draw the same picture */
    }
    if (ready) {
        draw_rows(&workers[0]);
    }
    for (uint32_t i = 1; ready && i < n_started; i++) {
        (void)pthread_join(threads[i], NULL);
    }
    for (uint32_t i = 0; ready && i < n_started; i++) {
        aset_statistics_add(statistics, &workers[i].statistics);
    }
    free(workers);
    free(threads);
    free(rows);
    return !c->failed;
}

static bool draw_picture(const request *r, const prepared *p, aset_statistics *statistics) {
    crew c;
    memset(&c, 0, sizeof c);
    uint32_t extra = r->settings.spd_rules, rows = p->view.height_px + extra;
    c.p = p;
    c.columns = p->view.width_px + extra;
    c.channels = r->settings.transparent ? 4 : 3;
    c.at_once = p->tracer.draft != NULL ? DRAFT_ROWS : 1;
    c.first = c.next = c.written = r->has_rows ? r->first_row : 0;
    c.end = r->has_rows ? r->end_row : rows;
    if (c.end > rows) {
        tool_error(NULL, 0, "--rows: the picture has %" PRIu32 " rows, %" PRIu32 " is behind the last", rows, c.end - 1);
        return false;
    }
    if (r->output != NULL) {
        c.file = (r->is_png ? tool_picture_open_png : tool_picture_open)(r->output, c.columns, c.end - c.first, c.channels);
        if (c.file == NULL) {
            return false;
        }
    }
    (void)pthread_mutex_init(&c.lock, NULL);
    (void)pthread_cond_init(&c.turn, NULL);
    tool_progress_start("rows", c.end - c.first, r->quiet);
    bool done = draw(&c, c.p->n_threads, statistics);
    tool_progress_end();
    (void)pthread_cond_destroy(&c.turn);
    (void)pthread_mutex_destroy(&c.lock);
    if (c.file != NULL) {
        if (done) {
            done = tool_picture_close(c.file);
        } else {
            tool_picture_abort(c.file);
        }
    }
    return done;
}

typedef size_t (*report_writer)(char *buffer, size_t size, const aset_report *report);

static bool write_report(tool_output *output, const aset_report *report, report_writer writer) {
    size_t n = writer(NULL, 0, report);
    char *text = malloc(n + 1);
    if (text == NULL) {
        tool_error(NULL, 0, "no memory for a report of %zu bytes", n);
        return false;
    }
    (void)writer(text, n + 1, report);
    bool done = tool_output_write(output, text, n);
    free(text);
    return done && tool_output_close(output);
}

static int render(const request *r) {
    prepared p;
    aset_statistics statistics;
    memset(&statistics, 0, sizeof statistics);
    if (!prepare(&p, &r->settings, r->scene)) {
        return TOOL_FAILED;
    }
    /* opened before the work, so that a place that can't be written is known at once */
    tool_output stats, text;
    memset(&stats, 0, sizeof stats);
    memset(&text, 0, sizeof text);
    bool done = (r->stats == NULL || tool_output_open(&stats, r->stats)) && (!r->report || tool_output_open(&text, "-"));
    double start = tool_seconds();
    done = done && draw_picture(r, &p, &statistics);
    aset_arena_release(&p.arena, &p.mark); /* what is used is what is kept; the peak stays */
    aset_report report = {&p.tracer, &p.arena, &statistics, aset_method_name(r->settings.method), settings_cells_names[r->settings.cells],
                          p.load_s,  p.build_s, tool_seconds() - start, &p.counts};
    if (done && r->stats != NULL) {
        done = write_report(&stats, &report, aset_report_json);
    }
    if (done && r->report) {
        done = write_report(&text, &report, aset_report_text);
    }
    if (!done) {
        tool_output_abort(&stats);
        tool_output_abort(&text);
    }
    prepare_free(&p);
    return done ? TOOL_DONE : TOOL_FAILED;
}

static int command(int argc, char **argv, bool as_draft) {
    request r;
    if (!parse_request(&r, argc, argv, as_draft)) {
        return TOOL_USAGE;
    }
    return r.wants_help ? tool_help(help) : render(&r);
}

int command_render(int argc, char **argv) {
    return command(argc, argv, false);
}

int command_render_draft(int argc, char **argv) {
    return command(argc, argv, true);
}
