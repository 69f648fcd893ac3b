/*
 * beam.c - rows of a draft's picture in beams of some pixels: which voxels lie before which pixels, and what is drawn of them.
 *
 *     band              +-+---+------+--      of 16 rows or 8: its voxels, nearest first, each with its columns and rows
 *                       | |   |      |
 *     one, two or four rows                   those of the band that they meet
 *     segment           |======|              of 32 columns: those of the rows' that it meets
 *     beam                |==|                of as many columns as it has: those of the segment's that it meets
 *
 * The order is one in which every ray from the eye passes what it meets: away from the eye's own voxel on each axis, blocks
 * before voxels. A band of eight rows that shows more voxels than there is room for is left to single rays.
 */
#include "approx/draft_beam.h"
#include "approx/draft_query.h"
#include "trace/beam_shade.h"
#include "trace/drawing.h"
#include "trace/outlook.h"

#include <string.h>

#if ASET_WITH_DRAFTS

#define BEAM_RAYS ((uint32_t)DRAFT_BEAM)
/* Rows of a band. */
#define BAND_LEAST 8u
#define BAND_MOST 16u
#define SEGMENT 32u
/* Beams whose pixels are put together. */
#define BEAM_GROUP 4u
#define NONE UINT32_MAX
/* Pixels that a voxel must cover for beams to take less time than single rays: 0.7 to 5, by the draft, in nine at 64 to 256 pixels. */
#define LEAST_PIXELS R(2)
/* Pixels that an outline's edges may err by: a picture's width has 16 bits, and a float 24. */
#define PAD R(0.02)

/* The eye rays of neighbouring pixels, their numbers side by side, and what they meet. */
typedef struct beam_rays {
    aset_real origins[3][DRAFT_BEAM], directions[3][DRAFT_BEAM];
    aset_real ends[DRAFT_BEAM]; /* where they meet an object that the draft keeps; infinity: none */
    draft_beam met;
} beam_rays;

/* Beams that are drawn together: their pixels, width by rows, and what these have gathered. */
typedef struct beam_group {
    union { /* hits are shaded together only where the draft keeps nothing */
        query_hit kept[DRAFT_BEAM]; /* what the rays of one beam have met of that */
#if DRAFT_SHADES_BEAMS
        beam_shader shader;
#endif
    } of;
    bool shades;
    uint32_t n_beams, rows;
    size_t stride;
    uint32_t width[BEAM_GROUP];
    unsigned char *at[BEAM_GROUP];
    gathered pixels[BEAM_GROUP][DRAFT_BEAM];
} beam_group;

typedef struct order {
    uint8_t at[3][128]; /* blocks on each axis, in order */
    uint8_t in_block[3][3][4]; /* voxels of a block: of one before the eye's own on the axis, of that one, of one behind */
    int32_t eye_block[3];
} order;

typedef struct band_maker {
    aset_beams *beams;
    const drawing *picture;
    const aset_draft *draft;
    outlook_cells cells;
    aset_outlook outlook;
    order order;
    uint32_t first_row, rows;
} band_maker;

/* The eye's voxel on an axis; before all or behind all of them if everything is seen from there. */
static int32_t eye_voxel(const band_maker *m, int a) {
    const aset_draft *draft = m->draft;
    int32_t n = (int32_t)draft->n[a];
    if (m->outlook.parallel) {
        return vec_at(&m->outlook.forward, a) >= 0 ? -1 : n;
    }
    aset_real k = (vec_at(&m->outlook.from, a) - draft->low[a]) * draft->per_size[a] / 4;
    return k < 0 ? -1 : k >= (aset_real)n ? n : (int32_t)k;
}

static void make_order(band_maker *m) {
    for (int a = 0; a < 3; a++) {
        int32_t n = (int32_t)m->draft->blocks[a], voxel = eye_voxel(m, a), eye = voxel < 0 ? -1 : voxel / 4, at = 0;
        for (int32_t k = eye < 0 ? 0 : eye; k < n; k++) {
            m->order.at[a][at++] = (uint8_t)k;
        }
        for (int32_t k = eye < n ? eye - 1 : n - 1; k >= 0; k--) {
            m->order.at[a][at++] = (uint8_t)k;
        }
        m->order.eye_block[a] = eye;
        for (uint8_t k = 0; k < 4; k++) {
            m->order.in_block[a][0][k] = (uint8_t)(3 - k);
            m->order.in_block[a][2][k] = k;
        }
        at = 0;
        for (int32_t k = voxel < 0 ? 0 : voxel & 3; k < 4; k++) {
            m->order.in_block[a][1][at++] = (uint8_t)k;
        }
        for (int32_t k = (voxel < 0 ? 0 : voxel & 3) - 1; k >= 0; k--) {
            m->order.in_block[a][1][at++] = (uint8_t)k;
        }
    }
}

