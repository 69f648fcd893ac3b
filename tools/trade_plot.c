/*
 * trade_plot.c - a group's error against its time or its bytes, drawn by gnuplot: a panel for each method, with axes alike.
 *
 * Shapes and filling tell the settings apart, so that colour is only a help: a shape for each kind of approximation,
 * filled with curtailment and open without, the larger the finer the divisions, in a ring where no other setting beats it.
 * A draft's shape is open and has a mark within: a dot if its cells remember planes, a cross for normals.
 * Pictures equal to the exact one (99 dB) stand on a line of their own above all others.
 *
 * gnuplot gets the script on its standard input and writes SVG on its standard output; no shell is in between.
 */
#include "metrics.h"
#include "trade.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define WIDTH_PX 1000
#define PANEL_HEIGHT_PX 300
/* Above the panels the title, below them the legend. */
#define HEAD_PX 40
#define FOOT_PX 150
#define COLUMNS_MAX 3u
#define NAME_MAX_CHARS 60u

/* Of approximations: gnuplot's number of the filled shape (the open one is one below), and a colour (Okabe and Ito 2008). */
static const struct {
    int shape;
    const char *colour;
} styles[TRADE_APPROXES] = {{5, "#000000"}, {7, "#0072b2"}, {9, "#d55e00"}, {11, "#009e73"}, {13, "#cc79a7"}, {15, "#e69f00"}};

/*
 * Blocks of points: two for each approximation (open, filled), one for each kind of drafts and approximation, the rings.
 */
enum { BLOCK_DRAFTS = 2 * TRADE_APPROXES, BLOCK_RINGS = (1 + SETTINGS_CELLS) * TRADE_APPROXES };

/* A draft's shape is this much larger, for the mark within it; by settings_cells: gnuplot's number of the mark, its size. */
#define DRAFT_SIZE 1.4
static const struct {
    int shape;
    double size;
} marks[SETTINGS_CELLS] = {{0, 0}, {1, 0.45}, {7, 0.3}};

/* What the axes of all panels of a plot show. */
typedef struct scale {
    const trade *t;
    const trade_group *group;
    int against;
    double low, high;   /* of x */
    double bottom, top; /* of y; top is where 99 dB stand */
    const aset_method *methods[16];
    uint32_t n_methods, columns, rows;
} scale;

static double place_x(const scale *a, const trade_setting *s) {
    return a->against == TRADE_TIME ? s->time : (double)s->figures.peak / 1024.0;
}

static double place_y(const scale *a, const trade_setting *s) {
    return s->figures.psnr >= METRICS_PSNR_MAX ? a->top : s->figures.psnr;
}

static void find_scale(scale *a) {
    double least = METRICS_PSNR_MAX, most = 0;
    a->low = INFINITY;
    for (uint32_t i = 0; i < a->t->n_settings; i++) {
        const trade_setting *s = &a->t->settings[i];
        if (s->group != a->group) {
            continue;
        }
        double x = place_x(a, s), y = s->figures.psnr;
        a->low = x < a->low ? x : a->low;
        a->high = x > a->high ? x : a->high;
        if (y < METRICS_PSNR_MAX) {
            least = y < least ? y : least;
            most = y > most ? y : most;
        }
        if (a->n_methods == 0 || a->methods[a->n_methods - 1] != s->method) {
            a->methods[a->n_methods++] = s->method; /* settings come method by method */
        }
    }
    double beside = a->high > 2 * a->low ? 1.15 : 1.5; /* over an octave, or there might be no tic among them */
    a->low /= beside;
    a->high *= beside;
    a->bottom = least < most ? floor(least / 5 - 0.3) * 5 : floor(fmin(least, 20) / 5 - 0.3) * 5;
    a->top = ceil(fmax(most, a->bottom + 5) / 5 + 0.3) * 5 + 5;
    a->columns = a->n_methods < COLUMNS_MAX ? a->n_methods : COLUMNS_MAX;
    a->rows = (a->n_methods + a->columns - 1) / a->columns;
}

