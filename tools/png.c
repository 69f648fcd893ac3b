/*
 * png.c - pictures: rows out as PNG (through libpng) or PPM, whole pictures in.
 *
 * libpng reports errors by a call that must not return. Ours prints the line and jumps back to the setjmp of the
 * public function that called libpng; nothing that this file needs after a jump lives in a local variable.
 *
 * Invariant: a picture whose failed is set has had its error line and takes no more rows.
 */
#include "tool.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#define CHANNELS_RGB 3u
#define CHANNELS_RGBA 4u

struct tool_picture {
    tool_output output;
    png_structp png; /* NULL for a PPM */
    png_infop info;
    uint8_t *rgb_row; /* a PPM's row while it is widened from grey; NULL if not needed */
    uint32_t width, height, channels;
    uint32_t n_rows; /* written so far */
    bool failed;
};

/* --- writing --- */

/* A failed write has been told by the output, with the system's reason. */
static void writing_failed(png_structp png, png_const_charp message) {
    tool_picture *picture = png_get_error_ptr(png);
    if (!picture->failed && picture->output.error == 0) {
        tool_error(tool_output_name(picture->output.path), 0, "libpng: %s", message);
    }
    picture->failed = true;
    png_longjmp(png, 1);
}

/* libpng warns of oddities that do not change the pixels; a message while all goes well would only confuse. */
static void ignore_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size) {
    tool_picture *picture = png_get_io_ptr(png);
    if (!tool_output_write(&picture->output, bytes, size)) {
        png_error(png, "writing failed");
    }
}

static void flush_nothing(png_structp png) {
    (void)png;
}

/* No time, no text, no gamma: nothing but the pixels decides the bytes. */
static bool begin_png(tool_picture *picture) {
    int colour_type = picture->channels == 1               ? PNG_COLOR_TYPE_GRAY
                      : picture->channels == CHANNELS_RGBA ? PNG_COLOR_TYPE_RGB_ALPHA
                                                           : PNG_COLOR_TYPE_RGB;
    picture->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, picture, writing_failed, ignore_warning);
    if (picture->png == NULL) {
        if (!picture->failed) {
            tool_error(tool_output_name(picture->output.path), 0, "no memory for libpng");
        }
        return false;
    }
    if (setjmp(png_jmpbuf(picture->png)) != 0) {
        return false;
    }
    picture->info = png_create_info_struct(picture->png);
    if (picture->info == NULL) {
        png_error(picture->png, "no memory");
    }
    png_set_write_fn(picture->png, picture, write_bytes, flush_nothing);
    png_set_IHDR(picture->png, picture->info, picture->width, picture->height, 8, colour_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(picture->png, picture->info);
    return true;
}

static bool write_png_row(tool_picture *picture, const uint8_t *row) {
    if (setjmp(png_jmpbuf(picture->png)) != 0) {
        return false;
    }
    png_write_row(picture->png, row);
    return true;
}

static bool end_png(tool_picture *picture) {
    if (setjmp(png_jmpbuf(picture->png)) != 0) {
        return false;
    }
    png_write_end(picture->png, picture->info);
    return true;
}

static bool begin_ppm(tool_picture *picture) {
    char header[64];
    int length = snprintf(header, sizeof header, "P6\n%lu %lu\n255\n", (unsigned long)picture->width,
                          (unsigned long)picture->height);
    if (picture->channels == 1) {
        picture->rgb_row = malloc((size_t)picture->width * CHANNELS_RGB);
        if (picture->rgb_row == NULL) {
            tool_error(tool_output_name(picture->output.path), 0, "no memory for a row of the picture");
            return false;
        }
    }
    return tool_output_write(&picture->output, header, (size_t)length);
}

static bool write_ppm_row(tool_picture *picture, const uint8_t *row) {
    if (picture->channels == 1) {
        for (uint32_t x = 0; x < picture->width; x++) {
            memset(picture->rgb_row + (size_t)x * CHANNELS_RGB, row[x], CHANNELS_RGB);
        }
        row = picture->rgb_row;
    }
    return tool_output_write(&picture->output, row, (size_t)picture->width * CHANNELS_RGB);
}

