/*
 * sheet.c - the command `aset sheet`: pictures side by side on one, with words under them.
 *
 *     margin +---------+ margin +---------+ margin      every cell is as wide and as high as the largest picture, and wider
 *            | picture |        | picture |             where a label needs it; a picture stands in the middle of its cell's
 *            +---------+        +---------+             lower edge, on its label; all rows are equally high
 *              label              label
 *
 * The whole sheet and all pictures are held in memory; nothing is written before every picture has been read.
 */
#include "font.h"
#include "tool.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS 3u
#define MARGIN 12u
/* Dots between lines of text, and between a picture and its label. */
#define LEADING 2u
#define GAP 4u
/* A dot of text is a pixel in narrow cells, one more for each so many pixels of a cell's width, if the words allow it. */
#define WIDTH_A_DOT 120u
#define DOT_MAX 4u

static const char help[] =
    "aset sheet -o OUT.png [--columns N] [--title TEXT] PICTURE[=LABEL]...: puts pictures side by side on one.\n"
    "\n"
    "A PICTURE is a PNG (any kind, brought to 8 bits of RGB, transparency laid over black) or a binary PPM, of any\n"
    "size; the cells take the largest. The LABEL begins behind the first = and stands under the picture: ASCII, a | begins\n"
    "a new line; it may be empty. The letters grow with the cells.\n"
    "\n"
    "Options:\n"
    "  -o, --output F   where the sheet goes (.png or .ppm; - for PNG on standard output)\n"
    "      --columns N  pictures in a row; default: as many as there are rows, or one more\n"
    "      --title T    a line above the pictures\n"
    "  -h, --help       print this text\n";

typedef struct cell {
    const char *path;
    const char *label; /* may be empty */
    tool_image image;
} cell;

typedef struct sheet {
    cell *cells;
    uint32_t n_cells, columns; /* columns 0: automatic */
    const char *title;         /* NULL or empty: none */
    const char *output;
    /* the layout, in pixels; wide enough that no sum overflows, as it may exceed what can be drawn */
    uint64_t cell_width, picture_height, label_height, title_height, width, height;
    uint32_t dot, title_dot; /* pixels of a dot of text */
} sheet;

/* Characters up to the end of the line. */
static size_t line_length(const char *line) {
    return strcspn(line, "|");
}

static uint64_t lines_of(const char *label) {
    uint64_t n = *label != '\0';
    for (; *label != '\0'; label++) {
        n += *label == '|';
    }
    return n;
}

static size_t longest_line(const char *label) {
    size_t longest = 0;
    for (;;) {
        size_t n = line_length(label);
        longest = n > longest ? n : longest;
        if (label[n] == '\0') {
            return longest;
        }
        label += n + 1;
    }
}

static uint64_t text_width(size_t n, uint32_t dot) {
    return n > 0 ? ((uint64_t)n * FONT_WIDTH - 1u) * dot : 0;
}

static uint64_t text_height(uint64_t n_lines, uint32_t dot) {
    return n_lines * (FONT_HEIGHT + LEADING) * dot;
}

static uint64_t larger(uint64_t a, uint64_t b) {
    return a > b ? a : b;
}

/* The dot of the labels: the largest that the cells' width deserves and every line fits in, but at least a pixel. */
static uint32_t label_dot(uint64_t picture_width, size_t longest) {
    uint32_t dot = DOT_MAX;
    while (dot > 1 && (picture_width / WIDTH_A_DOT < dot || text_width(longest, dot) > picture_width)) {
        dot--;
    }
    return dot;
}

static void lay_out_title(sheet *s) {
    size_t n = s->title != NULL ? strlen(s->title) : 0;
    s->title_dot = s->dot + 1;
    if (n == 0) {
        return;
    }
    while (s->title_dot > 1 && text_width(n, s->title_dot) + 2u * MARGIN > s->width) {
        s->title_dot--;
    }
    s->width = larger(s->width, text_width(n, s->title_dot) + 2u * MARGIN);
    s->title_height = text_height(1, s->title_dot);
}

/* The fewest columns that make no more rows than there are columns. */
static uint32_t square_columns(uint32_t n) {
    uint32_t columns = 1;
    while ((uint64_t)columns * columns < n) {
        columns++;
    }
    return columns;
}