/* Text between single quotes, as gnuplot takes it. */
static void print_quoted(FILE *f, const char *text) {
    for (; *text != 0; text++) {
        unsigned char c = (unsigned char)*text;
        (void)fputs(c == '\'' ? "'" : "", f);
        (void)fputc(c < 0x20 ? '?' : c, f);
    }
}

/* The scene's name; of a long one the end, so that the title does not leave the picture. */
static void print_name(FILE *f, const char *name) {
    size_t n = strlen(name);
    (void)fputs(n > NAME_MAX_CHARS ? "..." : "", f);
    print_quoted(f, n > NAME_MAX_CHARS ? name + n - NAME_MAX_CHARS : name);
}

/* Tics at powers of two; of a higher power where their numbers would meet, at half steps where under three. */
static void print_tics(FILE *f, const scale *a) {
    double octaves = log2(a->high / a->low), most = a->against == TRADE_TIME ? 4 : 5; /* a fraction's digits are more */
    double step = octaves > most ? ceil(octaves / most) : 1;
    bool first = true, half = octaves < 2.2;
    (void)fputs("set xtics (", f);
    for (double e = floor(log2(a->low) / step) * step; e < log2(a->high); e += step) {
        for (int k = 0; k <= half; k++) {
            double x = exp2(e) * (k == 0 ? 1 : 1.5);
            if (x >= a->low && x <= a->high) {
                (void)fprintf(f, x < 1 ? "%s'%.3g' %.9g" : "%s'%.9g' %.9g", first ? "" : ",", x, x);
                first = false;
            }
        }
    }
    (void)fputs(") nomirror\nset ytics (", f);
    double y_step = a->top > a->bottom + 45 ? 10 : 5;
    for (double y = a->bottom; y < a->top - 4; y += y_step) {
        (void)fprintf(f, "%g,", y);
    }
    (void)fprintf(f, "'exact' %g) nomirror\n", a->top);
}

static void print_head(FILE *f, const scale *a, int height) {
    (void)fprintf(f, "set terminal svg size %d,%d font 'sans-serif,13' background '#ffffff' noenhanced\n", WIDTH_PX, height);
    (void)fprintf(f, "set multiplot\nset label 1 '");
    print_name(f, a->group->scene->name);
    (void)fprintf(f, ", %" PRIu32 "x%" PRIu32 ": error against %s' at screen 0.5,%.4f center font ',16'\n", a->group->width,
                  a->group->height, a->against == TRADE_TIME ? "time" : "memory", 1 - 0.5 * HEAD_PX / height);
    (void)fprintf(f, "set logscale x 2\nset xrange [%.9g:%.9g]\nset yrange [%g:%g]\nset border 3\nset grid lc '#cccccc'\n",
                  a->low, a->high, a->bottom, a->top + 2);
    (void)fputs("set datafile separator ' '\nunset key\n", f);
    print_tics(f, a);
}

static int block_of(const trade_setting *s) {
    return s->cells == CELLS_FLAT ? 2 * (int)s->approx + (s->curtail > 0)
                                  : BLOCK_DRAFTS + ((int)s->cells - 1) * TRADE_APPROXES + (int)s->approx;
}

/* The points of a panel, block by block. */
static void print_points(FILE *f, const scale *a, const aset_method *method) {
    uint32_t finest = 1;
    for (uint32_t i = 0; i < a->t->n_settings; i++) {
        const trade_setting *s = &a->t->settings[i];
        uint32_t n = s->tree_depth > 0 ? 1u << s->tree_depth : s->grid[0];
        finest = s->group == a->group && s->method == method && n > finest ? n : finest;
    }
    for (int block = 0; block <= BLOCK_RINGS; block++) {
        (void)fprintf(f, "$d%d << EOD\nNaN NaN 1\n", block);
        for (uint32_t i = 0; i < a->t->n_settings; i++) {
            const trade_setting *s = &a->t->settings[i];
            bool in = block == BLOCK_RINGS ? s->best : block == block_of(s);
            if (s->group == a->group && s->method == method && in) {
                uint32_t n = s->tree_depth > 0 ? 1u << s->tree_depth : s->grid[0];
                double size = 0.95 + 0.2 * log2((n > 0 ? (double)n : 1) / finest);
                (void)fprintf(f, "%.9g %.9g %.3f\n", place_x(a, s), place_y(a, s), size > 0.4 ? size : 0.4);
            }
        }
        (void)fputs("EOD\n", f);
    }
}