static bool is_ppm(const char *path) {
    return tool_has_extension(path, ".ppm");
}

bool tool_picture_path_ok(const char *path) {
    if (strcmp(path, "-") == 0 || tool_has_extension(path, ".png") || is_ppm(path)) {
        return true;
    }
    tool_error(path, 0, "cannot tell the kind of picture from this name; it must end in .png or .ppm");
    return false;
}

static bool shape_ok(const char *path, bool ppm, uint32_t width, uint32_t height, uint32_t channels) {
    if (width < 1 || height < 1 || width > TOOL_SIDE_MAX || height > TOOL_SIDE_MAX) {
        tool_error(tool_output_name(path), 0, "a picture of %lux%lu pixels cannot be written; each side is from 1 to %u",
                   (unsigned long)width, (unsigned long)height, TOOL_SIDE_MAX);
        return false;
    }
    if ((channels != 1 && channels != CHANNELS_RGB && channels != CHANNELS_RGBA) ||
        (channels == CHANNELS_RGBA && ppm)) {
        tool_error(tool_output_name(path), 0, "%lu channels cannot be written; a .png takes 1, 3 or 4, a .ppm 1 or 3",
                   (unsigned long)channels);
        return false;
    }
    return true;
}

static void free_picture(tool_picture *picture) {
    if (picture->png != NULL) {
        png_destroy_write_struct(&picture->png, &picture->info);
    }
    free(picture->rgb_row);
    free(picture);
}

static tool_picture *open_picture(const char *path, bool ppm, uint32_t width, uint32_t height, uint32_t channels) {
    if (!shape_ok(path, ppm, width, height, channels)) {
        return NULL;
    }
    tool_picture *picture = calloc(1, sizeof *picture);
    if (picture == NULL) {
        tool_error(tool_output_name(path), 0, "no memory for the picture's state");
        return NULL;
    }
    picture->width = width;
    picture->height = height;
    picture->channels = channels;
    if (!tool_output_open(&picture->output, path)) {
        free(picture);
        return NULL;
    }
    if (!(ppm ? begin_ppm(picture) : begin_png(picture))) {
        tool_picture_abort(picture);
        return NULL;
    }
    return picture;
}

tool_picture *tool_picture_open(const char *path, uint32_t width, uint32_t height, uint32_t channels) {
    return tool_picture_path_ok(path) ? open_picture(path, is_ppm(path), width, height, channels) : NULL;
}

tool_picture *tool_picture_open_png(const char *path, uint32_t width, uint32_t height, uint32_t channels) {
    return open_picture(path, false, width, height, channels);
}

bool tool_picture_row(tool_picture *picture, const uint8_t *row) {
    if (picture->failed) {
        return false;
    }
    if (picture->n_rows == picture->height) {
        tool_error(tool_output_name(picture->output.path), 0, "more rows than the picture's %lu",
                   (unsigned long)picture->height);
        picture->failed = true;
    } else if (!(picture->png != NULL ? write_png_row(picture, row) : write_ppm_row(picture, row))) {
        picture->failed = true;
    } else {
        picture->n_rows++;
    }
    return !picture->failed;
}

bool tool_picture_close(tool_picture *picture) {
    if (!picture->failed && picture->n_rows < picture->height) {
        tool_error(tool_output_name(picture->output.path), 0, "only %lu of the picture's %lu rows were drawn",
                   (unsigned long)picture->n_rows, (unsigned long)picture->height);
        picture->failed = true;
    }
    if (!picture->failed && picture->png != NULL && !end_png(picture)) {
        picture->failed = true;
    }
    if (picture->failed) {
        tool_picture_abort(picture);
        return false;
    }
    bool closed = tool_output_close(&picture->output);
    free_picture(picture);
    return closed;
}

void tool_picture_abort(tool_picture *picture) {
    if (picture != NULL) {
        tool_output_abort(&picture->output);
        free_picture(picture);
    }
}

/* --- reading --- */

typedef struct picture_source {
    const char *path;
    FILE *file;
    tool_image *image;
    png_structp png;
    png_infop info;
    bool told; /* the error line has been printed */
} picture_source;

