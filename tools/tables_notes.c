/*
 * tables_notes.c - one line for each ratio that differs from the paper's by more than a quarter, made of counts: it says
 * what a ratio is the product of, and what it becomes when one thing is changed (curtailing, lights, view).
 */
#include "tables.h"

#include <math.h>

bool differs(double measured, double published) {
    return measured > 0.0 && published > 0.0 && fabs(measured / published - 1.0) > 0.25;
}

typedef struct notes {
    FILE *stream;
    const char *prefix;
    uint32_t n; /* lines so far */
} notes;

/* Begins a line: "Snow 30, time 0.80 (0.65): ". */
static void begin(notes *n, const table_row *row, const char *what, double measured, double published) {
    n->n++;
    (void)fprintf(n->stream, "%s%s, %s %.2f (%.2f): ", n->prefix, row->published->label, what, measured, published);
}

static double ratio_of(const double pair[2]) {
    return quotient(pair[BY_ASET], pair[BY_MSET]);
}

static double secondary_ratio(const table_row *row, int drawn) {
    return quotient(row_secondary(row, drawn), row_secondary(row, DRAWN_MSET));
}

static double rays_ratio(const table_row *row, int drawn) {
    return quotient(rays_of(&row->counts[drawn]), rays_of(&row->counts[DRAWN_MSET]));
}

/* --- Table 1 --- */

/*
 * time = share + (1 - share) number each: the primary rays' share of MSET's time; secondary rays, ASET by MSET; time of
 * each, ASET by MSET.
 */
#define N_FACTORS 3
static const char *const factor_names[N_FACTORS] = {"share of primary rays", "number of secondary rays", "time of one"};

static double time_of(const double f[N_FACTORS]) {
    return f[0] + (1.0 - f[0]) * f[1] * f[2];
}

/* Puts the published factor in that brings the time nearest to the published one, and says which. */
static int put_nearest(double own[N_FACTORS], const double theirs[N_FACTORS], double published) {
    int nearest = 0;
    double best = -1.0;
    for (int i = 0; i < N_FACTORS; i++) {
        double f[N_FACTORS] = {own[0], own[1], own[2]};
        f[i] = theirs[i];
        if (best < 0.0 || fabs(time_of(f) - published) < fabs(best - published)) {
            best = time_of(f);
            nearest = i;
        }
    }
    own[nearest] = theirs[nearest];
    return nearest;
}

static void note_time(notes *n, const table_row *row) {
    const published_row *p = row->published;
    double published = ratio_of(p->seconds);
    double own[N_FACTORS] = {row->primary_share, secondary_ratio(row, DRAWN_ASET),
                             quotient(row_secondary_rate(row, BY_MSET), row_secondary_rate(row, BY_ASET))};
    const double theirs[N_FACTORS] = {published_primary_share(p, BY_MSET), ratio_of(p->secondary),
                                      quotient(p->rays_per_second[BY_MSET], p->rays_per_second[BY_ASET])};
    if (!differs(row->time_ratio, published)) {
        return;
    }
    begin(n, row, "time", row->time_ratio, published);
    (void)fprintf(n->stream,
                  "primary rays take %.2f (%.2f) of MSET's time, secondary rays are %.2f (%.2f) as many and take "
                  "%.2f (%.2f) as long each",
                  own[0], theirs[0], own[1], theirs[1], own[2], theirs[2]);
    int first = put_nearest(own, theirs, published);
    (void)fprintf(n->stream, "; with the published %s it would be %.2f", factor_names[first], time_of(own));
    if (differs(time_of(own), published)) {
        int second = put_nearest(own, theirs, published);
        (void)fprintf(n->stream, ", with the %s besides %.2f", factor_names[second], time_of(own));
    }
    (void)fprintf(n->stream, ". Without curtailing it is %.2f.\n", row->off_ratio);
}

/* share = 1 / (1 + number cost): secondary rays for a primary ray; time of one, by that of a primary ray. */
static void note_share(notes *n, const table_row *row) {
    const published_row *p = row->published;
    double published = published_primary_share(p, BY_MSET), own = row->primary_share;
    double number = quotient(row_secondary(row, DRAWN_MSET), row_primary(row));
    double theirs = quotient(p->secondary[BY_MSET], p->primary);
    if (differs(own, published) || differs(quotient(1.0, own), quotient(1.0, published))) {
        begin(n, row, "primary rays' share of the time", own, published);
        (void)fprintf(n->stream,
                      "MSET has %.2f (%.2f) secondary rays for a primary ray, and one takes %.2f (%.2f) times as "
                      "long as that.\n",
                      number, theirs, quotient(1.0 - own, own * number),
                      quotient(1.0 - published, published * theirs));
    }
}