static void print_panel(FILE *f, const scale *a, uint32_t k, int height) {
    uint32_t column = k % a->columns, row = k / a->columns;
    double cell_width = 1.0 / a->columns, cell_height = (double)PANEL_HEIGHT_PX / height;
    double left = column * cell_width, up = 1 - (double)HEAD_PX / height - row * cell_height;
    print_points(f, a, a->methods[k]);
    (void)fprintf(
        f,
        "set lmargin at screen %.4f\nset rmargin at screen %.4f\nset tmargin at screen %.4f\nset bmargin at screen %.4f\n",
        left + 75.0 / WIDTH_PX, left + cell_width - 25.0 / WIDTH_PX, up - 25.0 / height, up - cell_height + 70.0 / height);
    (void)fprintf(f, "set title '%s' offset 0,-0.7\n", aset_method_name(a->methods[k]));
    (void)fprintf(f, "set xlabel '%s'\nset ylabel '%s' offset 1.5,0\n",
                  a->against == TRADE_TIME ? "build and render time, exact mset = 1" : "peak of the arena, KiB", "PSNR, dB");
    (void)fputs("plot ", f);
    for (int i = 0; i < TRADE_APPROXES; i++) {
        (void)fprintf(f,
                      "$d%d using 1:2:3 with points pt %d ps variable lc '%s', $d%d using 1:2:3 with points pt %d ps "
                      "variable lc '%s', ",
                      2 * i, styles[i].shape - 1, styles[i].colour, 2 * i + 1, styles[i].shape, styles[i].colour);
    }
    for (int block = BLOCK_DRAFTS; block < BLOCK_RINGS; block++) {
        int i = (block - BLOCK_DRAFTS) % TRADE_APPROXES, cells = 1 + (block - BLOCK_DRAFTS) / TRADE_APPROXES;
        (void)fprintf(f,
                      "$d%d using 1:2:($3*%g) with points pt %d ps variable lc '%s', "
                      "$d%d using 1:2 with points pt %d ps %g lc '#000000', ",
                      block, DRAFT_SIZE, styles[i].shape - 1, styles[i].colour, block, marks[cells].shape,
                      marks[cells].size);
    }
    (void)fprintf(f, "$d%d using 1:2 with points pt 6 ps 1.7 lc '#000000'\nunset label 1\n", BLOCK_RINGS);
}

/* Whether the group has such settings; the legend does not explain what is not there. */
static bool has_cells(const scale *a, settings_cells cells) {
    bool has = false;
    for (uint32_t i = 0; i < a->t->n_settings; i++) {
        const trade_setting *s = &a->t->settings[i];
        has = has || (s->group == a->group && s->cells == cells && s->approx != TRADE_EXACT);
    }
    return has;
}

static bool has_approx(const scale *a, unsigned approx) {
    bool has = false;
    for (uint32_t i = 0; i < a->t->n_settings; i++) {
        has = has || (a->t->settings[i].group == a->group && a->t->settings[i].approx == approx);
    }
    return has;
}

