/*
 * tables.c - the command `aset tables`: Tables 1 to 4 of Dauenhauer and Semwal, "Approximate Ray Tracing" (1990), measured
 * beside published.
 *
 * Snow's objects and all pictures' sizes are unknown, so ratios are compared, not counts. Everything is measured before
 * the first line is written; counts do not change from run to run, times are left out with --rounds 0.
 */
#include "board.h"
#include "tables.h"
#include "tool.h"

#include <errno.h>

#define SIDE_DEFAULT 256u
#define SIDE_MAX 4096u
#define ROUNDS_DEFAULT 5u

static const char help[] =
    "aset tables: Tables 1 to 4 of Dauenhauer and Semwal (Graphics Interface 1990), measured here, published in brackets.\n"
    "\n"
    "MSET is exact; ASET is mset with --approx all --approx-depth 1, curtailed below half a voxel's diagonal. A * marks\n"
    "a ratio that differs from the published one by more than a quarter; a line below the table says why. Takes about a\n"
    "minute.\n"
    "\n"
    "  -s, --size N         pictures of N x N pixels; default 256\n"
    "      --rounds N       timed rounds, in each of which every picture is drawn once in turn; 0: counts alone; default 5\n"
    "      --markdown       tables in Markdown, as in docs/tables.md\n"
    "  -o, --output FILE    default standard output\n"
    "  -q, --quiet          no progress bar\n"
    "  -h, --help           this text\n";

/* --- the tables --- */

typedef struct page {
    FILE *stream;
    bool markdown;
    const table_row *rows;
    uint32_t side, rounds;
} page;

static void title(const page *p, const char *text) {
    (void)fprintf(p->stream, p->markdown ? "## %s\n\n" : "%s\n\n", text);
}

static void finish(const page *p, const board *b) {
    board_print(p->stream, b, p->markdown);
}

static void notes(const page *p, int table) {
    if (notes_print(p->stream, table, p->rows, p->markdown ? "- " : "* ") > 0) {
        (void)fputc('\n', p->stream);
    }
}

/* A ratio, with its star. */
static void pair(board *b, double measured, double published, int digits) {
    board_pair(b, measured, published, digits, differs(measured, published));
}

/* Begins the line of a row. */
static const published_row *begin_row(board *b, const table_row *row) {
    board_next(b);
    board_add(b, "%s", row->published->label);
    return row->published;
}

/* What the published numbers say about how they were counted. */
static void print_readings(const page *p) {
    board b;
    title(p, "How the paper counted");
    (void)fprintf(p->stream,
                  "Rays a second are secondary rays by the time that they took. If so, what is left of the time is the\n"
                  "primary rays', which MSET and ASET trace alike; and it comes out alike. All rays by the whole time\n"
                  "give other numbers.\n\n");
    board_head(&b, "published|left, MSET s|left, ASET s|ASET by MSET|printed rays a second|all rays by all time");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const published_row *q = &published_rows[i];
        double left[2];
        board_next(&b);
        board_add(&b, "%s", q->label);
        for (int by = BY_MSET; by <= BY_ASET; by++) {
            left[by] = published_primary_share(q, by) * q->seconds[by];
            board_add(&b, "%.0f", left[by]);
        }
        board_add(&b, "%.2f", left[BY_ASET] / left[BY_MSET]);
        board_add(&b, "%.0f, %.0f", q->rays_per_second[BY_MSET], q->rays_per_second[BY_ASET]);
        board_add(&b, "%.0f, %.0f", q->rays[BY_MSET] / q->seconds[BY_MSET], q->rays[BY_ASET] / q->seconds[BY_ASET]);
    }
    finish(p, &b);
    (void)fprintf(p->stream,
                  "Primary rays are eye rays and their shadow rays. Table 4 has as many for MSET as for ASET, and\n"
                  "shadow rays of approximate hits would differ; and eye rays alone fill a rectangle, but 244,291 is a\n"
                  "prime number, 511,547 is 17 x 30,091 and 260,088 is 24 x 10,837. (The paper's footnote 4 says eye\n"
                  "rays alone.)\n\n"
                  "Table 2 counts for each ray that hits: attempts of Table 3 by tests of Table 2 are 305,793, 302,619\n"
                  "and 318,653 rays for Snow 100, 50 and 30, of 667,239; attempts by the hit ratio are 308,239, 367,984\n"
                  "and 309,731 hits (the ratios have one digit or two). A published secondary ray's tests are, for\n"
                  "Snow, the difference of MSET's and ASET's attempts by MSET's secondary rays; elsewhere they follow\n"
                  "from its rate and the paper's costs, 0.0088 s for a ray and 0.00032 s for a test.\n\n"
                  "Heights of the ray trees are not printed. A row takes that at which MSET's secondary rays for a\n"
                  "primary ray come nearest to the published; the last, Gears of no divisions, is Gears 15 with the\n"
                  "same primary rays and a tree of %u, where the count has stopped growing.\n\n",
                  (unsigned)published_rows[PUBLISHED_ROWS - 1u].depth);
}