static void note_rays(notes *n, const table_row *row) {
    double published = ratio_of(row->published->rays), own = rays_ratio(row, DRAWN_ASET);
    if (differs(own, published)) {
        begin(n, row, "rays", own, published);
        (void)fprintf(n->stream,
                      "curtailing ends %.0f of %.0f secondary rays, with all that would follow; without it the "
                      "ratio is %.2f.\n",
                      (double)row->counts[DRAWN_ASET].curtailed, row_secondary(row, DRAWN_ASET),
                      rays_ratio(row, DRAWN_OFF));
    }
}

/*
 * ratio = 1 + tests surplus: what MSET's ray takes longer than an approximate one, for each test, by the latter's whole
 * time.
 */
static void note_rate(notes *n, const table_row *row) {
    const published_row *p = row->published;
    double published = ratio_of(p->rays_per_second), tests = row_secondary_tests(row, DRAWN_MSET);
    double own = quotient(row_secondary_rate(row, BY_ASET), row_secondary_rate(row, BY_MSET));
    if (differs(own, published)) {
        begin(n, row, "secondary rays a second", own, published);
        (void)fprintf(n->stream,
                      "a secondary ray of MSET makes %.1f (%.1f) tests and for each of them takes longer than an "
                      "approximate ray, tests and walk together, by %.2f (%.2f) of that one's time; it crosses %.1f "
                      "cells, the approximate ray %.1f.\n",
                      tests, published_secondary_tests(p), quotient(own - 1.0, tests),
                      quotient(published - 1.0, published_secondary_tests(p)), row_secondary_cells(row, DRAWN_MSET),
                      row_secondary_cells(row, DRAWN_ASET));
    }
}

static void note_all_rate(notes *n, const table_row *row) {
    const published_row *p = row->published;
    double published = quotient(ratio_of(p->rays), ratio_of(p->seconds));
    double own = quotient(rays_ratio(row, DRAWN_ASET), row->time_ratio);
    if (differs(own, published)) {
        begin(n, row, "all rays a second", own, published);
        (void)fprintf(n->stream,
                      "rays %.2f (%.2f) by time %.2f (%.2f); without curtailing %.2f by %.2f.\n",
                      rays_ratio(row, DRAWN_ASET), ratio_of(p->rays), row->time_ratio, ratio_of(p->seconds),
                      rays_ratio(row, DRAWN_OFF), row->off_ratio);
    }
}

/* --- Table 2 --- */

static double cells_a_hit(const table_row *row, int drawn) {
    return quotient((double)row->counts[drawn].nonempty_visited, hits_of(&row->counts[drawn]));
}

static double tests_a_hit(const table_row *row, int drawn) {
    return quotient((double)row->counts[drawn].tests, hits_of(&row->counts[drawn]));
}

static double hit_share(const table_row *row, int drawn) {
    return quotient(hits_of(&row->counts[drawn]), rays_of(&row->counts[drawn]));
}

static void note_density(notes *n, const table_row *row) {
    double own = row_density(row);
    if (differs(own, row->published->density)) {
        begin(n, row, "density", own, row->published->density);
        (void)fprintf(n->stream,
                      "%.0f references in %.0f sides.\n",
                      (double)row->structure.references, (double)row->structure.nonempty);
    }
}

