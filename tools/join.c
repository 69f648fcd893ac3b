/*
 * join.c - the command `aset join`: pieces of a picture, drawn by `aset render --rows`, one under the other.
 *
 * Every piece is opened twice: once for its size, as a PNG begins with its height, and once for its rows. One row is held.
 * libpng reports errors by a call that must not return: ours prints the line and jumps back to the setjmp of the function
 * that called libpng; nothing that is needed after a jump lives in a local variable.
 */
#include "tool.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

static const char help[] = "aset join PIECE... -o OUT: joins the pieces of a picture that aset render --rows drew.\n"
                           "\n"
                           "The pieces, PNG or PPM, stand in their order from the top; all have the same width and the same "
                           "channels. Pieces of all\n"
                           "rows give the bytes of the picture drawn as a whole. Only a row is held in memory.\n"
                           "\n"
                           "  -o, --output FILE  .png or .ppm; - for PNG on standard output\n"
                           "  -h, --help         this text\n";

typedef struct shape {
    uint32_t width, height, channels;
} shape;

typedef struct piece {
    const char *path;
    FILE *file;
    png_structp png; /* NULL for a PPM */
    png_infop info;
    shape shape;
    bool told; /* the error line has been printed */
} piece;

static bool refuse(piece *p, const char *message) {
    if (!p->told) {
        tool_error(p->path, 0, "%s", message);
        p->told = true;
    }
    return false;
}

static bool refuse_end(piece *p) {
    return refuse(p, ferror(p->file) != 0 ? strerror(errno) : "the file ends within the picture");
}

/* ---- a PNG ---- */

static void reading_failed(png_structp png, png_const_charp message) {
    char line[128];
    (void)snprintf(line, sizeof line, "not a PNG that can be read: %s", message);
    (void)refuse(png_get_error_ptr(png), line);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size) {
    piece *p = png_get_io_ptr(png);
    if (fread(bytes, 1, size, p->file) != size) {
        (void)refuse_end(p);
        png_error(png, "read failed");
    }
}

/* Palettes, other depths and grey with transparency become what can be written: 8 bits of 1, 3 or 4 channels. */
static bool open_png(piece *p) {
    p->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, p, reading_failed, ignore_warning);
    if (p->png == NULL) {
        return refuse(p, "no memory for libpng");
    }
    if (setjmp(png_jmpbuf(p->png)) != 0) {
        return false;
    }
    p->info = png_create_info_struct(p->png);
    if (p->info == NULL) {
        png_error(p->png, "no memory");
    }
    png_set_read_fn(p->png, p, read_bytes);
    png_set_user_limits(p->png, TOOL_SIDE_MAX, TOOL_SIDE_MAX);
    png_read_info(p->png, p->info);
    if (png_get_interlace_type(p->png, p->info) != PNG_INTERLACE_NONE) {
        return refuse(p, "an interlaced PNG, whose rows do not come in order; expected one as aset render writes it");
    }
    png_set_expand(p->png);
    png_set_scale_16(p->png);
    if (png_get_color_type(p->png, p->info) == PNG_COLOR_TYPE_GRAY_ALPHA ||
        png_get_valid(p->png, p->info, PNG_INFO_tRNS) != 0) {
        png_set_gray_to_rgb(p->png);
    }
    png_read_update_info(p->png, p->info);
    p->shape.width = png_get_image_width(p->png, p->info);
    p->shape.height = png_get_image_height(p->png, p->info);
    p->shape.channels = png_get_channels(p->png, p->info);
    return true;
}

/* row NULL: what stands behind the last row. */
static bool read_png(piece *p, uint8_t *row) {
    if (setjmp(png_jmpbuf(p->png)) != 0) {
        return false;
    }
    if (row != NULL) {
        png_read_row(p->png, row, NULL);
    } else {
        png_read_end(p->png, NULL);
    }
    return true;
}

/* ---- a PPM ---- */

static bool open_ppm(piece *p) {
    unsigned long width = 0, height = 0, largest = 0;
    char behind[2];
    int n = fscanf(p->file, "P6%1[ \t\r\n]%7lu %7lu %7lu", behind, &width, &height, &largest) - 1;
    int blank = getc(p->file);
    if (n != 3 || width < 1 || height < 1 || width > TOOL_SIDE_MAX || height > TOOL_SIDE_MAX || largest != 255 ||
        (blank != '\n' && blank != ' ' && blank != '\t' && blank != '\r')) {
        return refuse(p, "not a binary PPM as aset render writes it: expected P6, width, height, 255, and no comment");
    }
    p->shape.width = (uint32_t)width;
    p->shape.height = (uint32_t)height;
    p->shape.channels = 3;
    return true;
}

static bool read_ppm(piece *p, uint8_t *row) {
    if (row == NULL) {
        return getc(p->file) == EOF || refuse(p, "more bytes than the picture has");
    }
    return fread(row, 3, p->shape.width, p->file) == p->shape.width || refuse_end(p);
}