static void print_table_1(const page *p) {
    board b;
    title(p, "Table 1: time, rays, rays a second (ASET by MSET)");
    board_head(&b, "scene|time|of the rounds|rays|all rays a second|secondary rays a second|time, not curtailed");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        double rays = quotient(rays_of(&r->counts[DRAWN_ASET]), rays_of(&r->counts[DRAWN_MSET]));
        double time = q->seconds[BY_ASET] / q->seconds[BY_MSET], published = q->rays[BY_ASET] / q->rays[BY_MSET];
        pair(&b, r->time_ratio, time, 2);
        if (r->rounds > 0) {
            board_add(&b, "%.2f to %.2f", r->time_low, r->time_high);
        } else {
            board_add(&b, "-");
        }
        pair(&b, rays, published, 2);
        pair(&b, quotient(rays, r->time_ratio), published / time, 2);
        pair(&b, quotient(row_secondary_rate(r, BY_ASET), row_secondary_rate(r, BY_MSET)),
                 q->rays_per_second[BY_ASET] / q->rays_per_second[BY_MSET], 2);
        pair(&b, r->off_ratio, 0.0, 2);
    }
    finish(p, &b);
    board_head(&b, "scene|rays in a chain|primary rays' share of MSET's time|most that can be won|won|MSET, picture "
                   "s|build s|ASET, build s");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        double share = published_primary_share(q, BY_MSET);
        board_add(&b, "%u", (unsigned)q->depth);
        pair(&b, r->primary_share, share, 2);
        pair(&b, quotient(1.0, r->primary_share), 1.0 / share, 2);
        double won = q->seconds[BY_MSET] / q->seconds[BY_ASET];
        if (r->rounds > 0) {
            board_shown(&b, quotient(1.0, r->time_ratio), won, 2);
        } else {
            board_pair(&b, 0.0, won, 2, false);
        }
        pair(&b, r->mset_s, 0.0, 3);
        pair(&b, r->build_s[BY_MSET], 0.0, 4);
        pair(&b, r->build_s[BY_ASET], 0.0, 4);
    }
    finish(p, &b);
    notes(p, 1);
}

/* What the rays of ASET do that are not primary: non-empty cells for each that met one. */
static double approximate_cells(const table_row *r) {
    const aset_statistics *a = &r->counts[DRAWN_ASET], *m = &r->counts[DRAWN_PRIMARY];
    return quotient((double)a->nonempty_visited - (double)m->nonempty_visited, (double)(a->approx_hits + a->curtailed));
}

static void print_table_2(const page *p) {
    board b;
    title(p, "Table 2: density, non-empty cells and tests for a ray that hits");
    board_head(&b, "scene|objects in a cell|cells, MSET|tests, MSET|cells, ASET|tests, ASET|rays that hit|cells, any "
                   "ray|tests, any ray");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        const aset_statistics *s = &r->counts[DRAWN_MSET];
        pair(&b, row_density(r), q->density, 2);
        pair(&b, quotient((double)s->nonempty_visited, hits_of(s)), q->cells[BY_MSET], 1);
        pair(&b, quotient((double)s->tests, hits_of(s)), q->tests[BY_MSET], 1);
        pair(&b, approximate_cells(r), q->cells[BY_ASET], 2);
        board_shown(&b, row_secondary_tests(r, DRAWN_ASET), q->tests[BY_ASET], 0);
        board_shown(&b, quotient(hits_of(s), rays_of(s)), published_hit_share(q), 2);
        pair(&b, quotient((double)s->nonempty_visited, rays_of(s)), 0.0, 1);
        pair(&b, quotient((double)s->tests, rays_of(s)), 0.0, 1);
    }
    finish(p, &b);
    notes(p, 2);
}

static double hit_ratio(const aset_statistics *s) {
    return quotient(hits_of(s), attempts_of(s));
}

