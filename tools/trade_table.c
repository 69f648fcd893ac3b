/*
 * trade_table.c - the sweep as text: a line in trade.csv.partial for each measurement as it comes, trade.csv at the end; and
 * what follows from the figures: medians, relative times, best marks.
 *
 * Invariant: every line of the partial file that ends with a line end is whole, and tells by its hash and its key alone
 * which measurement it is. A sweep takes over all lines or refuses the file, so that no measurement is lost.
 */
#include "trade.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define KEY_FIELDS "scene,method,grid,octree_depth,approx,level,cells,curtail,size"
#define FIGURE_FIELDS "rays,tests,cells_visited,peak_bytes,psnr,rmse,ssim,max_difference,differing"

uint64_t trade_total(const trade_setting *s) {
    return s->build_time.median + s->render_time.median;
}

char *trade_path(const trade *t, const char *format, ...) {
    char *path = NULL;
    size_t size;
    FILE *stream = open_memstream(&path, &size);
    if (stream != NULL) {
        va_list arguments;
        (void)fprintf(stream, "%s/", t->directory);
        va_start(arguments, format);
        (void)vfprintf(stream, format, arguments);
        va_end(arguments);
        if (fclose(stream) == 0) {
            return path;
        }
    }
    free(path);
    tool_error(NULL, 0, "trade: no memory for the name of a file");
    return NULL;
}

/* --- keys --- */

/* A field of text: in quotes, those within doubled, where it holds what would end it. A line end would split the row. */
static void print_field(FILE *stream, const char *text) {
    bool quoted = strpbrk(text, ",\"\r\n") != NULL;
    (void)fputs(quoted ? "\"" : "", stream);
    for (; *text != 0; text++) {
        (void)fputs(*text == '"' ? "\"" : "", stream);
        (void)fputc(*text == '\n' || *text == '\r' ? '?' : *text, stream);
    }
    (void)fputs(quoted ? "\"" : "", stream);
}

static void print_grid(FILE *stream, const uint32_t grid[3]) {
    if (grid[0] == 0) {
        return;
    }
    (void)fprintf(stream, "%" PRIu32, grid[0]);
    if (grid[1] != grid[0] || grid[2] != grid[0]) {
        (void)fprintf(stream, "x%" PRIu32 "x%" PRIu32, grid[1], grid[2]);
    }
}

static char *make_key(const trade_setting *s) {
    char *key = NULL;
    size_t size;
    FILE *stream = open_memstream(&key, &size);
    if (stream == NULL) {
        return NULL;
    }
    print_field(stream, s->group->scene->name);
    (void)fprintf(stream, ",%s,", aset_method_name(s->method));
    print_grid(stream, s->grid);
    (void)fputc(',', stream);
    if (s->tree_depth > 0) {
        (void)fprintf(stream, "%" PRIu32, s->tree_depth);
    }
    if (s->approx == TRADE_EXACT) {
        (void)fprintf(stream, ",%s,,,", s->rays->kinds);
    } else {
        (void)fputc(',', stream);
        print_field(stream, s->rays->kinds);
        (void)fprintf(stream, ",%" PRIu32 ",%s,", s->rays->level, settings_cells_names[s->cells]);
        if (s->cells == CELLS_FLAT) {
            (void)fprintf(stream, "%g", s->curtail);
        }
    }
    (void)fprintf(stream, ",%" PRIu32 "x%" PRIu32, s->group->width, s->group->height);
    if (fclose(stream) != 0) {
        free(key);
        return NULL;
    }
    return key;
}

bool trade_keys(trade *t) {
    for (uint32_t i = 0; i < t->n_settings; i++) {
        t->settings[i].key = make_key(&t->settings[i]);
        if (t->settings[i].key == NULL) {
            tool_error(NULL, 0, "trade: no memory for the table");
            return false;
        }
    }
    return true;
}

/* --- the partial file --- */

