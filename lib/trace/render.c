/*
 * render.c - rows of a picture into the caller's buffer.
 *
 * No row depends on another one, so threads may share the rows out as they like.
 */
#include "base/vec.h"
#include "trace/drawing.h"
#include "trace/shade.h"

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

INLINE_BUT_FOR_SIZE aset_real clamp(aset_real x) {
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

void aset_drawing_ray(const drawing *d, uint32_t column, uint32_t row, uint32_t i, uint32_t j, aset_vec3 *origin,
                      aset_vec3 *direction) {
    aset_camera_ray(&d->eye, drawing_place(d, column, i, d->picture->width), drawing_place(d, row, j, d->picture->height), origin,
                    direction);
}

void aset_drawing_gather(gathered *g, aset_colour c, aset_real cover) {
    g->sum.r += clamp(c.r);
    g->sum.g += clamp(c.g);
    g->sum.b += clamp(c.b);
    g->cover += cover;
}

void aset_drawing_put(const drawing *d, const gathered *g, unsigned char *at) {
    aset_real n = (aset_real)d->samples, share = 1 / (n * n);
    aset_colour mean = {g->sum.r * share, g->sum.g * share, g->sum.b * share};
    put_pixel(at, d->picture, mean, g->cover * share);
}

static void draw_pixel(const drawing *d, uint32_t column, uint32_t row, unsigned char *at) {
    gathered g = {{0, 0, 0}, 0};
    for (uint32_t j = 0; j < d->samples; j++) {
        for (uint32_t i = 0; i < d->samples; i++) {
            aset_vec3 origin, direction;
            aset_real cover;
            aset_drawing_ray(d, column, row, i, j, &origin, &direction);
            aset_colour c = aset_trace_tree(d->tracer, origin, direction, NULL, d->scratch, d->statistics, &cover);
            aset_drawing_gather(&g, c, cover);
        }
    }
    aset_drawing_put(d, &g, at);
}

/* Draws some of the n_rows rows that are wanted from row on; how many. */
static uint32_t draw_rows(const drawing *d, aset_beams *beams, uint32_t row, uint32_t n_rows, unsigned char *line) {
#if ASET_WITH_DRAFTS
    uint32_t n = beams != NULL ? beams->calls->draw_rows(beams, d, row, n_rows, line, d->picture->stride) : 0;
    if (n > 0) {
        return n;
    }
#endif
    (void)beams, (void)n_rows;
    for (uint32_t column = 0; column < d->columns; column++) {
        draw_pixel(d, column, row, line + column * aset_format_bytes(d->picture->format));
    }
    return 1;
}

/* The scratch's beams, if they can draw the picture: all its eye rays ask a draft, by its planes. */
static aset_beams *beams_for(const drawing *d) {
#if ASET_WITH_DRAFTS
    const aset_tracer *tracer = d->tracer;
    aset_beams *beams = d->scratch->beams;
    bool asks = tracer->draft != NULL && !tracer->draft_sides && aset_policy_approximate(tracer, ASET_PRIMARY, 0);
    return beams != NULL && asks && beams->calls->begin(beams, d) ? beams : NULL;
#else
    (void)d;
    return NULL;
#endif
}

static aset_status drawing_make(drawing *d, const aset_tracer *tracer, const aset_view *view,
                                const aset_picture *picture, aset_scratch *scratch, aset_statistics *statistics) {
    if (view == NULL || picture == NULL || picture->pixels == NULL || aset_trace_check(tracer, scratch) != ASET_OK) {
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
    d->corner = tracer->spd_rules ? R(0.5) : 0;
    d->scratch = scratch;
    d->statistics = statistics;
    return aset_camera_make(&d->eye, view, picture->width, picture->height);
}

aset_status aset_render_rows(const aset_tracer *tracer, const aset_view *view, const aset_picture *picture,
                             uint32_t first_row, uint32_t n_rows, aset_scratch *scratch, aset_statistics *statistics) {
    drawing d = {0};
    aset_statistics ignored = {0};
    aset_status status = drawing_make(&d, tracer, view, picture, scratch, statistics != NULL ? statistics : &ignored);
    if (status != ASET_OK) {
        return status;
    }
    if (first_row > d.rows || n_rows > d.rows - first_row) {
        return ASET_ERR_ARGUMENT;
    }
    aset_beams *beams = beams_for(&d);
    unsigned char *line = picture->pixels;
    for (uint32_t row = first_row, end = first_row + n_rows; row < end;) {
        for (uint32_t n = draw_rows(&d, beams, row, end - row, line); n > 0; n--, row++, line += picture->stride) {
            if (picture->on_row != NULL && picture->on_row(picture->context, row, line) != 0) {
                return ASET_ERR_STOPPED;
            }
        }
    }
    return ASET_OK;
}