static void note_visits(notes *n, const table_row *row) {
    const published_row *p = row->published;
    double cells = cells_a_hit(row, DRAWN_MSET), tests = tests_a_hit(row, DRAWN_MSET);
    if (!differs(cells, p->cells[BY_MSET]) && !differs(tests, p->tests[BY_MSET])) {
        return;
    }
    begin(n, row, "non-empty cells", cells, p->cells[BY_MSET]);
    (void)fprintf(n->stream,
                  "and %.1f (%.0f) tests. With one light %.2f and %.1f",
                  tests, p->tests[BY_MSET], cells_a_hit(row, DRAWN_ONE_LIGHT), tests_a_hit(row, DRAWN_ONE_LIGHT));
    if (!differs(cells_a_hit(row, DRAWN_ONE_LIGHT), p->cells[BY_MSET]) &&
        !differs(tests_a_hit(row, DRAWN_ONE_LIGHT), p->tests[BY_MSET])) {
        (void)fprintf(n->stream,
                      ", near the published: of the rays %.2f hit, with one light %.2f.\n",
                      hit_share(row, DRAWN_MSET), hit_share(row, DRAWN_ONE_LIGHT));
        return;
    }
    (void)fprintf(n->stream,
                  ", with half the view's angle %.2f and %.1f: neither accounts for it, and the paper's objects are"
                  " unknown. Here %.1f %% of the sides are not empty",
                  cells_a_hit(row, DRAWN_NARROW), tests_a_hit(row, DRAWN_NARROW),
                  100.0 * quotient((double)row->structure.nonempty, (double)row->structure.leaves));
    if (published_hit_share(p) > 0.0) {
        (void)fprintf(n->stream,
                      " and %.2f (%.2f) of the rays hit",
                      hit_share(row, DRAWN_MSET), published_hit_share(p));
    }
    (void)fprintf(n->stream, ".\n");
}

/* --- Table 3 --- */

static double hit_ratio(const table_row *row, int drawn) {
    return quotient(hits_of(&row->counts[drawn]), attempts_of(&row->counts[drawn]));
}

static void note_hit_ratio(notes *n, const table_row *row) {
    double own = quotient(hit_ratio(row, DRAWN_ASET), hit_ratio(row, DRAWN_MSET));
    double published = ratio_of(row->published->hit_ratio);
    if (differs(own, published)) {
        double off = quotient(hit_ratio(row, DRAWN_OFF), hit_ratio(row, DRAWN_MSET));
        begin(n, row, "hit ratio", own, published);
        (void)fprintf(n->stream,
                      "hits x %.2f (%.2f) by attempts x %.2f (%.2f); without curtailing it is %.2f.\n",
                      quotient(hits_of(&row->counts[DRAWN_ASET]), hits_of(&row->counts[DRAWN_MSET])),
                      published * ratio_of(row->published->attempts),
                      quotient(attempts_of(&row->counts[DRAWN_ASET]), attempts_of(&row->counts[DRAWN_MSET])),
                      ratio_of(row->published->attempts), off);
    }
}

static void note_attempts(notes *n, const table_row *row) {
    double own = quotient(attempts_of(&row->counts[DRAWN_ASET]), attempts_of(&row->counts[DRAWN_MSET]));
    double published = ratio_of(row->published->attempts);
    if (differs(own, published)) {
        begin(n, row, "attempts", own, published);
        (void)fprintf(n->stream,
                      "what ASET saves are the tests of MSET's secondary rays, %.2f (%.2f) of all: %.1f (%.1f) a "
                      "ray.\n",
                      1.0 - quotient((double)row->counts[DRAWN_PRIMARY].tests, (double)row->counts[DRAWN_MSET].tests),
                      1.0 - published, row_secondary_tests(row, DRAWN_MSET),
                      published_secondary_tests(row->published));
    }
}

static void note_bytes(notes *n, const table_row *row) {
    double own = quotient((double)row->bytes[BY_ASET], (double)row->bytes[BY_MSET]);
    double published = ratio_of(row->published->bytes);
    if (differs(own, published)) {
        begin(n, row, "bytes", own, published);
        (void)fprintf(n->stream, "%u textures for %.0f sides.\n", row->n_textures, (double)row->structure.nonempty);
    }
}