static void print_figures(FILE *stream, const trade_figures *f) {
    (void)fprintf(stream, "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.9g,%.9g,%.9g,%u,%.9g", f->rays, f->tests,
                  f->cells, f->peak, f->psnr, f->rmse, f->ssim, f->max_difference, f->differing);
}

/* The setting of a line's key, which *key points to; then *key points behind its comma. NULL: of no setting here. */
static trade_setting *find_setting(const trade *t, uint64_t hash, const char **key) {
    for (uint32_t i = 0; i < t->n_settings; i++) {
        trade_setting *s = &t->settings[i];
        size_t length = strlen(s->key);
        if (s->group->scene->hash == hash && strncmp(*key, s->key, length) == 0 && (*key)[length] == ',') {
            *key += length + 1;
            return s;
        }
    }
    return NULL;
}

/* Takes a line over: false if it is no measurement of this sweep. */
static bool read_line(trade *t, const char *line) {
    uint64_t hash, build, render;
    uint32_t round;
    int length = 0;
    trade_figures f;
    if (sscanf(line, "%16" SCNx64 ",%" SCNu32 ",%n", &hash, &round, &length) != 2 || length == 0) {
        return strncmp(line, "source,", 7) == 0;
    }
    const char *rest = line + length;
    trade_setting *s = find_setting(t, hash, &rest);
    if (s == NULL || round < 1 || round > t->rounds ||
        sscanf(rest, "%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%lf,%lf,%lf,%u,%lf", &build,
               &render, &f.rays, &f.tests, &f.cells, &f.peak, &f.psnr, &f.rmse, &f.ssim, &f.max_difference,
               &f.differing) != 11) {
        return false;
    }
    s->build[round - 1] = build;
    s->render[round - 1] = render;
    s->figures = f;
    s->has_figures = true;
    return true;
}

/* Takes all whole lines over; *end is where the last of them ends. A file that is not there has none. */
static bool read_partial(trade *t, const char *path, long *end) {
    char *line = NULL;
    size_t size = 0;
    unsigned long n_lines = 0;
    bool ours = true;
    *end = 0;
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) { /* a device may never end */
        tool_error(path, 0, "is no plain file, expected what an interrupted sweep left, or nothing");
        return false;
    }
    FILE *stream = fopen(path, "r");
    if (stream == NULL) {
        if (errno != ENOENT) {
            tool_error(path, 0, "cannot be opened: %s", strerror(errno));
        }
        return errno == ENOENT;
    }
    for (ssize_t n; ours && (n = getline(&line, &size, stream)) > 0 && line[n - 1] == '\n'; n_lines++) {
        ours = read_line(t, line);
        *end += n;
    }
    free(line);
    (void)fclose(stream);
    if (!ours) {
        tool_error(path, n_lines,
                   "a measurement of another sweep, expected the words or the scene that it was begun with, "
                   "another -o, or that you remove it");
    }
    return ours;
}

bool trade_resume(trade *t) {
    long end;
    char *path = trade_path(t, "trade.csv.partial");
    bool done = path != NULL && read_partial(t, path, &end);
    if (done) {
        t->partial = fopen(path, "a");
        /* a line that was cut off by the interruption is not to be taken for a whole one later */
        done = t->partial != NULL && ftruncate(fileno(t->partial), end) == 0 &&
               (end > 0 || fputs("source,round," KEY_FIELDS ",build_us,render_us," FIGURE_FIELDS "\n", t->partial) != EOF);
        if (!done) {
            tool_error(path, 0, "cannot be written: %s", strerror(errno));
        }
    }
    free(path);
    return done;
}

bool trade_append(trade *t, const trade_setting *s, uint32_t round) {
    (void)fprintf(t->partial, "%016" PRIx64 ",%" PRIu32 ",%s,%" PRIu64 ",%" PRIu64 ",", s->group->scene->hash, round + 1,
                  s->key, s->build[round], s->render[round]);
    print_figures(t->partial, &s->figures);
    (void)fputc('\n', t->partial);
    if (fflush(t->partial) != 0 || ferror(t->partial)) {
        tool_error(t->directory, 0, "trade.csv.partial cannot be written: %s", strerror(errno));
        return false;
    }
    return true;
}