static void source_error(picture_source *source, const char *message) {
    if (!source->told) {
        tool_error(source->path, 0, "%s", message);
        source->told = true;
    }
}

/* The line for a read that gave too little. */
static void source_ended(picture_source *source) {
    source_error(source, ferror(source->file) != 0 ? strerror(errno) : "the file ends within the picture");
}

/* Takes the memory for an image of channels bytes a pixel. */
static bool allocate_image(picture_source *source, uint32_t width, uint32_t height, uint32_t channels) {
    if (width < 1 || height < 1 || (uint64_t)width * height > TOOL_PIXELS_MAX) {
        char message[96];
        (void)snprintf(message, sizeof message, "a picture of %lux%lu pixels; at most %u pixels are read",
                       (unsigned long)width, (unsigned long)height, TOOL_PIXELS_MAX);
        source_error(source, message);
        return false;
    }
    source->image->width = width;
    source->image->height = height;
    source->image->rgb = malloc((size_t)width * height * channels);
    if (source->image->rgb == NULL) {
        source_error(source, "no memory for the picture");
        return false;
    }
    return true;
}

static void reading_failed(png_structp png, png_const_charp message) {
    picture_source *source = png_get_error_ptr(png);
    char line[128];
    (void)snprintf(line, sizeof line, "not a PNG that can be read: %s", message);
    source_error(source, line);
    png_longjmp(png, 1);
}

static void read_bytes(png_structp png, png_bytep bytes, size_t size) {
    picture_source *source = png_get_io_ptr(png);
    if (fread(bytes, 1, size, source->file) != size) {
        source_ended(source);
        png_error(png, "read failed");
    }
}

/* R, G, B, A to R, G, B over black, in place: the reading end is never behind the writing one. */
static void flatten(tool_image *image) {
    size_t n_pixels = (size_t)image->width * image->height;
    const uint8_t *from = image->rgb;
    uint8_t *to = image->rgb;
    for (size_t i = 0; i < n_pixels; i++, from += CHANNELS_RGBA) {
        unsigned alpha = from[3];
        for (unsigned channel = 0; channel < CHANNELS_RGB; channel++) {
            *to++ = (uint8_t)((from[channel] * alpha + 127u) / 255u);
        }
    }
}

/* Under the setjmp of read_png. Every kind of PNG comes out as 8 bits of RGB, or RGBA where it has transparency. */
static bool read_png_pixels(picture_source *source) {
    png_structp png = source->png;
    png_set_read_fn(png, source, read_bytes);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); /* our own limit gives the clearer line */
    png_read_info(png, source->info);
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    int n_passes = png_set_interlace_handling(png);
    png_read_update_info(png, source->info);
    uint32_t width = png_get_image_width(png, source->info), height = png_get_image_height(png, source->info);
    uint32_t channels = png_get_channels(png, source->info);
    if (!allocate_image(source, width, height, channels)) {
        return false;
    }
    for (int pass = 0; pass < n_passes; pass++) {
        for (uint32_t y = 0; y < height; y++) {
            png_read_row(png, source->image->rgb + (size_t)y * width * channels, NULL);
        }
    }
    png_read_end(png, NULL);
    if (channels == CHANNELS_RGBA) {
        flatten(source->image);
    }
    return true;
}

static bool read_png(picture_source *source) {
    source->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, source, reading_failed, ignore_warning);
    if (source->png == NULL) {
        source_error(source, "no memory for libpng");
        return false;
    }
    if (setjmp(png_jmpbuf(source->png)) != 0) {
        return false;
    }
    source->info = png_create_info_struct(source->png);
    if (source->info == NULL) {
        png_error(source->png, "no memory");
    }
    return read_png_pixels(source);
}

