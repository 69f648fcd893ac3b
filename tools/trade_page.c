/*
 * trade_page.c - the sweep as one HTML file that needs nothing else: pictures as base64, plots as SVG within, tables.
 *
 * Pictures are drawn once more, which is the same picture, and lie beside the page as files too.
 */
#include "trade.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>The trade, measured</title>\n<style>\n"
    "body { font: 15px/1.45 sans-serif; max-width: 1340px; margin: 2em auto; padding: 0 1em; color: #111; background: #fff "
    "}\n"
    "svg, img { max-width: 100%; height: auto }\n"
    "svg { display: block; margin: 1em 0 }\n"
    ".pictures { display: flex; flex-wrap: wrap; gap: 14px }\n"
    "figure { margin: 0; width: 256px }\n"
    "figcaption { font-size: 13px }\n"
    ".scroll { overflow-x: auto }\n"
    "table { border-collapse: collapse; font-size: 13px; white-space: nowrap; font-variant-numeric: tabular-nums }\n"
    "th { background: #eee; text-align: left; vertical-align: bottom }\n"
    "th, td { padding: 2px 8px; border-bottom: 1px solid #ddd }\n"
    ".n { text-align: right }\n"
    "tr.best td { background: #fff3c4; font-weight: bold }\n"
    "</style>\n</head>\n<body>\n<h1>The trade, measured</h1>\n";

static const char reading[] =
    "<p>Each row is one setting: a way to divide the space, how finely, and which rays may take what a cell "
    "remembers instead of testing objects: its average texture (<b>flat</b> cells), or a facet of a draft, on the cell's "
    "side (<b>normal</b>) or where the surface lies (<b>plane</b>). A draft with all rays approximate keeps no scene and no "
    "space, and stands under mset for grid too. <b>time</b> is building and drawing together, as a multiple of the fastest "
    "exact mset picture of the same scene and size (without one: of the fastest exact picture); seconds are medians, with "
    "the smallest and the "
    "largest of all rounds behind them, and without the reading of the scene. <b>bytes</b> are the peak of the arena: "
    "scene, structure, textures and the stack of rays, without the picture; of a draft, little more than the least that "
    "will do. "
    "<b>PSNR</b> is the error against the exact picture: higher is closer, about 20 dB is a draft that one recognises, 40 "
    "dB hard to tell apart, and 99 dB means equal.</p>\n"
    "<p>A setting marked <b>best</b> is one that no other beats, that is, no other is as good in time, bytes and error "
    "and better in at least one of them. Choose among the best: the fastest that is close enough and fits into your memory. "
    "Where the spread of two rows' seconds overlaps, their order in time is chance, and so may be a mark.</p>\n";

static void print_escaped(FILE *f, const char *text) {
    for (; *text != 0; text++) {
        switch (*text) {
        case '&': (void)fputs("&amp;", f); break;
        case '<': (void)fputs("&lt;", f); break;
        case '>': (void)fputs("&gt;", f); break;
        case '"': (void)fputs("&quot;", f); break;
        default: (void)fputc(*text, f);
        }
    }
}

/* --- pictures --- */

static bool write_picture(const char *path, const trade_group *group, const uint8_t *pixels) {
    tool_picture *picture = tool_picture_open(path, group->columns, group->rows, 3);
    if (picture == NULL) {
        return false;
    }
    for (uint32_t y = 0; y < group->rows; y++) {
        if (!tool_picture_row(picture, pixels + (size_t)y * group->columns * 3)) {
            tool_picture_abort(picture);
            return false;
        }
    }
    return tool_picture_close(picture);
}

static bool print_base64(FILE *f, const char *path) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char b[3];
    size_t n;
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        tool_error(path, 0, "cannot be opened: %s", strerror(errno));
        return false;
    }
    while (memset(b, 0, sizeof b), (n = fread(b, 1, sizeof b, stream)) > 0) {
        (void)fputc(digits[b[0] >> 2], f);
        (void)fputc(digits[(b[0] & 3u) << 4 | b[1] >> 4], f);
        (void)fputc(n > 1 ? digits[(b[1] & 15u) << 2 | b[2] >> 6] : '=', f);
        (void)fputc(n > 2 ? digits[b[2] & 63u] : '=', f);
    }
    (void)fclose(stream);
    return true;
}

static void print_grid(FILE *f, const trade_setting *s) {
    if (s->tree_depth > 0) {
        (void)fprintf(f, "depth %" PRIu32, s->tree_depth);
    } else if (s->grid[0] > 0 && s->grid[0] == s->grid[1] && s->grid[0] == s->grid[2]) {
        (void)fprintf(f, "%" PRIu32, s->grid[0]);
    } else if (s->grid[0] > 0) {
        (void)fprintf(f, "%" PRIu32 "x%" PRIu32 "x%" PRIu32, s->grid[0], s->grid[1], s->grid[2]);
    }
}