static void lay_out_cells(sheet *s) {
    size_t longest = 0;
    uint64_t n_lines = 0, picture_width = 0;
    for (uint32_t i = 0; i < s->n_cells; i++) {
        const cell *c = &s->cells[i];
        size_t length = longest_line(c->label);
        longest = length > longest ? length : longest;
        n_lines = larger(n_lines, lines_of(c->label));
        picture_width = larger(picture_width, c->image.width);
        s->picture_height = larger(s->picture_height, c->image.height);
    }
    s->dot = label_dot(picture_width, longest);
    s->cell_width = larger(picture_width, text_width(longest, s->dot));
    s->label_height = n_lines > 0 ? text_height(n_lines, s->dot) + (uint64_t)GAP * s->dot : 0;
}

static bool lay_out(sheet *s) {
    lay_out_cells(s);
    if (s->columns == 0 || s->columns > s->n_cells) {
        s->columns = s->columns == 0 ? square_columns(s->n_cells) : s->n_cells;
    }
    uint64_t n_rows = ((uint64_t)s->n_cells + s->columns - 1u) / s->columns;
    s->width = MARGIN + s->columns * (s->cell_width + MARGIN);
    lay_out_title(s);
    s->height = MARGIN + (s->title_height > 0 ? s->title_height + MARGIN : 0) +
                n_rows * (s->picture_height + s->label_height + MARGIN);
    if (s->width > TOOL_SIDE_MAX || s->height > TOOL_SIDE_MAX || s->width * s->height > TOOL_PIXELS_MAX) {
        tool_error(tool_output_name(s->output), 0,
                   "the sheet would have %" PRIu64 "x%" PRIu64 " pixels; at most %u are drawn, and %u on a side", s->width,
                   s->height, TOOL_PIXELS_MAX, TOOL_SIDE_MAX);
        return false;
    }
    return true;
}

/* --- drawing; the layout has room for everything that is drawn --- */

static void draw_picture(tool_image *canvas, const tool_image *picture, uint64_t left, uint64_t top) {
    for (uint32_t y = 0; y < picture->height; y++) {
        memcpy(canvas->rgb + ((top + y) * canvas->width + left) * CHANNELS,
               picture->rgb + (size_t)y * picture->width * CHANNELS, (size_t)picture->width * CHANNELS);
    }
}

static void draw_dot(tool_image *canvas, uint64_t left, uint64_t top, uint32_t dot) {
    for (uint32_t y = 0; y < dot; y++) {
        memset(canvas->rgb + ((top + y) * canvas->width + left) * CHANNELS, 0, (size_t)dot * CHANNELS);
    }
}

/* The first n characters, centred within width. */
static void draw_line(tool_image *canvas, const char *line, size_t n, uint64_t left, uint64_t width, uint64_t top,
                      uint32_t dot) {
    left += (width - text_width(n, dot)) / 2;
    for (size_t i = 0; i < n; i++) {
        for (unsigned at = 0; at < FONT_WIDTH * FONT_HEIGHT; at++) {
            unsigned x = at % FONT_WIDTH, y = at / FONT_WIDTH;
            if (font_dot(line[i], x, y)) {
                draw_dot(canvas, left + (i * FONT_WIDTH + x) * dot, top + (uint64_t)y * dot, dot);
            }
        }
    }
}

static void draw_cell(tool_image *canvas, const sheet *s, const cell *c, uint64_t left, uint64_t top) {
    draw_picture(canvas, &c->image, left + (s->cell_width - c->image.width) / 2, top + s->picture_height - c->image.height);
    const char *line = c->label;
    for (top += s->picture_height + (uint64_t)GAP * s->dot;; top += text_height(1, s->dot)) {
        size_t n = line_length(line);
        draw_line(canvas, line, n, left, s->cell_width, top, s->dot);
        if (line[n] == '\0') {
            return;
        }
        line += n + 1;
    }
}

static void draw_sheet(tool_image *canvas, const sheet *s) {
    uint64_t top = MARGIN;
    memset(canvas->rgb, 255, (size_t)canvas->width * canvas->height * CHANNELS);
    if (s->title_height > 0) {
        draw_line(canvas, s->title, strlen(s->title), 0, s->width, top, s->title_dot);
        top += s->title_height + MARGIN;
    }
    for (uint32_t i = 0; i < s->n_cells; i++) {
        uint64_t row = i / s->columns, column = i % s->columns;
        draw_cell(canvas, s, &s->cells[i], MARGIN + column * (s->cell_width + MARGIN),
                  top + row * (s->picture_height + s->label_height + MARGIN));
    }
}