static bool is_blank(int byte) {
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/*
 * The next byte of a PPM's header that is neither blank nor in a comment (# to the end of its line); EOF at the end.
 */
static int next_header_byte(FILE *file) {
    bool in_comment = false;
    for (;;) {
        int byte = getc(file);
        if (byte == EOF) {
            return EOF;
        }
        if (in_comment) {
            in_comment = byte != '\n';
        } else if (byte == '#') {
            in_comment = true;
        } else if (!is_blank(byte)) {
            return byte;
        }
    }
}

/*
 * The next whole number of a PPM's header; one blank behind it is taken too, as the format has it before the samples.
 */
static bool read_header_number(FILE *file, uint32_t *value) {
    int byte = next_header_byte(file);
    uint64_t sum = 0;
    if (byte < '0' || byte > '9') {
        return false;
    }
    for (; byte >= '0' && byte <= '9'; byte = getc(file)) {
        sum = sum * 10u + (uint64_t)(byte - '0');
        if (sum > PNG_UINT_31_MAX) {
            return false;
        }
    }
    *value = (uint32_t)sum;
    return is_blank(byte);
}

/* Brings n samples of bytes_each bytes (the high one first) from 0..largest to 0..255, rounded. Not in place. */
static bool scale_samples(uint8_t *to, const uint8_t *from, size_t n, unsigned bytes_each, uint32_t largest) {
    for (size_t i = 0; i < n; i++) {
        uint32_t sample = bytes_each == 1 ? from[i] : (uint32_t)from[2 * i] << 8 | from[2 * i + 1];
        if (sample > largest) {
            return false;
        }
        to[i] = (uint8_t)((sample * 255u + largest / 2u) / largest);
    }
    return true;
}

static bool read_ppm_rows(picture_source *source, uint8_t *row, unsigned bytes_each, uint32_t largest) {
    const tool_image *image = source->image;
    size_t n_samples = (size_t)image->width * CHANNELS_RGB;
    for (uint32_t y = 0; y < image->height; y++) {
        if (fread(row, bytes_each, n_samples, source->file) != n_samples) {
            source_ended(source);
            return false;
        }
        if (!scale_samples(image->rgb + y * n_samples, row, n_samples, bytes_each, largest)) {
            source_error(source, "a sample is above the largest value that the PPM's header names");
            return false;
        }
    }
    return true;
}

static bool read_ppm(picture_source *source) {
    uint32_t width, height, largest;
    FILE *file = source->file;
    if (getc(file) != 'P' || getc(file) != '6' || !is_blank(getc(file)) || !read_header_number(file, &width) ||
        !read_header_number(file, &height) || !read_header_number(file, &largest) || largest < 1 ||
        largest > 65535u) {
        source_error(source, "not a binary PPM: expected P6, width, height and a largest value from 1 to 65535");
        return false;
    }
    if (!allocate_image(source, width, height, CHANNELS_RGB)) {
        return false;
    }
    unsigned bytes_each = largest < 256u ? 1 : 2;
    uint8_t *row = malloc((size_t)width * CHANNELS_RGB * bytes_each);
    if (row == NULL) {
        source_error(source, "no memory for a row of the picture");
        return false;
    }
    bool read = read_ppm_rows(source, row, bytes_each, largest);
    free(row);
    return read;
}

bool tool_image_read(tool_image *image, const char *path) {
    picture_source source = {path, NULL, image, NULL, NULL, false};
    bool read = false;
    memset(image, 0, sizeof *image);
    source.file = fopen(path, "rb");
    if (source.file == NULL) {
        tool_error(path, 0, "cannot open it: %s", strerror(errno));
        return false;
    }
    if (!tool_input_note(source.file, path)) {
        (void)fclose(source.file);
        return false;
    }
    int first = getc(source.file);
    if (first == EOF) {
        source_error(&source, ferror(source.file) != 0 ? strerror(errno) : "the file is empty");
    } else if (ungetc(first, source.file) == 'P') {
        read = read_ppm(&source);
    } else if (first == 0x89) {
        read = read_png(&source);
    } else {
        source_error(&source, "neither a PNG nor a binary PPM (P6)");
    }
    if (source.png != NULL) {
        png_destroy_read_struct(&source.png, &source.info, NULL);
    }
    (void)fclose(source.file);
    if (!read) {
        tool_image_free(image);
    }
    return read;
}

void tool_image_free(tool_image *image) {
    free(image->rgb);
    memset(image, 0, sizeof *image);
}