static void print_scales(const page *p) {
    board b;
    const table_row *f = &p->rows[0];
    const published_row *pf = f->published;
    board_head(&b, "scene, by Snow 100|sides|non-empty sides|hit ratio, MSET|attempts, MSET|bytes, MSET|hit ratio, "
                   "ASET|attempts, ASET|bytes, ASET");
    for (size_t i = 1; i < PUBLISHED_SNOW_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        pair(&b, (double)r->structure.leaves / (double)f->structure.leaves, 0.0, 3);
        pair(&b, (double)r->structure.nonempty / (double)f->structure.nonempty, 0.0, 3);
        for (int by = BY_MSET; by <= BY_ASET; by++) {
            int drawn = by == BY_MSET ? DRAWN_MSET : DRAWN_ASET;
            pair(&b, quotient(hit_ratio(&r->counts[drawn]), hit_ratio(&f->counts[drawn])),
                 q->hit_ratio[by] / pf->hit_ratio[by], 2);
            pair(&b, quotient(attempts_of(&r->counts[drawn]), attempts_of(&f->counts[drawn])),
                     q->attempts[by] / pf->attempts[by], 2);
            pair(&b, (double)r->bytes[by] / (double)f->bytes[by], q->bytes[by] / pf->bytes[by], 2);
        }
    }
    finish(p, &b);
}

static void print_table_3(const page *p) {
    board b;
    title(p, "Table 3: hits, attempts, bytes");
    board_head(&b, "scene|hit %, MSET|hit %, ASET|ASET by MSET|attempts, ASET by MSET|bytes, MSET|bytes, ASET|ASET by "
                   "MSET|of published");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        const aset_statistics *m = &r->counts[DRAWN_MSET], *a = &r->counts[DRAWN_ASET];
        board_shown(&b, 100.0 * hit_ratio(m), 100.0 * q->hit_ratio[BY_MSET], 1);
        board_shown(&b, 100.0 * hit_ratio(a), 100.0 * q->hit_ratio[BY_ASET], 1);
        pair(&b, quotient(hit_ratio(a), hit_ratio(m)), quotient(q->hit_ratio[BY_ASET], q->hit_ratio[BY_MSET]), 2);
        pair(&b, quotient(attempts_of(a), attempts_of(m)), quotient(q->attempts[BY_ASET], q->attempts[BY_MSET]), 2);
        board_shown(&b, (double)r->bytes[BY_MSET], q->bytes[BY_MSET], 0);
        board_shown(&b, (double)r->bytes[BY_ASET], q->bytes[BY_ASET], 0);
        pair(&b, quotient((double)r->bytes[BY_ASET], (double)r->bytes[BY_MSET]),
                 quotient(q->bytes[BY_ASET], q->bytes[BY_MSET]), 2);
        pair(&b, quotient((double)r->bytes[BY_ASET], q->bytes[BY_ASET]), 0.0, 3);
    }
    finish(p, &b);
    print_scales(p);
    notes(p, 3);
}

static void print_table_4(const page *p) {
    static const int order[] = {DRAWN_OFF, DRAWN_LESS_025, DRAWN_ASET, DRAWN_LESS_1, DRAWN_MORE_05};
    board b;
    title(p, "Table 4: primary and secondary rays");
    board_head(&b, "scene|eye rays|primary|secondary, MSET|secondary, ASET|MSET, for a primary ray|ASET by MSET");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        board_add(&b, "%.0f", (double)r->counts[DRAWN_PRIMARY].primary);
        board_shown(&b, row_primary(r), q->primary, 0);
        board_shown(&b, row_secondary(r, DRAWN_MSET), q->secondary[BY_MSET], 0);
        board_shown(&b, row_secondary(r, DRAWN_ASET), q->secondary[BY_ASET], 0);
        pair(&b, quotient(row_secondary(r, DRAWN_MSET), row_primary(r)), q->secondary[BY_MSET] / q->primary, 2);
        pair(&b, quotient(row_secondary(r, DRAWN_ASET), row_secondary(r, DRAWN_MSET)),
                 q->secondary[BY_ASET] / q->secondary[BY_MSET], 2);
    }
    finish(p, &b);
    board_head(&b, "secondary rays, ASET by MSET|published|off|less 0.25|less 0.5|less 1|more 0.5|curtailed, less 0.5");
    for (size_t i = 0; i < PUBLISHED_ROWS; i++) {
        const table_row *r = &p->rows[i];
        const published_row *q = begin_row(&b, r);
        double published = q->secondary[BY_ASET] / q->secondary[BY_MSET];
        board_add(&b, "%.2f", published);
        for (size_t k = 0; k < sizeof order / sizeof order[0]; k++) {
            double own = quotient(row_secondary(r, order[k]), row_secondary(r, DRAWN_MSET));
            board_add(&b, "%.2f%s", own, differs(own, published) ? "*" : "");
        }
        board_add(&b, "%.0f", (double)r->counts[DRAWN_ASET].curtailed);
    }
    finish(p, &b);
    notes(p, 4);
}

