/*
 * tables.h - the rows of `aset tables`: what is measured for each (tables_measure.c), and why it differs from the paper
 * (tables_notes.c).
 */
#ifndef ASET_TOOLS_TABLES_H
#define ASET_TOOLS_TABLES_H

#include "aset/aset.h"

#include "published.h"

#include <stdio.h>

/* The pictures drawn of each row. The first four are timed. */
enum {
    DRAWN_PRIMARY, /* MSET, eye rays and their shadow rays alone: what ASET with L = 1 leaves exact */
    DRAWN_MSET,
    DRAWN_ASET,     /* all rays but those approximate; trapped: less than half a diagonal */
    DRAWN_OFF,      /* ASET without curtailing; from here on only curtailing differs */
    DRAWN_LESS_025,
    DRAWN_LESS_1,
    DRAWN_MORE_05,
    DRAWN_ONE_LIGHT, /* MSET with the scene's first light alone */
    DRAWN_ONE_LIGHT_PRIMARY, /* and its primary rays alone */
    DRAWN_NARROW,     /* MSET with half the view's angle */
    DRAWN_DEEPER,     /* MSET with two more rays in a chain */
    DRAWN_DEEPER_OFF, /* and ASET without curtailing */
    N_DRAWN
};
#define N_TIMED 4
#define DEEPER 2u
#define ROUNDS_MAX 99u

typedef struct table_row {
    const published_row *published;
    aset_structure structure;
    uint32_t n_textures, n_merged;
    size_t bytes[2];                /* the arena's peak: BY_MSET, BY_ASET */
    aset_statistics counts[N_DRAWN];
    uint32_t rounds;                /* 0: not timed */
    double time_ratio, time_low, time_high; /* build and picture, ASET by MSET: median, smallest and largest round */
    double off_ratio;               /* the same without curtailing: median */
    double mset_s, build_s[2];      /* medians: MSET's picture; building by MSET and ASET */
    double primary_share;           /* primary rays' time by MSET's, the pictures alone: median */
    double secondary_s[2];          /* secondary rays' time: median of the pictures' differences to that of primary rays */
} table_row;

/* Pictures that row_measure draws, for the progress bar. */
#define ROW_PICTURES(rounds) (N_DRAWN + (rounds) * N_TIMED)

/*
 * Draws everything of a row, side x side pixels, each method in an arena of exactly its need; *done counts the pictures.
 * False after an error line.
 */
bool row_measure(table_row *row, const published_row *published, uint32_t side, uint32_t rounds, uint64_t *done);

/* --- what follows from the counts; 0 where something is missing --- */

double quotient(double above, double below);
double rays_of(const aset_statistics *s);
double hits_of(const aset_statistics *s); /* rays that met something, the curtailed included: they met a cell */
double attempts_of(const aset_statistics *s); /* tests of objects, and cells met by approximate rays */
double row_density(const table_row *row); /* objects in a side that is not empty */
double row_primary(const table_row *row);
double row_secondary(const table_row *row, int drawn);
/* Secondary rays' tests or cells visited, by their number. */
double row_secondary_tests(const table_row *row, int drawn);
double row_secondary_cells(const table_row *row, int drawn);
/* Secondary rays of a second, BY_MSET or BY_ASET. */
double row_secondary_rate(const table_row *row, int by);

/* --- tables_notes.c --- */

/* Is measured off by more than a quarter? Not if either is missing (0). */
bool differs(double measured, double published);

/*
 * A line for each ratio of a table (1 to 4) that differs, each begun with prefix: what it comes from, by the counts. How
 * many.
 */
uint32_t notes_print(FILE *stream, int table, const table_row *rows, const char *prefix);

#endif