bool trade_finish(trade *t) {
    char *path = trade_path(t, "trade.csv.partial");
    if (path == NULL) {
        return false;
    }
    (void)fclose(t->partial);
    t->partial = NULL;
    bool done = unlink(path) == 0;
    if (!done) {
        tool_error(path, 0, "cannot be removed: %s", strerror(errno));
    }
    free(path);
    return done;
}

/* --- what follows --- */

static int compare_times(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Sorts the rounds' times: they are written already. */
static trade_time summarise(uint64_t *times, uint32_t n) {
    qsort(times, n, sizeof *times, compare_times);
    return (trade_time){(times[(n - 1) / 2] + times[n / 2]) / 2, times[0], times[n - 1]};
}

static bool is_faster_base(const trade_setting *s, const trade_setting *than) {
    bool mset = s->method == &aset_mset;
    if (s->approx != TRADE_EXACT) {
        return false;
    }
    if (than == NULL || mset != (than->method == &aset_mset)) {
        return than == NULL || mset;
    }
    return trade_total(s) < trade_total(than);
}

static void find_base(trade *t, trade_group *group) {
    const trade_setting *base = NULL;
    for (uint32_t i = 0; i < t->n_settings; i++) {
        const trade_setting *s = &t->settings[i];
        if (s->group == group && is_faster_base(s, base)) {
            base = s;
        }
    }
    group->base = trade_total(base);
}

/* a beats b: as good in time, bytes and error, and better in one of them. */
static bool beats(const trade_setting *a, const trade_setting *b) {
    uint64_t time_a = trade_total(a), time_b = trade_total(b), bytes_a = a->figures.peak, bytes_b = b->figures.peak;
    double error_a = a->figures.rmse, error_b = b->figures.rmse;
    return a->group == b->group && time_a <= time_b && bytes_a <= bytes_b && error_a <= error_b &&
           (time_a < time_b || bytes_a < bytes_b || error_a < error_b);
}

void trade_judge(trade *t) {
    for (uint32_t i = 0; i < t->n_settings; i++) {
        trade_setting *s = &t->settings[i];
        s->build_time = summarise(s->build, t->rounds);
        s->render_time = summarise(s->render, t->rounds);
    }
    for (uint32_t i = 0; i < t->n_groups; i++) {
        find_base(t, &t->groups[i]);
    }
    for (uint32_t i = 0; i < t->n_settings; i++) {
        trade_setting *s = &t->settings[i];
        s->time = (double)trade_total(s) / (double)s->group->base;
        s->best = trade_peak(s) <= t->memory;
        for (uint32_t k = 0; k < t->n_settings && s->best; k++) {
            s->best = !beats(&t->settings[k], s);
        }
    }
}

static void print_time(FILE *stream, const trade_time *time) {
    (void)fprintf(stream, ",%.6f,%.6f,%.6f", 1e-6 * (double)time->median, 1e-6 * (double)time->low,
                  1e-6 * (double)time->high);
}

bool trade_write(const trade *t) {
    tool_output output;
    char *path = trade_path(t, "trade.csv");
    bool done = path != NULL && tool_output_open(&output, path);
    if (done) {
        (void)fputs(KEY_FIELDS
                    ",rounds,build_s,build_min_s,build_max_s,render_s,render_min_s,render_max_s,time," FIGURE_FIELDS
                    ",best\n",
                    output.stream);
        for (uint32_t i = 0; i < t->n_settings; i++) {
            const trade_setting *s = &t->settings[i];
            (void)fprintf(output.stream, "%s,%" PRIu32, s->key, t->rounds);
            print_time(output.stream, &s->build_time);
            print_time(output.stream, &s->render_time);
            (void)fprintf(output.stream, ",%.4f,", s->time);
            print_figures(output.stream, &s->figures);
            (void)fprintf(output.stream, ",%d\n", s->best);
        }
        done = tool_output_close(&output);
    }
    free(path);
    return done;
}