static bool print_picture(const trade *t, FILE *f, const trade_setting *s, unsigned number) {
    const trade_group *group = s->group;
    trade_figures figures;
    uint64_t build_us, render_us;
    uint8_t *pixels = malloc((size_t)group->columns * group->rows * 3);
    bool is_drafted = s->cells != CELLS_FLAT;
    char *path =
        trade_path(t, "%td-%s-%" PRIu32 "x%" PRIu32 "-%u-%s%s%s.png", group - t->groups + 1, group->scene->label,
                   group->width, group->height, number, s->approx == TRADE_EXACT ? "exact" : s->rays->kinds,
                   is_drafted ? "-" : "", is_drafted ? settings_cells_names[s->cells] : "");
    bool done = pixels != NULL && path != NULL && trade_draw(t, s, pixels, &figures, &build_us, &render_us) &&
                write_picture(path, group, pixels);
    if (pixels == NULL) {
        tool_error(NULL, 0, "trade: no memory for a picture");
    }
    if (done) {
        (void)fprintf(f, "<figure><img width=\"%" PRIu32 "\" height=\"%" PRIu32 "\" alt=\"%s\" src=\"data:image/png;base64,",
                      group->columns, group->rows, s->rays->text);
        done = print_base64(f, path);
        (void)fprintf(f, "\"><figcaption>%s%s: %s ", s->approx == TRADE_EXACT ? "" : "approximate ",
                      s->rays->text, aset_method_name(s->method));
        print_grid(f, s);
        (void)fprintf(f, "%s%s%s, time %.2f, %" PRIu64 " bytes, ", is_drafted ? ", cells " : "",
                      is_drafted ? settings_cells_names[s->cells] : "",
                      s->curtail > 0 || s->approx == TRADE_EXACT || is_drafted ? "" : ", no curtailment", s->time,
                      s->figures.peak);
        (void)fprintf(f, s->figures.rmse > 0 ? "%.1f dB" : "equal", s->figures.psnr);
        (void)fputs("</figcaption></figure>\n", f);
    }
    free(path);
    free(pixels);
    return done;
}

static bool is_closer(const trade_setting *a, const trade_setting *b) {
    return a->figures.rmse < b->figures.rmse || (a->figures.rmse <= b->figures.rmse && a->time < b->time);
}

/*
 * For a kind of approximation and of cells the closest of the best settings (of equal ones the fastest); where none is best,
 * of all. NULL: there are none.
 */
static const trade_setting *choose_picture(const trade *t, const trade_group *group, unsigned approx, int cells) {
    const trade_setting *chosen = NULL;
    for (uint32_t i = 0; i < t->n_settings; i++) {
        const trade_setting *s = &t->settings[i];
        if (s->group == group && s->approx == approx && (int)s->cells == cells &&
            (chosen == NULL || s->best > chosen->best || (s->best == chosen->best && is_closer(s, chosen)))) {
            chosen = s;
        }
    }
    return chosen;
}

/* --- tables --- */

static int compare_time(const void *a, const void *b) {
    const trade_setting *x = *(const trade_setting *const *)a, *y = *(const trade_setting *const *)b;
    uint64_t time_x = trade_total(x), time_y = trade_total(y);
    return time_x != time_y ? (time_x < time_y ? -1 : 1) : x < y ? -1 : 1;
}

static void print_seconds(FILE *f, const trade_time *time) {
    (void)fprintf(f, "<td class=\"n\">%.4f</td><td class=\"n\">%.4f-%.4f</td>", 1e-6 * (double)time->median,
                  1e-6 * (double)time->low, 1e-6 * (double)time->high);
}

static void print_row(FILE *f, const trade_setting *s) {
    const trade_figures *v = &s->figures;
    (void)fprintf(f, "<tr%s><td>%s</td><td>%s</td><td class=\"n\">", s->best ? " class=\"best\"" : "", s->best ? "best" : "",
                  aset_method_name(s->method));
    print_grid(f, s);
    (void)fprintf(f, "</td><td>%s</td><td>%s</td><td>", s->rays->text,
                  s->approx != TRADE_EXACT ? settings_cells_names[s->cells] : "");
    if (s->approx != TRADE_EXACT && s->cells == CELLS_FLAT) {
        (void)fprintf(f, s->curtail > 0 ? "%g" : "off", s->curtail);
    }
    (void)fprintf(f, "</td><td class=\"n\">%.3f</td>", s->time);
    print_seconds(f, &s->build_time);
    print_seconds(f, &s->render_time);
    (void)fprintf(
        f, "<td class=\"n\">%" PRIu64 "</td><td class=\"n\">%.2f</td><td class=\"n\">%.4f</td><td class=\"n\">%u</td>",
        v->peak, v->psnr, v->ssim, v->max_difference);
    (void)fprintf(f, "<td class=\"n\">%.1f</td><td class=\"n\">%.2f</td><td class=\"n\">%.2f</td></tr>\n",
                  100 * v->differing, (double)v->tests / (double)v->rays, (double)v->cells / (double)v->rays);
}