/* Divisions against divisions: row by the one before all others, MSET. */
static void note_scale(notes *n, const table_row *row, const table_row *first) {
    const published_row *p = row->published, *q = first->published;
    const aset_statistics *s = &row->counts[DRAWN_MSET], *f = &first->counts[DRAWN_MSET];
    double attempts = quotient(attempts_of(s), attempts_of(f));
    double bytes = quotient((double)row->bytes[BY_MSET], (double)first->bytes[BY_MSET]);
    double hits = quotient(hit_ratio(row, DRAWN_MSET), hit_ratio(first, DRAWN_MSET));
    if (differs(attempts, p->attempts[BY_MSET] / q->attempts[BY_MSET]) ||
        differs(hits, p->hit_ratio[BY_MSET] / q->hit_ratio[BY_MSET])) {
        begin(n, row, "attempts by those of 100 divisions", attempts, p->attempts[BY_MSET] / q->attempts[BY_MSET]);
        (void)fprintf(n->stream,
                      "a cell holds x %.2f (%.2f) objects, a ray meets x %.2f (%.2f) non-empty cells; the hit ratio"
                      " is the inverse, and ASET's primary rays do the same.\n",
                      row_density(row) / row_density(first), p->density / q->density,
                      quotient((double)s->nonempty_visited, (double)f->nonempty_visited),
                      p->cells[BY_MSET] / q->cells[BY_MSET]);
    }
    if (differs(bytes, p->bytes[BY_MSET] / q->bytes[BY_MSET])) {
        begin(n, row, "bytes by those of 100 divisions", bytes, p->bytes[BY_MSET] / q->bytes[BY_MSET]);
        (void)fprintf(n->stream,
                      "bytes follow the sides that are not empty and the objects, not all sides: sides x %.2f, non-"
                      "empty sides x %.2f, references x %.2f, objects x 1; ASET alike.\n",
                      quotient((double)row->structure.leaves, (double)first->structure.leaves),
                      quotient((double)row->structure.nonempty, (double)first->structure.nonempty),
                      quotient((double)row->structure.references, (double)first->structure.references));
    }
}

/* --- Table 4 --- */

static void note_tree(notes *n, const table_row *row) {
    double own = quotient(row_secondary(row, DRAWN_MSET), row_primary(row));
    double published = quotient(row->published->secondary[BY_MSET], row->published->primary);
    double one_primary = rays_of(&row->counts[DRAWN_ONE_LIGHT_PRIMARY]);
    if (differs(own, published)) {
        const aset_statistics *s = &row->counts[DRAWN_MSET];
        begin(n, row, "secondary rays of MSET for a primary ray", own, published);
        (void)fprintf(n->stream,
                      "%.2f reflected and refracted for an eye ray at %u rays in a chain, %.2f shadow rays for each"
                      " ray that hits; with one light the ratio is %.2f.\n",
                      quotient((double)(s->reflected + s->refracted), (double)s->primary),
                      (unsigned)row->published->depth,
                      quotient((double)s->shadow, (double)(s->primary_hit + s->secondary_hit)),
                      quotient(rays_of(&row->counts[DRAWN_ONE_LIGHT]) - one_primary, one_primary));
    }
}

static void note_secondary(notes *n, const table_row *row) {
    double own = secondary_ratio(row, DRAWN_ASET), published = ratio_of(row->published->secondary);
    if (!differs(own, published)) {
        return;
    }
    double off = secondary_ratio(row, DRAWN_OFF), less = secondary_ratio(row, DRAWN_LESS_025);
    double deeper = quotient(row_secondary(row, DRAWN_DEEPER_OFF), row_secondary(row, DRAWN_DEEPER));
    begin(n, row, "secondary rays", own, published);
    (void)fprintf(n->stream,
                  "curtailing ends %.0f, with all that would follow; without it %.2f",
                  (double)row->counts[DRAWN_ASET].curtailed, off);
    if (differs(off, published) && off < published) {
        (void)fprintf(n->stream, ", and with %u more rays in a chain %.2f", DEEPER, deeper);
    } else if (differs(off, published)) {
        (void)fprintf(n->stream, ", below 0.25 of the diagonal %.2f: the published lies between", less);
    }
    (void)fprintf(n->stream, ".\n");
}

uint32_t notes_print(FILE *stream, int table, const table_row *rows, const char *prefix) {
    static void (*const tables[4][5])(notes *, const table_row *) = {
        {note_time, note_share, note_rays, note_rate, note_all_rate},
        {note_density, note_visits, NULL, NULL, NULL},
        {note_hit_ratio, note_attempts, note_bytes, NULL, NULL},
        {note_tree, note_secondary, NULL, NULL, NULL},
    };
    notes n = {stream, prefix, 0};
    for (int k = 0; k < 5; k++) {
        for (size_t i = 0; i < PUBLISHED_ROWS && tables[table - 1][k] != NULL; i++) {
            tables[table - 1][k](&n, &rows[i]);
        }
    }
    for (size_t i = 1; i < PUBLISHED_SNOW_ROWS && table == 3; i++) {
        note_scale(&n, &rows[i], &rows[0]);
    }
    return n.n;
}
