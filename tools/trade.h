/*
 * trade.h - the sweep of `aset trade`: its settings and what was measured of each, shared by the files of the command.
 *
 *   trade.c        words and the order of work
 *   trade_plan.c   scenes, and the settings to be measured
 *   trade_run.c    one measurement of one setting
 *   trade_table.c  the CSV files, resuming, medians, which settings are best
 *   trade_plot.c   plots through gnuplot
 *   trade_page.c   the page
 */
#ifndef ASET_TRADE_H
#define ASET_TRADE_H

#include "prepare.h"

/* Which rays may be approximate; kinds and level are the words that render takes. */
typedef struct trade_approx {
    const char *kinds, *text;
    uint32_t mask, level;
} trade_approx;

/* Exact, the four that are tried of themselves, and what --approx and --approx-depth say if it is none of them. */
enum { TRADE_EXACT = 0, TRADE_GIVEN = 5, TRADE_APPROXES = 6 };
/* The words of the command line; a list of length 0, methods 0: not given. */
#define TRADE_LIST_MAX 16u
typedef struct trade_words {
    const char *directory;
    unsigned methods; /* bits, by place in tool_methods */
    unsigned cells;   /* bits, by settings_cells */
    uint32_t grids[TRADE_LIST_MAX][3], depths[TRADE_LIST_MAX], sizes[TRADE_LIST_MAX][2];
    uint32_t n_grids, n_depths, n_sizes, rounds;
    settings settings; /* the camera, what models get, how rays are followed, and the memory if has_memory */
    bool has_memory, quick, quiet, wants_help, is_aset;
} trade_words;

/* What every repetition of a setting gives alike. */
typedef struct trade_figures {
    uint64_t rays, tests, cells, peak;
    double psnr, rmse, ssim, differing;
    unsigned max_difference;
} trade_figures;

/* Microseconds, so that what was written and read back is the same. */
typedef struct trade_time {
    uint64_t median, low, high;
} trade_time;

typedef struct trade_scene {
    const char *name; /* as given: a file, NAME or NAME:SIZE */
    char *label;      /* for names of files: letters, digits, '-' and '_' */
    uint64_t hash;    /* of the scene's text and of what draws it: measurements of another are not taken over */
    tool_source source;
    measured loaded;
} trade_scene;

/* The settings that are compared with each other: one scene in one size. */
typedef struct trade_group {
    trade_scene *scene;
    uint32_t width, height;
    uint32_t columns, rows; /* of its pictures: one more each by the SPD's rules */
    aset_view view; /* a model's depends on the picture's shape */
    uint8_t *exact; /* the exact picture's pixels; NULL until one is needed */
    uint64_t base;  /* microseconds of the fastest exact MSET (without one: of the fastest exact setting) */
} trade_group;

typedef struct trade_setting {
    trade_group *group;
    const aset_method *method;
    uint32_t grid[3], tree_depth; /* 0: the method has none */
    unsigned approx;              /* TRADE_EXACT or another of trade's approxes, */
    const trade_approx *rays;     /* which is this */
    settings_cells cells;         /* other than flat: a draft */
    double curtail;               /* 0 for a draft too, to which it does not apply */
    size_t need;                  /* bytes of the arena besides the scene's */
    char *key;                    /* the first fields of its CSV row */
    uint64_t *build, *render;     /* microseconds of each round; 0: not measured yet */
    bool has_figures;
    trade_figures figures;
    trade_time build_time, render_time;
    double time; /* build and render, as a multiple of the group's base */
    bool best;
} trade_setting;

typedef struct trade {
    const char *directory;
    trade_scene *scenes;
    trade_group *groups;
    trade_setting *settings;
    uint32_t n_scenes, n_groups, n_settings, n_left_out, rounds;
    uint64_t memory; /* a setting that needs more is left out, unless it is exact */
    trade_approx approxes[TRADE_APPROXES];
    char given_kinds[SETTINGS_KINDS_BYTES], given_text[80];
    unsigned wanted; /* bits, by place in approxes; TRADE_EXACT always */
    double curtails[2];
    uint32_t n_curtails;
    settings drawn;  /* depth, samples, leaf, which side is curtailed, rules */
    uint8_t *block; /* for the arenas of all settings, one after the other */
    FILE *partial;  /* open for appending */
    bool quiet;
} trade;

/* All functions that can fail print their error line and give false or NULL. */

/* --- trade_plan.c --- */

/* t is all zeros before. After a failure too it is to be freed. */
bool trade_plan(trade *t, const trade_words *w, char **names, uint32_t n_names);
void trade_free(trade *t);

/* --- trade_run.c --- */

/* Whether no scene is held: the source goes straight into the baker, or into flat cells. */
bool trade_is_streamed(const trade_setting *s);
/* Bytes of the arena with which render draws it so. */
uint64_t trade_peak(const trade_setting *s);
/* Finds a draft's need by baking it. need holds what is needed without the draft before, and all of it afterwards. */
bool trade_find_need(const trade *t, trade_setting *s);

/* Draws a setting once into pixels (R, G, B, no gaps); times in microseconds, figures without the error. */
bool trade_draw(const trade *t, const trade_setting *s, uint8_t *pixels, trade_figures *figures, uint64_t *build_us,
                uint64_t *render_us);
/* Measures a setting in one round. The first time its error is found too, against the group's exact picture. */
bool trade_measure(trade *t, trade_setting *s, uint32_t round);

/* --- trade_table.c --- */

uint64_t trade_total(const trade_setting *s); /* microseconds of build and render, medians */
/* DIRECTORY/ and the rest, to be freed. */
char *trade_path(const trade *t, const char *format, ...) TOOL_PRINTF(2, 3);
bool trade_keys(trade *t);
/* Takes over what an interrupted sweep left in DIRECTORY/trade.csv.partial and opens it for more. */
bool trade_resume(trade *t);
bool trade_append(trade *t, const trade_setting *s, uint32_t round);
/* Medians, relative times and best marks, once everything is measured. */
void trade_judge(trade *t);
bool trade_write(const trade *t);
/* Ends the partial file, which is not needed any more. */
bool trade_finish(trade *t);

/* --- trade_plot.c --- */

enum { TRADE_TIME, TRADE_BYTES, TRADE_PLOTS };
/*
 * A group's plot of the error against time or bytes as SVG, to be freed. *absent is set, without an error line, where
 * there is no gnuplot.
 */
char *trade_plot(const trade *t, const trade_group *group, int against, bool *absent);

/* --- trade_page.c --- */

/* The page and the pictures in it. plots: TRADE_PLOTS for each group, NULL where there is none. */
bool trade_page(trade *t, char *const *plots);

#endif
