/*
 * progress.c - a bar on the terminal while a long work goes on.
 *
 * Invariant: drawn_bytes is the number of columns that the bar covers on the terminal's current line; 0 when the line
 * is clean. There is one terminal and one line, so the state is one static struct.
 */
#include "tool.h"

#include <inttypes.h>
#include <time.h>
#include <unistd.h>

/* Seconds between two drawings. */
#define REDRAW_S 0.1
/* Before this much time has passed the time left is a guess from too little and is not shown. */
#define GUESS_S 0.5
#define BAR_COLUMNS 30
#define LINE_COLUMNS 79

static struct {
    const char *unit;
    uint64_t total;
    double started_s, drawn_s;
    int drawn_bytes;
    bool on;
} bar;

double tool_seconds(void) {
    struct timespec now;
    if (clock_gettime(CLOCK_MONOTONIC, &now) != 0) {
        return 0.0;
    }
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The time left, "" while it is not known; hours are enough: no work here goes on for days. */
static void format_left(char *text, size_t size, double elapsed_s, double share) {
    text[0] = '\0';
    if (elapsed_s < GUESS_S || share <= 0.0) {
        return;
    }
    double left_s = elapsed_s * (1.0 - share) / share;
    if (left_s < 360000.0) {
        unsigned seconds = (unsigned)(left_s + 0.5);
        (void)snprintf(text, size, "  %u:%02u:%02u left", seconds / 3600u, seconds / 60u % 60u, seconds % 60u);
    }
}

static void draw(uint64_t done, double now_s) {
    double share = bar.total > 0 ? (double)done / (double)bar.total : 1.0;
    char cells[BAR_COLUMNS + 1], left[32], line[LINE_COLUMNS + 1];
    int full = (int)(share * BAR_COLUMNS);
    for (int i = 0; i < BAR_COLUMNS; i++) {
        cells[i] = i < full ? '#' : '.';
    }
    cells[BAR_COLUMNS] = '\0';
    format_left(left, sizeof left, now_s - bar.started_s, share);
    int length = snprintf(line, sizeof line, "[%s] %3.0f %%  %s %" PRIu64 "/%" PRIu64 "%s", cells, 100.0 * share,
                          bar.unit, done, bar.total, left);
    if (length > LINE_COLUMNS) {
        length = LINE_COLUMNS;
    }
    /* spaces over what a longer line left behind; no escape sequences, so any terminal will do */
    int spaces = bar.drawn_bytes > length ? bar.drawn_bytes - length : 0;
    (void)fprintf(stderr, "\r%s%*s", line, spaces, "");
    (void)fflush(stderr);
    bar.drawn_bytes = length;
    bar.drawn_s = now_s;
}

void tool_progress_start(const char *unit, uint64_t total, bool quiet) {
    tool_progress_end();
    bar.unit = unit;
    bar.total = total;
    bar.started_s = bar.drawn_s = tool_seconds();
    bar.on = !quiet && isatty(STDERR_FILENO) == 1;
}

void tool_progress_step(uint64_t done) {
    if (!bar.on) {
        return;
    }
    double now_s = tool_seconds();
    if (now_s - bar.drawn_s >= REDRAW_S) {
        draw(done < bar.total ? done : bar.total, now_s);
    }
}

void tool_progress_hide(void) {
    if (bar.drawn_bytes > 0) {
        (void)fprintf(stderr, "\r%*s\r", bar.drawn_bytes, "");
        (void)fflush(stderr);
        bar.drawn_bytes = 0;
    }
}

void tool_progress_end(void) {
    tool_progress_hide();
    bar.on = false;
}