static void print_page(const page *p) {
    if (p->markdown) {
        (void)fprintf(p->stream, "# The paper's tables, measured\n\n"
                                 "Made by `aset tables --markdown -o docs/tables.md`.\n\n");
    }
    (void)fprintf(p->stream,
                  "Measured, the published figure in brackets; * where a ratio differs by more than a quarter, and a\n"
                  "line below says why. %u x %u pixels, one thread; ",
                  (unsigned)p->side, (unsigned)p->side);
    if (p->rounds > 0) {
        (void)fprintf(p->stream,
                      "times are of the processor, medians of %u rounds in\n"
                      "which every picture is drawn in turn; a time is that of building and drawing, rays a second and\n"
                      "shares are of drawing alone.\n\n",
                      (unsigned)p->rounds);
    } else {
        (void)fprintf(p->stream, "no times were taken.\n\n");
    }
    print_readings(p);
    print_table_1(p);
    print_table_2(p);
    print_table_3(p);
    print_table_4(p);
}

/* --- the command --- */

typedef struct request {
    uint32_t side, rounds;
    const char *output;
    bool markdown, quiet, wants_help;
} request;

static bool parse(request *r, int argc, char **argv) {
    static const struct option longs[] = {
        {"size", required_argument, NULL, 's'},  {"rounds", required_argument, NULL, 'r'},
        {"markdown", no_argument, NULL, 'm'},    {"output", required_argument, NULL, 'o'},
        {"quiet", no_argument, NULL, 'q'},       {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    int option;
    while ((option = tool_option_next(argc, argv, "s:o:qh", longs)) != -1) {
        bool fine = option != '?';
        switch (option) {
        case 's': fine = tool_parse_count("--size", optarg, 1, SIDE_MAX, &r->side); break;
        case 'r': fine = tool_parse_count("--rounds", optarg, 0, ROUNDS_MAX, &r->rounds); break;
        case 'm': r->markdown = true; break;
        case 'o': fine = tool_parse_output(optarg, &r->output); break;
        case 'q': r->quiet = true; break;
        case 'h': r->wants_help = true; return true;
        default: break;
        }
        if (!fine) {
            return false;
        }
    }
    if (optind < argc) {
        tool_error(NULL, 0, "tables: \"%s\" is one word too many, expected options alone; aset tables --help tells "
                            "more", argv[optind]);
        return false;
    }
    return true;
}

static bool measure(table_row *rows, const request *r) {
    uint64_t done = 0;
    bool fine = true;
    tool_progress_start("pictures", (uint64_t)PUBLISHED_ROWS * ROW_PICTURES(r->rounds), r->quiet);
    for (size_t i = 0; i < PUBLISHED_ROWS && fine; i++) {
        fine = row_measure(&rows[i], &published_rows[i], r->side, r->rounds, &done);
    }
    tool_progress_end();
    return fine;
}

int command_tables(int argc, char **argv) {
    table_row rows[PUBLISHED_ROWS];
    request r = {SIDE_DEFAULT, ROUNDS_DEFAULT, NULL, false, false, false};
    tool_output output;
    if (!parse(&r, argc, argv)) {
        return TOOL_USAGE;
    }
    if (r.wants_help) {
        return tool_help(help);
    }
    if (!tool_output_open(&output, r.output != NULL ? r.output : "-")) {
        return TOOL_FAILED;
    }
    if (!measure(rows, &r)) {
        tool_output_abort(&output);
        return TOOL_FAILED;
    }
    const page p = {output.stream, r.markdown, rows, r.side, r.rounds};
    print_page(&p);
    if (ferror(output.stream) != 0) {
        tool_output_fail(&output, errno);
    }
    return tool_output_close(&output) ? TOOL_DONE : TOOL_FAILED;
}