static bool print_table(const trade *t, FILE *f, const trade_group *group) {
    const trade_setting **rows = malloc(t->n_settings * sizeof *rows);
    uint32_t n = 0;
    if (rows == NULL) {
        tool_error(NULL, 0, "trade: no memory for the table");
        return false;
    }
    for (uint32_t i = 0; i < t->n_settings; i++) {
        if (t->settings[i].group == group) {
            rows[n++] = &t->settings[i];
        }
    }
    qsort(rows, n, sizeof *rows, compare_time);
    (void)fputs(
        "<div class=\"scroll\"><table>\n<thead><tr><th></th><th>method</th><th "
        "class=\"n\">divisions</th><th>approximate</th>"
        "<th>cells</th><th>curtail</th><th class=\"n\">time, exact<br>mset = 1</th><th class=\"n\">build, s</th><th "
        "class=\"n\">min-max, s</th>"
        "<th class=\"n\">render, s</th><th class=\"n\">min-max, s</th><th class=\"n\">bytes</th><th class=\"n\">PSNR, "
        "dB</th>"
        "<th class=\"n\">SSIM</th><th class=\"n\">largest<br>difference</th><th class=\"n\">pixels<br>differing, %</th>"
        "<th class=\"n\">tests<br>a ray</th><th class=\"n\">cells<br>a ray</th></tr></thead>\n<tbody>\n",
        f);
    for (uint32_t i = 0; i < n; i++) {
        print_row(f, rows[i]);
    }
    (void)fputs("</tbody>\n</table></div>\n", f);
    free(rows);
    return true;
}

/* --- the page --- */

static bool print_group(const trade *t, FILE *f, const trade_group *group, char *const *plots) {
    const aset_counts *counts = &group->scene->loaded.scene.counts;
    uint32_t n = 0, n_best = 0;
    for (uint32_t i = 0; i < t->n_settings; i++) {
        n += t->settings[i].group == group;
        n_best += t->settings[i].group == group && t->settings[i].best;
    }
    (void)fputs("<h2>", f);
    print_escaped(f, group->scene->name);
    (void)fprintf(f,
                  ", %" PRIu32 "x%" PRIu32 "</h2>\n<p>%" PRIu32 " objects, %zu bytes of them; %" PRIu32 " settings, %" PRIu32
                  " of them best; %" PRIu32
                  " round%s; time 1 is %.4f s. Below, for each kind of approximation and of cells, the "
                  "closest of the best.</p>\n"
                  "<div class=\"pictures\">\n",
                  group->width, group->height, counts->objects, group->scene->loaded.scene_bytes, n, n_best, t->rounds,
                  t->rounds > 1 ? "s" : "", 1e-6 * (double)group->base);
    bool done = true;
    for (int cells = 0; cells < SETTINGS_CELLS; cells++) {
        for (unsigned approx = 0; done && approx < TRADE_APPROXES; approx++) {
            const trade_setting *s = choose_picture(t, group, approx, cells);
            done = s == NULL || print_picture(t, f, s, approx);
        }
    }
    (void)fputs("</div>\n", f);
    for (int i = 0; done && i < TRADE_PLOTS; i++) {
        const char *svg =
            plots[i] != NULL ? strstr(plots[i], "<svg") : NULL; /* without the prolog, which HTML does not have */
        (void)fputs(svg != NULL ? svg : "", f);
    }
    return done && print_table(t, f, group);
}

bool trade_page(trade *t, char *const *plots) {
    tool_output output;
    char *path = trade_path(t, "trade.html");
    bool done = path != NULL && tool_output_open(&output, path);
    if (!done) {
        free(path);
        return false;
    }
    (void)fputs(head, output.stream);
    (void)fputs(reading, output.stream);
    if (t->n_left_out > 0) {
        (void)fprintf(output.stream, "<p>%" PRIu32 " settings need more than %" PRIu64 " bytes and are left out; exact ones are here all the "
                      "same, for all is measured by them, but are not called best if they do.</p>\n", t->n_left_out, t->memory);
    }
    for (uint32_t i = 0; done && i < t->n_groups; i++) {
        done = print_group(t, output.stream, &t->groups[i], plots + (size_t)i * TRADE_PLOTS);
    }
    if (done) {
        (void)fputs("</body>\n</html>\n", output.stream);
        done = tool_output_close(&output);
    } else {
        tool_output_abort(&output);
    }
    free(path);
    return done;
}