static const uint8_t *voxel_order(const order *o, int a, uint32_t block) {
    int32_t from_eye = (int32_t)block - o->eye_block[a];
    return o->in_block[a][from_eye < 0 ? 0 : from_eye > 0 ? 2 : 1];
}

/* The pixels, of n, of whose samples some lie between low and high in -1..1. False: none. */
static bool pixels_between(int32_t *first, int32_t *last, aset_real low, aset_real high, uint32_t size, uint32_t n,
                           const drawing *d) {
    aset_real half = R(0.5) / (aset_real)(int32_t)d->samples, scale = (aset_real)(int32_t)size / 2, end = (aset_real)(int32_t)n;
    aset_real from = (low + 1) * scale + d->corner - (1 - half) - PAD, to = (high + 1) * scale + d->corner - half + PAD;
    if (!(from < end && to >= 0)) {
        return false;
    }
    *first = from > 0 ? (int32_t)from + ((aset_real)(int32_t)from < from) : 0;
    *last = to < end ? (int32_t)to : (int32_t)n - 1;
    return *first <= *last;
}

/* Adds a voxel if the band shows it. False: no room. */
static bool add_voxel(band_maker *m, const uint8_t block[3], uint32_t dense, uint32_t x, uint32_t y, uint32_t z) {
    aset_beams *b = m->beams;
    const drawing *d = m->picture;
    aset_vec3 middle = outlook_middle(&m->cells, block[0] * 4u + x, block[1] * 4u + y, block[2] * 4u + z);
    outlook_rectangle r = outlook_of(&m->outlook, vec_sub(middle, m->outlook.from), 1);
    int32_t left, right, top, bottom, first = (int32_t)m->first_row, rows = (int32_t)m->rows;
    if (!pixels_between(&top, &bottom, r.top, r.bottom, d->picture->height, d->rows, d) || bottom < first ||
        top >= first + rows || !pixels_between(&left, &right, r.left, r.right, d->picture->width, d->columns, d)) {
        return true;
    }
    if (b->n_voxels == b->capacity) {
        return false;
    }
    aset_beam_voxel *v = b->voxels + b->n_voxels++;
    v->left = (uint16_t)left;
    v->right = (uint16_t)right;
    v->top = (uint8_t)(top > first ? top - first : 0);
    v->bottom = (uint8_t)(bottom - first < rows ? bottom - first : rows - 1);
    v->in_block = (uint8_t)(x + 4 * y + 16 * z);
    v->dense = dense;
    v->block[0] = block[0];
    v->block[1] = block[1];
    v->block[2] = block[2];
    return true;
}

/* Does the band show anything of the block? */
static bool shows_block(const band_maker *m, const uint8_t block[3]) {
    const drawing *d = m->picture;
    aset_vec3 corner = outlook_middle(&m->cells, block[0] * 4u, block[1] * 4u, block[2] * 4u);
    aset_vec3 way = vec_sub(vec_add(corner, vec_scale(m->cells.voxel, R(1.5))), m->outlook.from);
    int32_t top, bottom;
    if (!m->outlook.parallel && !(vec_dot(way, m->outlook.forward) > 4 * m->outlook.half_forward)) {
        return true; /* it reaches beside the eye, though no voxel does */
    }
    outlook_rectangle r = outlook_of(&m->outlook, way, 4);
    return pixels_between(&top, &bottom, r.top, r.bottom, d->picture->height, d->rows, d) && bottom >= (int32_t)m->first_row &&
           top < (int32_t)(m->first_row + m->rows);
}

static bool add_block(band_maker *m, const uint8_t block[3], uint32_t dense) {
    const uint8_t *in_x = voxel_order(&m->order, 0, block[0]), *in_y = voxel_order(&m->order, 1, block[1]);
    const uint8_t *in_z = voxel_order(&m->order, 2, block[2]);
    uint64_t marks = draft_marks(m->draft, dense);
    for (int z = 0; z < 4; z++) {
        for (int y = 0; y < 4; y++) {
            unsigned row = (unsigned)(marks >> (16 * in_z[z] + 4 * in_y[y])) & 15u;
            for (int x = 0; x < 4 && row != 0; x++) {
                if ((row >> in_x[x] & 1u) != 0 && !add_voxel(m, block, dense, in_x[x], in_y[y], in_z[z])) {
                    return false;
                }
            }
        }
    }
    return true;
}