static bool write_sheet(const tool_image *canvas, const char *path) {
    tool_picture *file = tool_picture_open(path, canvas->width, canvas->height, CHANNELS);
    if (file == NULL) {
        return false;
    }
    for (uint32_t y = 0; y < canvas->height; y++) {
        if (!tool_picture_row(file, canvas->rgb + (size_t)y * canvas->width * CHANNELS)) {
            tool_picture_abort(file);
            return false;
        }
    }
    return tool_picture_close(file);
}

static bool make_sheet(sheet *s) {
    for (uint32_t i = 0; i < s->n_cells; i++) {
        if (!tool_image_read(&s->cells[i].image, s->cells[i].path)) {
            return false;
        }
    }
    if (!lay_out(s)) {
        return false;
    }
    tool_image canvas = {malloc((size_t)(s->width * s->height * CHANNELS)), (uint32_t)s->width, (uint32_t)s->height};
    if (canvas.rgb == NULL) {
        tool_error(tool_output_name(s->output), 0, "no memory for the sheet's %" PRIu64 "x%" PRIu64 " pixels", s->width,
                   s->height);
        return false;
    }
    draw_sheet(&canvas, s);
    bool done = write_sheet(&canvas, s->output);
    tool_image_free(&canvas);
    return done;
}

/* --- the words --- */

static bool text_ok(const char *what, const char *text) {
    for (; *text != '\0'; text++) {
        if (!font_has(*text)) {
            tool_error(NULL, 0, "sheet: the %s has a character that the font has not, expected ASCII from blank to ~", what);
            return false;
        }
    }
    return true;
}

/* Takes PICTURE[=LABEL] apart, within the word. */
static bool parse_cell(cell *c, char *word) {
    char *equals = strchr(word, '=');
    c->path = word;
    c->label = "";
    if (equals != NULL) {
        *equals = '\0';
        c->label = equals + 1;
    }
    if (*word == '\0') {
        tool_error(NULL, 0, "sheet: a picture's name is empty, expected PICTURE or PICTURE=LABEL");
        return false;
    }
    return text_ok("label", c->label);
}

static int run(sheet *s, char **words) {
    s->cells = calloc(s->n_cells, sizeof *s->cells);
    if (s->cells == NULL) {
        tool_error(NULL, 0, "no memory for a sheet of %" PRIu32 " pictures", s->n_cells);
        return TOOL_FAILED;
    }
    int status = TOOL_DONE;
    for (uint32_t i = 0; i < s->n_cells && status == TOOL_DONE; i++) {
        status = parse_cell(&s->cells[i], words[i]) ? TOOL_DONE : TOOL_USAGE;
    }
    if (status == TOOL_DONE && !make_sheet(s)) {
        status = TOOL_FAILED;
    }
    for (uint32_t i = 0; i < s->n_cells; i++) {
        tool_image_free(&s->cells[i].image);
    }
    free(s->cells);
    return status;
}

int command_sheet(int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"columns", required_argument, NULL, 'c'},
        {"title", required_argument, NULL, 't'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    sheet s;
    int option;
    memset(&s, 0, sizeof s);
    while ((option = tool_option_next(argc, argv, "o:h", longs)) != -1) {
        bool fine = option != '?';
        switch (option) {
        case 'o': fine = tool_parse_output(optarg, &s.output) && tool_picture_path_ok(optarg); break;
        case 'c': fine = tool_parse_count("sheet: --columns", optarg, 1, TOOL_SIDE_MAX, &s.columns); break;
        case 't': s.title = optarg; fine = text_ok("title", optarg); break;
        case 'h': return tool_help(help);
        default: break;
        }
        if (!fine) {
            return TOOL_USAGE;
        }
    }
    if (s.output == NULL) {
        tool_error(NULL, 0, "sheet: where should it go? expected -o OUT.png; aset sheet --help tells more");
        return TOOL_USAGE;
    }
    if (optind >= argc) {
        tool_error(NULL, 0, "sheet: expected pictures, got none; aset sheet --help tells more");
        return TOOL_USAGE;
    }
    s.n_cells = (uint32_t)(argc - optind);
    return run(&s, argv + optind);
}