static void print_legend(FILE *f, const scale *a, int height) {
    (void)fprintf(
        f,
        "unset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\nunset grid\nunset logscale\n"
        "set lmargin at screen 0.02\nset rmargin at screen 0.98\nset tmargin at screen %.4f\nset bmargin at screen %.4f\n"
        "set key center center horizontal Left reverse maxcols 3 samplen 1 width 2 spacing 1.3\n"
        "set xrange [0:1]\nset yrange [0:1]\nplot ",
        (FOOT_PX - 15.0) / height, 10.0 / height);
    for (unsigned i = 0; i < TRADE_APPROXES; i++) {
        if (has_approx(a, i)) {
            (void)fprintf(f, "NaN with points pt %d ps 0.95 lc '%s' title '%s%s', ", styles[i].shape, styles[i].colour,
                          i > TRADE_EXACT ? "approximate: " : "", a->t->approxes[i].text);
        }
    }
    for (int cells = CELLS_NORMAL; cells < SETTINGS_CELLS; cells++) {
        if (has_cells(a, (settings_cells)cells)) {
            (void)fprintf(f, "NaN with points pt %d ps %g lc '#000000' title '%s within: draft, cells %s', ",
                          marks[cells].shape, marks[cells].size, cells == CELLS_NORMAL ? "cross" : "dot",
                          settings_cells_names[cells]);
        }
    }
    (void)fputs("NaN with points pt 6 ps 0.95 lc '#000000' title 'open: no curtailment', "
                "NaN with points pt 6 ps 0.5 lc '#000000' title 'smaller: fewer divisions', "
                "NaN with points pt 6 ps 1.7 lc '#000000' title 'ring: best, no other beats it'\nunset multiplot\n",
                f);
}

/* All that comes from a descriptor, as text to be freed; NULL where there is no memory. */
static char *read_all(int from) {
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    char buffer[16384];
    for (ssize_t n; stream != NULL && (n = read(from, buffer, sizeof buffer)) > 0;) {
        (void)fwrite(buffer, 1, (size_t)n, stream);
    }
    if (stream == NULL || fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

enum { NO_GNUPLOT = 127 };

/* The child: the script is its standard input, the pipe its standard output; warnings stay on standard error. */
static void become_gnuplot(FILE *script, int out) {
    if (dup2(fileno(script), STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0) {
        (void)execlp("gnuplot", "gnuplot", "-", (char *)NULL);
    }
    _exit(NO_GNUPLOT);
}

/* Gives the script to gnuplot; its answer, or NULL, after an error line unless *absent is set. */
static char *run_gnuplot(FILE *script, bool *absent) {
    int ends[2], status = -1;
    char *text = NULL;
    rewind(script);
    if (pipe(ends) != 0) {
        tool_error(NULL, 0, "gnuplot cannot be started");
        return NULL;
    }
    pid_t child = fork();
    if (child == 0) {
        become_gnuplot(script, ends[1]);
    }
    (void)close(ends[1]);
    if (child > 0) {
        text = read_all(ends[0]);
        (void)waitpid(child, &status, 0);
    }
    (void)close(ends[0]);
    *absent = WIFEXITED(status) && WEXITSTATUS(status) == NO_GNUPLOT;
    if (text != NULL && (status != 0 || strstr(text, "</svg>") == NULL)) {
        free(text);
        text = NULL;
    }
    if (text == NULL && !*absent) {
        tool_error(NULL, 0, "gnuplot failed; the plot is left out");
    }
    return text;
}

char *trade_plot(const trade *t, const trade_group *group, int against, bool *absent) {
    scale a;
    memset(&a, 0, sizeof a);
    a.t = t;
    a.group = group;
    a.against = against;
    find_scale(&a);
    int height = HEAD_PX + FOOT_PX + (int)a.rows * PANEL_HEIGHT_PX;
    FILE *script = tmpfile();
    if (script == NULL) {
        tool_error(NULL, 0, "no temporary file for a plot");
        return NULL;
    }
    print_head(script, &a, height);
    for (uint32_t k = 0; k < a.n_methods; k++) {
        print_panel(script, &a, k, height);
    }
    print_legend(script, &a, height);
    char *svg = fflush(script) == 0 ? run_gnuplot(script, absent) : NULL;
    (void)fclose(script);
    return svg;
}