/* False: no room. */
static bool fill_band(band_maker *m, uint32_t row) {
    const aset_draft *draft = m->draft;
    const uint32_t *n = draft->blocks;
    m->first_row = row / m->rows * m->rows;
    m->beams->n_voxels = 0;
    for (uint32_t z = 0; z < n[2]; z++) {
        for (uint32_t y = 0; y < n[1]; y++) {
            for (uint32_t x = 0; x < n[0]; x++) {
                const uint8_t at[3] = {m->order.at[0][x], m->order.at[1][y], m->order.at[2][z]};
                uint32_t block = (at[2] * n[1] + at[1]) * n[0] + at[0];
                if (draft_has_block(draft, block) && shows_block(m, at) && !add_block(m, at, draft_dense_block(draft, block))) {
                    return false;
                }
            }
        }
    }
    return true;
}

static bool same(aset_vec3 a, aset_vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Are the beams of this very draft, eye and picture already? */
static bool is_of(const aset_beams *b, const drawing *d) {
    const aset_draft *draft = d->tracer->draft;
    const camera *eye = &d->eye;
    return b->words == draft->words && b->check == draft->words[WORD_CHECK] && same(b->eye[0], eye->from) &&
           same(b->eye[1], eye->forward) && same(b->eye[2], eye->right) && same(b->eye[3], eye->down) &&
           b->parallel == eye->orthographic && b->width == d->picture->width && b->height == d->picture->height &&
           b->samples == d->samples && b->corner == d->corner;
}

/* Does a voxel in the box's middle cover LEAST_PIXELS? Few rays of a beam meet the same voxel if it covers less. */
static bool has_large_voxels(aset_outlook *o, const outlook_cells *cells, const aset_picture *picture) {
    aset_outlook_set_voxels(o, cells, 0);
    outlook_rectangle r = outlook_of(o, vec_sub(cells->middle, o->from), 1);
    aset_real columns = (r.right - r.left) / 2 * (aset_real)(int32_t)picture->width;
    aset_real rows = (r.bottom - r.top) / 2 * (aset_real)(int32_t)picture->height;
    return columns * rows >= LEAST_PIXELS;
}

static bool begin(aset_beams *beams, const drawing *d) {
    const aset_draft *draft = d->tracer->draft;
    const camera *eye = &d->eye;
    if (is_of(beams, d)) {
        return beams->can_see;
    }
    outlook_cells cells = aset_outlook_cells_of(draft);
    aset_outlook outlook;
    aset_outlook_set_camera(&outlook, eye);
    beams->band = beams->segment = NONE;
    beams->rows = BAND_MOST;
    beams->n_voxels = beams->capacity; /* nothing is known of any band: begin with a low one */
    beams->words = draft->words;
    beams->check = draft->words[WORD_CHECK];
    beams->eye[0] = eye->from;
    beams->eye[1] = eye->forward;
    beams->eye[2] = eye->right;
    beams->eye[3] = eye->down;
    beams->parallel = eye->orthographic;
    beams->width = d->picture->width;
    beams->height = d->picture->height;
    beams->samples = d->samples;
    beams->corner = d->corner;
    beams->can_see = draft->n_facets > 0 && aset_outlook_can_see(&outlook, &cells) && has_large_voxels(&outlook, &cells, d->picture);
    return beams->can_see;
}

/* Whether there is likely to be room for a high band: there was for the last one's voxels, or would have been. */
static bool expects_room(const aset_beams *b) {
    uint32_t would_have = b->rows == BAND_MOST ? b->n_voxels : 2 * b->n_voxels;
    return !b->overflow && would_have < b->capacity;
}

/* The band that a row lies in. Whether it is left to single rays, which visit other cells, depends on the low one alone. */
static void make_band(aset_beams *beams, const drawing *d, uint32_t row) {
    band_maker m;
    m.beams = beams;
    m.picture = d;
    m.draft = d->tracer->draft;
    m.cells = aset_outlook_cells_of(m.draft);
    aset_outlook_set_camera(&m.outlook, &d->eye);
    aset_outlook_set_voxels(&m.outlook, &m.cells, 0);
    make_order(&m);
    m.rows = expects_room(beams) ? BAND_MOST : BAND_LEAST;
    beams->overflow = !fill_band(&m, row);
    if (beams->overflow && m.rows == BAND_MOST) {
        m.rows = BAND_LEAST;
        beams->overflow = !fill_band(&m, row);
    }
    beams->band = m.first_row;
    beams->rows = m.rows;
}

/* The band's voxels that some rows of it meet. False: there were too many for the band. */
static bool begin_rows(aset_beams *beams, const drawing *d, uint32_t row, uint32_t n_rows) {
    if (beams->band == NONE || row - beams->band >= beams->rows) {
        make_band(beams, d, row);
    }
    uint32_t in_band = row - beams->band, last = in_band + n_rows - 1, n = 0;
    for (uint32_t i = 0; i < beams->n_voxels; i++) {
        const aset_beam_voxel *v = beams->voxels + i;
        beams->in_row[n] = (uint16_t)i;
        n += (v->top <= last) & (v->bottom >= in_band);
    }
    beams->n_in_row = n;
    beams->segment = NONE;
    return !beams->overflow;
}

/* Of n voxels those that reach into columns from..to; what ends before them leaves the list that it comes from. How many. */
static uint32_t choose_from(uint16_t *restrict chosen, uint16_t *restrict list, uint32_t *n, const aset_beam_voxel *voxels,
                            uint32_t from, uint32_t to) {
    uint32_t n_chosen = 0, n_left = 0;
    for (uint32_t i = 0; i < *n; i++) {
        uint16_t index = list[i];
        uint32_t left = voxels[index].left, reaches = voxels[index].right >= from;
        list[n_left] = chosen[n_chosen] = index;
        n_left += reaches;
        n_chosen += (left <= to) & reaches;
    }
    *n = n_left;
    return n_chosen;
}

/* Chooses the voxels before the pixels from column on, a multiple of width; columns come in ascending order. False: there are none. */
static bool choose(aset_beams *beams, uint32_t column, uint32_t width) {
    if (beams->segment != column / SEGMENT) {
        uint32_t from = column / SEGMENT * SEGMENT;
        beams->n_in_segment =
            choose_from(beams->in_segment, beams->in_row, &beams->n_in_row, beams->voxels, from, from + SEGMENT - 1);
        beams->segment = column / SEGMENT;
    }
    beams->n_chosen =
        choose_from(beams->chosen, beams->in_segment, &beams->n_in_segment, beams->voxels, column, column + width - 1);
    return beams->n_chosen > 0;
}

/* Directions from a perspective eye, of unit length: aset_camera_ray's arithmetic. False: some are too long or short before. */
static bool look_through(aset_real (*restrict directions)[DRAFT_BEAM], const camera *restrict eye, const aset_real *restrict x,
                         const aset_real *restrict y) {
    aset_real length[DRAFT_BEAM];
    aset_vec3 forward = eye->forward, right = eye->right, down = eye->down;
    EACH_RAY(i) {
        directions[0][i] = forward.x + (right.x * x[i] + y[i] * down.x);
        directions[1][i] = forward.y + (right.y * x[i] + y[i] * down.y);
        directions[2][i] = forward.z + (right.z * x[i] + y[i] * down.z);
    }
    bool usual = draft_lane_lengths(length, directions) == 0;
    draft_lanes_divide(directions, length);
    return usual;
}

/* The rays of sample (i, j) of the beam's pixels; those beyond the n that there are repeat the first. */
static void make_rays(beam_rays *rays, const drawing *d, uint32_t column, uint32_t row, uint32_t width, uint32_t n, uint32_t i,
                      uint32_t j) {
    aset_real x[DRAFT_BEAM], y[DRAFT_BEAM];
    for (uint32_t k = 0; k < BEAM_RAYS; k++) {
        uint32_t pixel = k < n ? k : 0;
        x[k] = drawing_place(d, column + pixel % width, i, d->picture->width);
        y[k] = drawing_place(d, row + pixel / width, j, d->picture->height);
    }
    bool known = !d->eye.orthographic && look_through(rays->directions, &d->eye, x, y);
    for (uint32_t k = 0; k < BEAM_RAYS; k++) {
        aset_vec3 origin = d->eye.from, direction;
        if (!known) {
            aset_camera_ray(&d->eye, x[k], y[k], &origin, &direction);
            draft_set_lane(rays->directions, k, direction);
        }
        draft_set_lane(rays->origins, k, origin);
    }
}

/* What n rays through the pixels chosen for meet: voxels, and objects that the draft keeps. */
static void meet(beam_rays *rays, query_hit *kept, const aset_beams *beams, uint32_t n, const aset_tracer *tracer,
                 aset_statistics *statistics) {
    bool keeps = tracer->draft->stage.counts.objects > 0;
    for (uint32_t i = 0; i < BEAM_RAYS; i++) {
        rays->ends[i] = REAL_INFINITY;
        if (keeps && i < n) {
            rays->ends[i] = aset_draft_query_kept(&kept[i], tracer->draft, draft_lane(rays->origins, i), draft_lane(rays->directions, i),
                                                  REAL_INFINITY, statistics);
        }
    }
    aset_draft_beam_start(&rays->met, tracer->draft, rays->origins, rays->directions, rays->ends, n);
    for (uint32_t i = 0; i < beams->n_chosen; i++) {
        const aset_beam_voxel *v = beams->voxels + beams->chosen[i];
        const uint32_t at[3] = {v->block[0], v->block[1], v->block[2]};
        if (aset_draft_beam_visit(&rays->met, at, v->dense, v->in_block)) {
            break;
        }
    }
    statistics->cells_visited += rays->met.n_visited;
    statistics->nonempty_visited += rays->met.n_visited;
    for (uint32_t i = 0; i < n; i++) {
        draft_cover *met = &rays->met.cover[i];
        if (tracer->draft->closes_seams && met->n > 0) { /* as it asks itself: of most rays the call is saved */
            draft_counts counts = {0, 0};
            aset_draft_close_seam(met, tracer->draft, draft_lane(rays->origins, i), draft_lane(rays->directions, i), rays->ends[i],
                                  &counts);
            statistics->cells_visited += counts.cells;
            statistics->nonempty_visited += counts.nonempty;
        }
        statistics->approx_hits += met->n > 0;
    }
}

/* Adds the colours of a beam's rays, one after the other. */
static void shade_each(gathered *g, const drawing *d, beam_rays *rays, const query_hit *kept, uint32_t n) {
    for (uint32_t k = 0; k < n; k++) {
        eye_hits hits;
        aset_real cover;
        aset_vec3 origin = draft_lane(rays->origins, k), direction = draft_lane(rays->directions, k);
        hits.n = aset_draft_query_layers(hits.layers, &rays->met.cover[k], origin, rays->ends[k] < REAL_INFINITY ? &kept[k] : NULL);
        aset_colour c = aset_trace_tree(d->tracer, origin, direction, &hits, d->scratch, d->statistics, &cover);
        aset_drawing_gather(&g[k], c, cover);
    }
}

static void group_start(beam_group *group, const drawing *d, uint32_t rows, size_t stride) {
    group->n_beams = 0;
    group->rows = rows;
    group->stride = stride;
    group->shades = false;
#if DRAFT_SHADES_BEAMS
    group->shades = aset_beam_shader_start(&group->of.shader, d);
#endif
    (void)d;
}

static void group_shade(beam_group *group, const drawing *d, beam_rays *rays, uint32_t n, gathered *into) {
#if DRAFT_SHADES_BEAMS
    const beam_sight sight = {&rays->met, rays->origins, rays->directions, n};
    if (group->shades) {
        if (aset_beam_shader_add(&group->of.shader, &sight, into)) {
            return;
        }
        aset_beam_shader_finish(&group->of.shader); /* samples add up in their order */
    }
#endif
    shade_each(into, d, rays, group->of.kept, n);
}

/* Puts the pixels of all beams of the group, which is empty then. */
static void group_finish(beam_group *group, const drawing *d) {
    size_t bytes = aset_format_bytes(d->picture->format);
#if DRAFT_SHADES_BEAMS
    if (group->shades) {
        aset_beam_shader_finish(&group->of.shader);
    }
#endif
    for (uint32_t i = 0; i < group->n_beams; i++) {
        for (uint32_t y = 0, k = 0; y < group->rows; y++) {
            for (uint32_t x = 0; x < group->width[i]; x++, k++) {
                aset_drawing_put(d, &group->pixels[i][k], group->at[i] + y * group->stride + x * bytes);
            }
        }
    }
    group->n_beams = 0;
}

/* n pixels of background: their rays meet nothing. */
static void draw_background(const drawing *d, uint32_t n, unsigned char *at) {
    size_t bytes = aset_format_bytes(d->picture->format);
    gathered g = {{0, 0, 0}, 0};
    for (uint32_t i = 0; i < d->samples * d->samples; i++) {
        aset_drawing_gather(&g, d->tracer->scene->background, 0);
    }
    aset_drawing_put(d, &g, at);
    for (uint32_t done = 1; done < n; done *= 2) {
        memcpy(at + done * bytes, at, (n - done < done ? n - done : done) * bytes);
    }
    d->statistics->primary += (uint64_t)n * d->samples * d->samples;
}

/* The pixels whose rays go in one beam: width of each of the group's rows. */
static void draw_beam(beam_group *group, const aset_beams *beams, const drawing *d, uint32_t column, uint32_t row, uint32_t width,
                      unsigned char *at) {
    beam_rays rays;
    uint32_t n = width * group->rows;
    gathered *pixels = group->pixels[group->n_beams];
    memset(pixels, 0, n * sizeof *pixels);
    group->width[group->n_beams] = width;
    group->at[group->n_beams++] = at;
    for (uint32_t j = 0; j < d->samples; j++) {
        for (uint32_t i = 0; i < d->samples; i++) {
            make_rays(&rays, d, column, row, width, n, i, j);
            meet(&rays, group->of.kept, beams, n, d->tracer, d->statistics);
            group_shade(group, d, &rays, n, pixels);
        }
    }
    if (group->n_beams == BEAM_GROUP) {
        group_finish(group, d);
    }
}

static uint32_t rows_together(uint32_t row, uint32_t n_rows) {
    return DRAFT_BEAM >= 16 && row % 4 == 0 && n_rows >= 4 ? 4 : row % 2 == 0 && n_rows >= 2 ? 2 : 1;
}

/*
 * Beams are as square as can be, which fits voxels' outlines best: of four rows or two if so many are wanted that lie apart in memory, or
 * else of one.
 */
static uint32_t draw_rows(aset_beams *beams, const drawing *d, uint32_t row, uint32_t n_rows, unsigned char *line, size_t stride) {
    size_t bytes = aset_format_bytes(d->picture->format);
    bool alone = d->tracer->draft->stage.counts.objects == 0; /* nothing is met but voxels */
    uint32_t rows = stride >= d->columns * bytes ? rows_together(row, n_rows) : 1, most = BEAM_RAYS / rows;
    beam_group group;
    if (!begin_rows(beams, d, row, rows)) {
        return 0;
    }
    group_start(&group, d, rows, stride);
    for (uint32_t column = 0, empty; column < d->columns;) {
        for (empty = column; empty < d->columns && !choose(beams, empty, most) && alone;) {
            empty += most;
        }
        empty = empty < d->columns ? empty : d->columns;
        for (uint32_t i = 0; i < rows && empty > column; i++) {
            draw_background(d, empty - column, line + i * stride + column * bytes);
        }
        column = empty;
        if (column < d->columns) {
            uint32_t width = d->columns - column < most ? d->columns - column : most;
            draw_beam(&group, beams, d, column, row, width, line + column * bytes);
            column += width;
        }
    }
    group_finish(&group, d);
    return rows;
}

static const struct aset_beam_calls calls = {begin, draw_rows};

aset_status aset_beams_init(aset_beams *beams, uint32_t voxels, aset_arena *arena) {
    if (beams == NULL || arena == NULL || voxels < 1 || voxels > ASET_BEAMS_MAX) {
        return ASET_ERR_ARGUMENT;
    }
    unsigned char *at = aset_arena_alloc(arena, ASET_BYTES_BEAMS(voxels), ASET_CATEGORY_SCRATCH);
    if (at == NULL) {
        return ASET_ERR_NOMEM;
    }
    memset(beams, 0, sizeof *beams);
    beams->calls = &calls;
    beams->voxels = (aset_beam_voxel *)(void *)at;
    beams->in_row = (uint16_t *)(void *)(at + voxels * sizeof *beams->voxels);
    beams->in_segment = beams->in_row + voxels;
    beams->chosen = beams->in_segment + voxels;
    beams->capacity = voxels;
    beams->band = beams->segment = NONE;
    return ASET_OK;
}

#endif