/* ---- pieces ---- */

static void piece_close(piece *p) {
    if (p->png != NULL) {
        png_destroy_read_struct(&p->png, &p->info, NULL);
    }
    if (p->file != NULL) {
        (void)fclose(p->file);
    }
}

/* Up to its first row. False after an error line, and then it is closed. */
static bool piece_open(piece *p, const char *path) {
    memset(p, 0, sizeof *p);
    p->path = path;
    p->file = fopen(path, "rb");
    if (p->file == NULL) {
        tool_error(path, 0, "cannot open it: %s", strerror(errno));
        return false;
    }
    if (!tool_input_note(p->file, path)) {
        piece_close(p);
        return false;
    }
    int first = getc(p->file);
    bool opened;
    if (first == EOF) {
        opened = refuse(p, ferror(p->file) != 0 ? strerror(errno) : "the file is empty");
    } else if (ungetc(first, p->file) == 0x89) {
        opened = open_png(p);
    } else {
        opened = first == 'P' ? open_ppm(p) : refuse(p, "neither a PNG nor a binary PPM (P6)");
    }
    if (!opened) {
        piece_close(p);
    }
    return opened;
}

static const char *kind_of(uint32_t channels) {
    return channels == 1 ? "grey" : channels == 3 ? "RGB" : "RGBA";
}

/* The shape of the whole: the first piece's width and channels, which all must have, and the sum of the heights. */
static bool measure(shape *whole, char *const paths[], int n) {
    uint64_t rows = 0;
    for (int i = 0; i < n; i++) {
        piece p;
        if (!piece_open(&p, paths[i])) {
            return false;
        }
        shape s = p.shape;
        piece_close(&p);
        if (i > 0 && s.width != whole->width) {
            tool_error(paths[i], 0, "this piece is %lu pixels wide, but %s is %lu", (unsigned long)s.width, paths[0],
                       (unsigned long)whole->width);
            return false;
        }
        if (i > 0 && s.channels != whole->channels) {
            tool_error(paths[i], 0, "the pixels of this piece are %s, but those of %s are %s", kind_of(s.channels), paths[0],
                       kind_of(whole->channels));
            return false;
        }
        whole->width = s.width;
        whole->channels = s.channels;
        rows += s.height;
    }
    /* a sum beyond 32 bits is refused by whoever is to write it, as any above TOOL_SIDE_MAX is */
    whole->height = rows < UINT32_MAX ? (uint32_t)rows : UINT32_MAX;
    return true;
}

/* Takes a piece's rows over; *left: rows that the whole still has room for. */
static bool append(tool_picture *picture, const char *path, const shape *whole, uint8_t *row, uint32_t *left) {
    piece p;
    if (!piece_open(&p, path)) {
        return false;
    }
    bool done = true;
    if (p.shape.width != whole->width || p.shape.channels != whole->channels || p.shape.height > *left) {
        done = refuse(&p, "the file has changed while it was read");
    }
    for (uint32_t y = 0; y <= p.shape.height && done; y++) {
        uint8_t *to = y < p.shape.height ? row : NULL;
        done = p.png != NULL ? read_png(&p, to) : read_ppm(&p, to);
        done = done && (to == NULL || tool_picture_row(picture, row));
    }
    *left -= done ? p.shape.height : 0;
    piece_close(&p);
    return done;
}

static int join(char *const paths[], int n, const char *output) {
    shape whole = {0, 0, 0};
    if (!measure(&whole, paths, n)) {
        return TOOL_FAILED;
    }
    uint8_t *row = malloc((size_t)whole.width * whole.channels);
    if (row == NULL) {
        tool_error(NULL, 0, "no memory for a row of the picture");
        return TOOL_FAILED;
    }
    tool_picture *picture = tool_picture_open(output, whole.width, whole.height, whole.channels);
    bool done = picture != NULL;
    uint32_t left = whole.height;
    for (int i = 0; i < n && done; i++) {
        done = append(picture, paths[i], &whole, row, &left);
    }
    if (done) {
        done = tool_picture_close(picture);
    } else {
        tool_picture_abort(picture);
    }
    free(row);
    return done ? TOOL_DONE : TOOL_FAILED;
}

int command_join(int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    const char *output = NULL;
    int option;
    while ((option = tool_option_next(argc, argv, "o:h", longs)) != -1) {
        switch (option) {
        case 'o':
            if (!tool_parse_output(optarg, &output)) {
                return TOOL_USAGE;
            }
            break;
        case 'h': return tool_help(help);
        default: return TOOL_USAGE;
        }
    }
    if (optind == argc) {
        tool_error(NULL, 0, "join: expected the pieces of a picture; aset join --help tells more");
        return TOOL_USAGE;
    }
    if (output == NULL) {
        tool_error(NULL, 0, "join: where should the picture go? -o OUT.png");
        return TOOL_USAGE;
    }
    return tool_picture_path_ok(output) ? join(argv + optind, argc - optind, output) : TOOL_USAGE;
}
