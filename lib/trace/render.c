/*
 * render.c - rows of a picture into the caller's buffer.
 *
 * No row depends on another one, so threads may share the rows out as they like.
 */
#include "base/vec.h"
#include "trace/camera.h"
#include "trace/trace_tree.h"

#include <string.h>

#define PICTURE_MAX 65535u
#define SAMPLES_MAX 64u

size_t aset_format_bytes(aset_format format) {
    switch (format) {
    case ASET_RGB888: return 3;
    case ASET_RGBA8888: return 4;
    case ASET_GREY8: return 1;
    case ASET_RGB565: return 2;
    }
    return 0;
}

static aset_real clamp(aset_real x) {
    return x > 0 ? (x < 1 ? x : 1) : 0; /* NaN, which cannot come, would be 0 */
}

static uint8_t to_byte(aset_real x) {
    return (uint8_t)(clamp(x) * 255 + R(0.5));
}

/* cover: the share of samples that hit something. */
static void put_pixel(unsigned char *at, const aset_picture *picture, aset_colour c, aset_real cover) {
    uint8_t r = to_byte(c.r), g = to_byte(c.g), b = to_byte(c.b);
    switch (picture->format) {
    case ASET_RGBA8888:
        at[3] = picture->transparent ? to_byte(cover) : 255;
        /* fallthrough */
    case ASET_RGB888:
        at[0] = r;
        at[1] = g;
        at[2] = b;
        break;
    case ASET_GREY8: at[0] = to_byte(R(0.299) * c.r + R(0.587) * c.g + R(0.114) * c.b); break; /* Rec. 601 */
    case ASET_RGB565: {
        uint16_t packed = (uint16_t)((r >> 3) << 11 | (g >> 2) << 5 | b >> 3);
        memcpy(at, &packed, sizeof packed);
        break;
    }
    }
}

typedef struct drawing {
    const aset_tracer *tracer;
    const aset_picture *picture;
    camera eye;
    uint32_t columns, rows; /* rays at one a pixel */
    uint32_t samples;
    aset_scratch *scratch;
    aset_statistics *statistics;
} drawing;

/* One sample at (x, y) in pixels from the upper left corner; added to the pixel, clamped. */
static void add_sample(const drawing *d, aset_real x, aset_real y, aset_colour *sum, aset_real *cover) {
    aset_vec3 origin, direction;
    aset_real covered;
    camera_ray(&d->eye, 2 * x / (aset_real)d->picture->width - 1, 2 * y / (aset_real)d->picture->height - 1, &origin,
               &direction);
    aset_colour c = trace_tree(d->tracer, origin, direction, d->scratch, d->statistics, &covered);
    sum->r += clamp(c.r);
    sum->g += clamp(c.g);
    sum->b += clamp(c.b);
    *cover += covered;
}

static void draw_pixel(const drawing *d, uint32_t column, uint32_t row, unsigned char *at) {
    aset_colour sum = {0, 0, 0};
    aset_real cover = 0, n = (aset_real)d->samples;
    aset_real corner = d->tracer->spd_rules ? R(0.5) : 0; /* pixel corners lie half a pixel before the centres */
    for (uint32_t j = 0; j < d->samples; j++) {
        for (uint32_t i = 0; i < d->samples; i++) {
            add_sample(d, (aset_real)column - corner + ((aset_real)i + R(0.5)) / n,
                       (aset_real)row - corner + ((aset_real)j + R(0.5)) / n, &sum, &cover);
        }
    }
    aset_real share = 1 / (n * n);
    aset_colour mean = {sum.r * share, sum.g * share, sum.b * share};
    put_pixel(at, d->picture, mean, cover * share);
}

static aset_status drawing_make(drawing *d, const aset_tracer *tracer, const aset_view *view,
                                const aset_picture *picture, aset_scratch *scratch, aset_statistics *statistics) {
    if (view == NULL || picture == NULL || picture->pixels == NULL || trace_check(tracer, scratch) != ASET_OK) {
        return ASET_ERR_ARGUMENT;
    }
    if (picture->width == 0 || picture->width > PICTURE_MAX || picture->height == 0 || picture->height > PICTURE_MAX ||
        aset_format_bytes(picture->format) == 0 || tracer->samples > SAMPLES_MAX) {
        return ASET_ERR_ARGUMENT;
    }
    d->tracer = tracer;
    d->picture = picture;
    d->columns = picture->width + tracer->spd_rules;
    d->rows = picture->height + tracer->spd_rules;
    d->samples = tracer->samples > 0 ? tracer->samples : 1;
    d->scratch = scratch;
    d->statistics = statistics;
    return camera_make(&d->eye, view, picture->width, picture->height);
}

aset_status aset_render_rows(const aset_tracer *tracer, const aset_view *view, const aset_picture *picture,
                             uint32_t first_row, uint32_t n_rows, aset_scratch *scratch, aset_statistics *statistics) {
    drawing d;
    aset_statistics ignored;
    memset(&ignored, 0, sizeof ignored);
    aset_status status = drawing_make(&d, tracer, view, picture, scratch, statistics != NULL ? statistics : &ignored);
    if (status != ASET_OK) {
        return status;
    }
    if (first_row > d.rows || n_rows > d.rows - first_row) {
        return ASET_ERR_ARGUMENT;
    }
    size_t bytes = aset_format_bytes(picture->format);
    for (uint32_t row = 0; row < n_rows; row++) {
        unsigned char *line = (unsigned char *)picture->pixels + row * picture->stride;
        for (uint32_t column = 0; column < d.columns; column++) {
            draw_pixel(&d, column, first_row + row, line + column * bytes);
        }
        if (picture->on_row != NULL && picture->on_row(picture->context, first_row + row, line) != 0) {
            return ASET_ERR_STOPPED;
        }
    }
    return ASET_OK;
}
