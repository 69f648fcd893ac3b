/*
 * baker.c - a stream of entities into bins on the sides of cells, none of it kept.
 *
 * A polygon is sampled in the columns of the side that it mostly faces: for each row of columns the places where its edges cross
 * the row's middle are put in order, and the columns whose middle lies between an odd and the next even one are covered. An
 * edge's crossings are computed from its lower to its upper end whichever polygon it belongs to, and a middle on an edge belongs
 * to one side of it: so polygons that share an edge share the columns out, none counts twice and none is lost, concave or
 * not. What is smaller than a column is met in proportion to its area, which is also what it covers in a picture. Spheres
 * and cones come as polygons of about a column.
 *
 * Memory: bins for the blocks between floor and ceiling only, in the order in which they lie in the map. When the bins are full, the
 * ceiling comes down and those above it are thrown away; what was below has missed nothing, so the pass goes on, and the next
 * one begins at the ceiling.
 */
#include "approx/baker.h"

#if ASET_WITH_DRAFTS

#include "scene/entity.h"
#include "scene/shape.h"

/* An object is kept exact if its box's diagonal is at least this part of the scene's. */
#define KEPT_DIAGONAL R(0.25)
/* So that the inverse of a column's size is a number in float, and of a ray's, too. */
#define LEAST_SLACK R(1e-30)
#define AUTO_LONGEST_MAX 128u
#define AUTO_LONGEST_MIN 8u
/* Automatic divisions: bytes of bake for each square of the longest axis' divisions. */
#define AUTO_BYTES_PER_SQUARE 112u
/* What the library takes as coordinates at all; anything else goes the way that refuses it. */
#define COORDINATE_MAX R(1e15)
#define TEXTURES_MAX 2048u

static uint32_t n_all_blocks(const aset_baker *b) {
    return b->blocks[0] * b->blocks[1] * b->blocks[2];
}

/* ---- bins ---- */

static void clear_bins(aset_baker *b) {
    memset(b->keys, 0xff, b->capacity * sizeof *b->keys); /* BIN_EMPTY */
    b->n_bins = 0;
}

static inline uint32_t block_at(const aset_baker *b, uint32_t x, uint32_t y, uint32_t z) {
    return ((z / 4) * b->blocks[1] + y / 4) * b->blocks[0] + x / 4;
}

/* The block that a key's voxel is in. */
static uint32_t block_of(const aset_baker *b, uint32_t key) {
    uint32_t voxel = key / 6;
    return block_at(b, voxel % b->n[0], voxel / b->n[0] % b->n[1], voxel / b->n[0] / b->n[1]);
}

/* Puts a bin where its key's search finds it: at or before its place, all before which is in order. */
static void settle_bin(aset_baker *b, uint32_t slot) {
    uint32_t key = b->keys[slot];
    b->keys[slot] = BIN_EMPTY;
    uint32_t to = baker_slot(b, key);
    b->keys[to] = key;
    if (to != slot) {
        memcpy(baker_bin(b, to), baker_bin(b, slot), b->bin_bytes);
    }
}

/* After some were emptied: every search must find its key again. start: was empty before that, too, so no run of bins crosses it. */
static void settle_bins(aset_baker *b, uint32_t start) {
    for (uint32_t i = 1; i < b->capacity; i++) {
        uint32_t slot = start + i < b->capacity ? start + i : start + i - b->capacity;
        if (b->keys[slot] != BIN_EMPTY) {
            settle_bin(b, slot);
        }
    }
}

/* Parts in which blocks are counted to find a ceiling. */
#define PARTS 256u

/*
 * The highest ceiling below which no more than half of the bins are, and these: found by counting the bins in equal parts of the
 * blocks in question, then in parts of the part where half is passed. One block at least. *empty: a slot that holds no bin.
 */
static uint32_t find_ceiling(const aset_baker *b, uint32_t *kept, uint32_t *empty) {
    uint32_t low = b->floor_block, high = b->ceiling_block, below = 0; /* bins below low */
    for (;;) {
        uint32_t in_part[PARTS] = {0}, size = (high - low + PARTS - 1) / PARTS, part = 0;
        for (uint32_t i = 0; i < b->capacity; i++) {
            if (b->keys[i] == BIN_EMPTY) {
                *empty = i;
                continue;
            }
            uint32_t block = block_of(b, b->keys[i]);
            if (block >= low && block < high) {
                in_part[(block - low) / size]++;
            }
        }
        while (low + size <= high && below + in_part[part] <= b->capacity / 2) {
            below += in_part[part++];
            low += size;
        }
        if (size == 1) {
            bool is_first = low == b->floor_block; /* one block is more than half: it alone, then */
            *kept = below + (is_first ? in_part[part] : 0);
            return low + is_first;
        }
        high = low + size < high ? low + size : high;
    }
}

/* Lowers the ceiling until half of the bins are free. False: one block alone is too much. */
static bool lower_ceiling(aset_baker *b) {
    uint32_t empty = 0, kept = 0, low = find_ceiling(b, &kept, &empty);
    if (low >= b->ceiling_block || kept + 1 >= b->capacity - b->capacity / 8) {
        return false;
    }
    b->ceiling_block = low;
    for (uint32_t i = 0; i < b->capacity; i++) {
        if (b->keys[i] != BIN_EMPTY && block_of(b, b->keys[i]) >= low) {
            b->keys[i] = BIN_EMPTY;
        }
    }
    settle_bins(b, empty);
    b->n_bins = kept;
    memset(b->marks + low, 0, (n_all_blocks(b) - low) * sizeof *b->marks);
    return true;
}

/* The bin of a key, made if there is none; NULL: it lies above the ceiling by now, or there is no room at all. */
static bin *find_bin(aset_baker *b, uint32_t key) {
    uint32_t slot = baker_slot(b, key);
    if (b->keys[slot] == key) {
        return baker_bin(b, slot);
    }
    if (b->n_bins >= b->capacity - b->capacity / 8) {
        if (!lower_ceiling(b)) {
            b->failure = ASET_ERR_NOMEM;
            return NULL;
        }
        if (block_of(b, key) >= b->ceiling_block) {
            return NULL;
        }
        slot = baker_slot(b, key);
    }
    bin *it = baker_bin(b, slot);
    memset(it, 0, b->bin_bytes);
    b->keys[slot] = key;
    b->n_bins++;
    uint32_t voxel = key / 6, x = voxel % b->n[0], y = voxel / b->n[0] % b->n[1], z = voxel / b->n[0] / b->n[1];
    b->marks[block_at(b, x, y, z)] |= UINT64_C(1) << (x % 4 + 4 * (y % 4) + 16 * (z % 4));
    return it;
}

/* ---- polygons into samples ---- */

/* A polygon's plane over the columns (u, v) of the side that it faces. */
typedef struct sheet {
    int a, u, v;
    const aset_real *normal, *corner; /* its normal, a point of it */
    aset_real at_u, at_v, at_a, slope_u, slope_v; /* the same point, its slopes */
    int64_t unit_u, unit_v;                       /* the slopes in units */
    uint32_t key_side;
    bin *last; /* of the sample before */
    uint32_t last_key, last_ceiling;
    bool seen; /* a middle was met, and what follows from normal and corner is there */
} sheet;

/* One column's middle. */
static void add_sample(aset_baker *b, sheet *s, int32_t i, int32_t j) {
    aset_real du = (aset_real)i + R(0.5) - s->at_u, dv = (aset_real)j + R(0.5) - s->at_v;
    aset_real height = s->at_a + s->slope_u * du + s->slope_v * dv, top = (aset_real)b->n[s->a] * 4;
    uint32_t at[3];
    height = height > 0 ? (height < top ? height : top) : 0;
    uint32_t k = (uint32_t)height / 4;
    at[s->u] = (uint32_t)i / 4;
    at[s->v] = (uint32_t)j / 4;
    at[s->a] = k < b->n[s->a] ? k : b->n[s->a] - 1;
    uint32_t key = ((at[2] * b->n[1] + at[1]) * b->n[0] + at[0]) * 6 + s->key_side;
    if (key != s->last_key || s->last_ceiling != b->ceiling_block) { /* bins move with the ceiling */
        uint32_t block = block_at(b, at[0], at[1], at[2]);
        bool is_ours = block >= b->floor_block && block < b->ceiling_block;
        s->last = is_ours ? find_bin(b, key) : NULL;
        s->last_key = key;
        s->last_ceiling = b->ceiling_block;
    }
    if (s->last == NULL) {
        return;
    }
    bin *it = s->last;
    if (it->n == SAMPLES_MAX) {
        b->failure = ASET_ERR_LIMIT;
        return;
    }
    it->footprint |= 1u << ((i & 3) + 4 * (j & 3));
    it->n++;
    it->columns_u += (uint32_t)i & 3u;
    it->columns_v += (uint32_t)j & 3u;
    it->height += (int64_t)((height - (aset_real)at[s->a] * 4) * BIN_UNIT);
    it->slope_u += s->unit_u;
    it->slope_v += s->unit_v;
    if (!b->single) {
        for (int p = 0; p < TEXTURE_PARTS; p++) {
            it->parts[p] += b->parts[p];
        }
    }
}

static int64_t to_units(aset_real slope) {
    slope = slope > -1 ? (slope < 1 ? slope : 1) : -1; /* or no number, if the source gives others than it measured */
    return (int64_t)(slope * BIN_UNIT + (slope < 0 ? R(-0.5) : R(0.5)));
}

/* The first column whose middle is not below x, or how many there are; x of any size. */
static inline int32_t first_column(aset_real x, uint32_t n) {
    aset_real k = real_min(real_max(x - R(0.5), 0), (aset_real)(int32_t)(n * 4)); /* 0 if it is not a number */
    int32_t below = (int32_t)k;
    return below + ((aset_real)below < k);
}

/* u where the edge from p to q crosses the row's middle, computed the same way from both sides of the edge. */
static inline bool crosses(const aset_real *p, const aset_real *q, int u, int v, aset_real middle, aset_real *at) {
    if ((p[v] <= middle) == (q[v] <= middle)) {
        return false;
    }
    const aset_real *low = p[v] < q[v] ? p : q, *high = p[v] < q[v] ? q : p;
    *at = low[u] + (middle - low[v]) / (high[v] - low[v]) * (high[u] - low[u]);
    return true;
}

/* The plane, when the first middle is met: most sheets meet none. */
static void make_plane(sheet *s) {
    s->slope_u = -s->normal[s->u] / s->normal[s->a];
    s->slope_v = -s->normal[s->v] / s->normal[s->a];
    s->unit_u = to_units(s->slope_u);
    s->unit_v = to_units(s->slope_v);
    s->at_u = s->corner[s->u];
    s->at_v = s->corner[s->v];
    s->at_a = s->corner[s->a];
    s->seen = true;
}

static inline void fill_span(aset_baker *b, sheet *s, aset_real from, aset_real to, int32_t row) {
    int32_t column = first_column(from, b->n[s->u]), end = first_column(to, b->n[s->u]);
    if (column < end && !s->seen) {
        make_plane(s);
    }
    for (; column < end; column++) {
        add_sample(b, s, column, row);
    }
}

/* Rows of a triangle: two edges cross each. */
static void fill_triangle_row(aset_baker *b, sheet *s, const aset_real *points, int32_t row) {
    aset_real middle = (aset_real)row + R(0.5), at[3];
    uint32_t n = 0;
    n += crosses(points, points + 3, s->u, s->v, middle, &at[n]);
    n += crosses(points + 3, points + 6, s->u, s->v, middle, &at[n]);
    n += crosses(points + 6, points, s->u, s->v, middle, &at[n]);
    if (n >= 2) {
        fill_span(b, s, real_min(at[0], at[1]), real_max(at[0], at[1]), row);
    }
}

static void fill_row(aset_baker *b, sheet *s, const aset_real *points, uint32_t n, int32_t row, aset_real *crossings) {
    aset_real middle = (aset_real)row + R(0.5);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; i++) {
        aset_real at;
        if (!crosses(points + 3 * i, points + 3 * (i + 1 < n ? i + 1 : 0), s->u, s->v, middle, &at)) {
            continue;
        }
        uint32_t k = count++;
        for (; k > 0 && crossings[k - 1] > at; k--) {
            crossings[k] = crossings[k - 1];
        }
        crossings[k] = at;
    }
    for (uint32_t i = 0; i + 1 < count; i += 2) {
        fill_span(b, s, crossings[i], crossings[i + 1], row);
    }
}

/* Newell's normal, from the first point so that nothing large cancels. */
static void normal_of(const aset_real *points, uint32_t n, aset_real normal[3]) {
    normal[0] = normal[1] = normal[2] = 0;
    for (uint32_t i = 1; i + 1 < n; i++) {
        aset_real e[3], f[3];
        for (int a = 0; a < 3; a++) {
            e[a] = points[3 * i + (uint32_t)a] - points[a];
            f[a] = points[3 * i + 3 + (uint32_t)a] - points[a];
        }
        normal[0] += e[1] * f[2] - e[2] * f[1];
        normal[1] += e[2] * f[0] - e[0] * f[2];
        normal[2] += e[0] * f[1] - e[1] * f[0];
    }
}

/* A polygon whose columns reach from..to on each axis. */
static void sample_sheet(aset_baker *b, const aset_real *points, uint32_t n, aset_real *crossings, const int32_t from[3],
                         const int32_t to[3]) {
    aset_real normal[3];
    normal_of(points, n, normal);
    sheet s;
    s.a = real_abs(normal[0]) >= real_abs(normal[1]) ? (real_abs(normal[0]) >= real_abs(normal[2]) ? 0 : 2)
                                                     : (real_abs(normal[1]) >= real_abs(normal[2]) ? 1 : 2);
    s.u = s.a < 2 ? s.a + 1 : 0;
    s.v = s.u < 2 ? s.u + 1 : 0;
    if (normal[s.a] == 0 || from[s.u] == to[s.u] || from[s.v] == to[s.v]) {
        return;
    }
    s.normal = normal;
    s.corner = points;
    s.key_side = (uint32_t)s.a * 2 + (normal[s.a] < 0);
    s.last = NULL;
    s.last_key = BIN_EMPTY;
    s.last_ceiling = 0;
    s.seen = false;
    for (int32_t row = from[s.v]; row < to[s.v] && b->failure == ASET_OK; row++) {
        if (n == 3) {
            fill_triangle_row(b, &s, points, row);
        } else {
            fill_row(b, &s, points, n, row, crossings);
        }
    }
    b->report.unseen -= s.seen && b->floor_block == 0;
}

/*
 * A polygon in columns. Most of a fine model's triangles hold no column's middle: if their box has none along two axes, no
 * side sees one, and that is found before anything else is computed.
 */
static inline void sample_polygon(aset_baker *b, const aset_real *points, uint32_t n, aset_real *crossings) {
    int32_t from[3], to[3];
    int without = 0;
    for (int a = 0; a < 3; a++) {
        aset_real low = points[a], high = low;
        for (uint32_t i = 1; i < n; i++) {
            low = real_min(low, points[3 * i + (uint32_t)a]);
            high = real_max(high, points[3 * i + (uint32_t)a]);
        }
        from[a] = first_column(low, b->n[a]);
        to[a] = first_column(high, b->n[a]);
        without += from[a] == to[a];
    }
    if (b->floor_block > 0) { /* a further pass: the first has counted those that are unseen */
        uint32_t in_layer = b->blocks[0] * b->blocks[1];
        uint32_t low = (uint32_t)(from[2] > 0 ? from[2] - 1 : 0) / 16, high = (uint32_t)to[2] / 16;
        if ((high + 1) * in_layer <= b->floor_block || low * in_layer >= b->ceiling_block) {
            return;
        }
    }
    b->report.unseen += b->floor_block == 0; /* until it is seen */
    if (without < 2) {
        sample_sheet(b, points, n, crossings, from, to);
    }
}

/* ---- objects ---- */

static inline bool is_kept(const aset_baker *b, aset_vec3 low, aset_vec3 high, uint32_t n_points) {
    aset_vec3 d = vec_sub(high, low);
    return b->n_kept > 0 && n_points <= ASET_KEPT_POINTS_MAX && vec_dot(d, d) >= b->kept_from;
}

/* An object for the cells: its box and its material. */
static void fit(aset_baker *b, aset_vec3 low, aset_vec3 high) {
    bool is_first = b->n_materials == 0;
    b->low = is_first ? low : vec_min(b->low, low);
    b->high = is_first ? high : vec_max(b->high, high);
    if (is_first) {
        b->only = b->material;
        b->n_materials = 1;
    } else if (b->n_materials < 2 && b->is_other && !texture_equal(&b->only, &b->material)) {
        b->n_materials = 2;
    }
    b->is_other = false;
}

/* One of the largest objects so far: its squared diagonal. */
static void remember(aset_baker *b, aset_real diagonal) {
    uint32_t k = b->n_largest > ASET_KEPT_MAX ? ASET_KEPT_MAX : b->n_largest++;
    for (; k > 0 && b->largest[k - 1] < diagonal; k--) {
        b->largest[k] = b->largest[k - 1];
    }
    b->largest[k] = diagonal;
}

/* An object's box in the first pass. */
static void measure(aset_baker *b, aset_vec3 low, aset_vec3 high, uint32_t n_points) {
    aset_vec3 d = vec_sub(high, low);
    aset_real diagonal = vec_dot(d, d);
    b->report.objects++;
    fit(b, low, high);
    b->max_points = n_points > b->max_points ? n_points : b->max_points;
    if (n_points <= ASET_KEPT_POINTS_MAX && (b->n_largest <= ASET_KEPT_MAX || diagonal > b->largest[ASET_KEPT_MAX])) {
        remember(b, diagonal);
    }
}

static inline void to_columns(const aset_baker *b, const aset_real *point, aset_real *column) {
    for (int a = 0; a < 3; a++) {
        column[a] = (point[a] - b->origin[a]) * b->scale[a];
    }
}

#if ASET_WITH_POLYGONS
/* The polygon in hand is whole, in points. */
static void take_polygon(aset_baker *b, uint32_t n) {
    aset_vec3 low = b->counter.outline.low, high = b->counter.outline.high;
    if (b->phase == PHASE_FIT) {
        fit(b, low, high);
    } else if (b->phase == PHASE_BAKE) {
        for (uint32_t i = 0; i < n; i++) {
            aset_real column[3];
            to_columns(b, b->points + 3 * i, column);
            memcpy(b->points + 3 * i, column, sizeof column);
        }
        sample_polygon(b, b->points, n, b->crossings);
    }
}
#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
static void sample_quad(aset_baker *b, aset_vec3 corners[4]) {
    aset_real points[2][9];
    for (int half = 0; half < 2; half++) {
        for (int i = 0; i < 3; i++) {
            aset_vec3 c = corners[i == 0 ? 0 : i + half];
            aset_real point[3] = {c.x, c.y, c.z};
            to_columns(b, point, points[half] + 3 * i);
        }
        sample_polygon(b, points[half], 3, NULL);
    }
}

#define TURN_MAX 192u

/* How many parts a circle of that radius is taken in: edges of about a column, from 12 to TURN_MAX. */
static uint32_t parts_of_turn(const aset_baker *b, aset_real radius) {
    aset_real parts = R(6.2831853) * radius * real_max(b->scale[0], real_max(b->scale[1], b->scale[2]));
    return parts < 12 ? 12 : parts > R(TURN_MAX) ? TURN_MAX : (uint32_t)parts;
}

/* A point's turn by 360 / parts degrees: cosine and sine made of tangents, as the core has no others. */
static void turn_of(uint32_t parts, aset_real *cosine, aset_real *sine) {
    aset_real t = real_tangent_deg(R(180) / (aset_real)parts);
    *cosine = (1 - t * t) / (1 + t * t);
    *sine = 2 * t / (1 + t * t);
}
#endif

#if ASET_WITH_SPHERES
static aset_vec3 on_sphere(aset_vec3 centre, aset_real radius, const aset_real around[2], const aset_real up[2]) {
    return vec(centre.x + radius * up[1] * around[0], centre.y + radius * up[1] * around[1], centre.z + radius * up[0]);
}

static void rotate(aset_real at[2], aset_real cosine, aset_real sine) {
    aset_real x = at[0] * cosine - at[1] * sine;
    at[1] = at[0] * sine + at[1] * cosine;
    at[0] = x;
}

static void sample_sphere(aset_baker *b, aset_vec3 centre, aset_real radius) {
    uint32_t parts = parts_of_turn(b, real_abs(radius)) / 2 * 2;
    aset_real cosine, sine, around[2] = {1, 0};
    turn_of(parts, &cosine, &sine);
    uint64_t unseen = b->report.unseen;
    for (uint32_t i = 0; i < parts; i++) {
        aset_real next[2] = {around[0], around[1]}, up[2] = {1, 0}; /* cosine and sine of the angle from the pole */
        rotate(next, cosine, sine);
        for (uint32_t j = 0; j < parts / 2; j++) {
            aset_real below[2] = {up[0], up[1]};
            rotate(below, cosine, sine);
            aset_vec3 corners[4] = {on_sphere(centre, real_abs(radius), around, up),
                                    on_sphere(centre, real_abs(radius), around, below),
                                    on_sphere(centre, real_abs(radius), next, below),
                                    on_sphere(centre, real_abs(radius), next, up)};
            sample_quad(b, corners);
            up[0] = below[0];
            up[1] = below[1];
        }
        around[0] = next[0];
        around[1] = next[1];
    }
    b->report.unseen = unseen;
}
#endif

#if ASET_WITH_CONES
static void sample_cone(aset_baker *b, aset_vec3 base, aset_real base_radius, aset_vec3 apex, aset_real apex_radius) {
    aset_vec3 axis = vec_unit(vec_sub(apex, base));
    aset_vec3 other = real_abs(axis.x) < R(0.6) ? vec(1, 0, 0) : vec(0, 1, 0);
    aset_vec3 x = vec_unit(vec_cross(other, axis)), y = vec_cross(axis, x);
    aset_real r0 = real_abs(base_radius), r1 = real_abs(apex_radius), cosine, sine;
    uint32_t parts = parts_of_turn(b, real_max(r0, r1));
    turn_of(parts, &cosine, &sine);
    aset_vec3 out = x;
    uint64_t unseen = b->report.unseen;
    for (uint32_t i = 0; i < parts; i++) {
        aset_real along_x = vec_dot(out, x) * cosine - vec_dot(out, y) * sine;
        aset_real along_y = vec_dot(out, x) * sine + vec_dot(out, y) * cosine;
        aset_vec3 next = vec_add(vec_scale(x, along_x), vec_scale(y, along_y));
        aset_vec3 corners[4] = {vec_along(base, r0, out), vec_along(base, r0, next), vec_along(apex, r1, next),
                                vec_along(apex, r1, out)};
        sample_quad(b, corners);
        out = next;
    }
    b->report.unseen = unseen;
}
#endif

/* ---- the sink ---- */

static aset_status take_background(void *context, const aset_colour *colour) {
    aset_baker *b = context;
    return b->stage_sink.background(b->stage_sink.context, colour);
}

static aset_status take_view(void *context, const aset_view *view) {
    aset_baker *b = context;
    return b->stage_sink.view(b->stage_sink.context, view);
}

static aset_status take_light(void *context, const aset_light *light) {
    aset_baker *b = context;
    return b->stage_sink.light(b->stage_sink.context, light);
}

static aset_status take_material(void *context, const aset_material *material) {
    aset_baker *b = context;
    aset_status status = b->stage_sink.material(b->stage_sink.context, material);
    if (status != ASET_OK) {
        return status;
    }
    texture_sum sum;
    memset(&sum, 0, sizeof sum);
    texture_sum_add(&sum, material);
    memcpy(b->parts, sum.parts, sizeof b->parts);
    b->material = *material;
    b->has_material = b->is_other = true;
    return ASET_OK;
}

static aset_status check_material(const aset_baker *b) {
    return b->has_material ? b->failure == ASET_ERR_NOMEM ? ASET_OK : b->failure : ASET_ERR_ARGUMENT;
}

#if ASET_WITH_POLYGONS
static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_baker *b = context;
    aset_status status = outline_begin(&b->counter.outline, n_points, with_normals);
    if (status == ASET_OK) {
        status = check_material(b);
    }
    if (status == ASET_OK && b->phase != PHASE_MEASURE && n_points > b->max_points) {
        status = ASET_ERR_GEOMETRY; /* not the same source as in the first pass */
    }
    b->counter.outline.open = status == ASET_OK;
    return status;
}

static aset_status take_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    aset_baker *b = context;
    uint32_t index = b->counter.outline.n_given;
    aset_status status = outline_point(&b->counter.outline, point, normal);
    if (status == ASET_OK && b->points != NULL) {
        b->points[3 * index] = point->x;
        b->points[3 * index + 1] = point->y;
        b->points[3 * index + 2] = point->z;
    }
    return status;
}

static aset_status keep_polygon(aset_baker *b, uint32_t n) {
    const aset_sink *sink = &b->stage_sink;
    aset_status status = sink->polygon_begin(sink->context, n, false);
    for (uint32_t i = 0; i < n && status == ASET_OK; i++) {
        aset_vec3 point = vec(b->points[3 * i], b->points[3 * i + 1], b->points[3 * i + 2]);
        status = sink->polygon_point(sink->context, &point, NULL);
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
}

static aset_status take_polygon_end(void *context) {
    aset_baker *b = context;
    aset_outline *outline = &b->counter.outline;
    uint32_t n = outline->n_announced;
    aset_status status = outline_end(outline);
    if (status != ASET_OK) {
        return status;
    }
    if (b->phase == PHASE_MEASURE) {
        measure(b, outline->low, outline->high, n);
    } else if (is_kept(b, outline->low, outline->high, n)) {
        return keep_polygon(b, n);
    } else {
        take_polygon(b, n);
    }
    return ASET_OK;
}

/* The way that every sink's triangle goes, for those that need it: refused ones, kept ones. */
static aset_status take_triangle(aset_baker *b, const aset_real *x) {
    aset_sink sink = aset_baker_sink(b);
    aset_vec3 p[3] = {vec(x[0], x[1], x[2]), vec(x[3], x[4], x[5]), vec(x[6], x[7], x[8])};
    return aset_sink_polygon(&sink, p, NULL, 3);
}

static inline void box_of(const aset_real *x, aset_vec3 *low, aset_vec3 *high) {
    *low = vec(real_min(x[0], real_min(x[3], x[6])), real_min(x[1], real_min(x[4], x[7])), real_min(x[2], real_min(x[5], x[8])));
    *high = vec(real_max(x[0], real_max(x[3], x[6])), real_max(x[1], real_max(x[4], x[7])), real_max(x[2], real_max(x[5], x[8])));
}

/* A triangle in the first passes, or one that is to be refused. */
static aset_status measure_triangle(aset_baker *b, const aset_real *x) {
    aset_vec3 low, high;
    box_of(x, &low, &high);
    if (b->phase == PHASE_FIT && !is_kept(b, low, high, 3)) {
        fit(b, low, high);
        return ASET_OK;
    }
    return take_triangle(b, x);
}

/* Triangles looked at together: their box is checked once. */
#define CHUNK 64u

/* n triangles, at most CHUNK, in the first pass. False, and nothing done, if one of them may have to be refused. */
static bool measure_chunk(aset_baker *b, const aset_real *x, size_t n) {
    aset_vec3 low, high;
    aset_real diagonals[CHUNK], sum = 0;
    box_of(x, &low, &high);
    for (size_t i = 0; i < n; i++, x += 9) {
        aset_vec3 from, to;
        box_of(x, &from, &to);
        low = vec_min(low, from);
        high = vec_max(high, to);
        aset_vec3 d = vec_sub(to, from);
        diagonals[i] = vec_dot(d, d);
        sum += x[0] + x[1] + x[2] + x[3] + x[4] + x[5] + x[6] + x[7] + x[8]; /* not finite if any is not */
    }
    if (!(vec_largest(low) <= COORDINATE_MAX && vec_largest(high) <= COORDINATE_MAX && real_finite(sum))) {
        return false;
    }
    fit(b, low, high);
    b->report.objects += n;
    b->max_points = b->max_points > 3 ? b->max_points : 3;
    for (size_t i = 0; i < n; i++) {
        if (b->n_largest <= ASET_KEPT_MAX || diagonals[i] > b->largest[ASET_KEPT_MAX]) {
            remember(b, diagonals[i]);
        }
    }
    return true;
}

static aset_status measure_triangles(aset_baker *b, const aset_real *x, size_t n) {
    aset_status status = ASET_OK;
    while (n > 0 && status == ASET_OK) {
        size_t some = n < CHUNK ? n : CHUNK;
        if (b->phase != PHASE_MEASURE || !measure_chunk(b, x, some)) {
            for (size_t i = 0; i < some && status == ASET_OK; i++) {
                status = measure_triangle(b, x + 9 * i);
            }
        }
        x += 9 * some;
        n -= some;
    }
    return status;
}

aset_status aset_baker_triangles(aset_baker *baker, const aset_real *coordinates, size_t n) {
    if (baker == NULL || (coordinates == NULL && n > 0)) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = check_material(baker);
    if (status != ASET_OK || baker->phase != PHASE_BAKE) {
        return status != ASET_OK ? status : measure_triangles(baker, coordinates, n);
    }
    for (size_t i = 0; i < n && status == ASET_OK; i++, coordinates += 9) {
        aset_real columns[9];
        if (baker->n_kept > 0) {
            aset_vec3 low, high;
            box_of(coordinates, &low, &high);
            if (is_kept(baker, low, high, 3)) {
                status = take_triangle(baker, coordinates);
                continue;
            }
        }
        for (int k = 0; k < 3; k++) {
            to_columns(baker, coordinates + 3 * k, columns + 3 * k);
        }
        sample_polygon(baker, columns, 3, NULL);
    }
    return status;
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_baker *b = context;
    aset_status status = entity_check_sphere(centre, radius);
    status = status == ASET_OK ? check_material(b) : status;
    if (status != ASET_OK) {
        return status;
    }
    aset_vec3 low, high;
    aset_real at[ASET_COORDINATES_SPHERE] = {centre->x, centre->y, centre->z, radius};
    sphere_bounds(at, &low, &high);
    if (b->phase == PHASE_MEASURE) {
        measure(b, low, high, 1);
    } else if (is_kept(b, low, high, 1)) {
        return b->stage_sink.sphere(b->stage_sink.context, centre, radius);
    } else if (b->phase == PHASE_FIT) {
        fit(b, low, high);
    } else {
        sample_sphere(b, *centre, radius);
    }
    return ASET_OK;
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    aset_baker *b = context;
    aset_status status = entity_check_cone(base, base_radius, apex, apex_radius);
    status = status == ASET_OK ? check_material(b) : status;
    if (status != ASET_OK) {
        return status;
    }
    aset_vec3 low, high;
    aset_real at[ASET_COORDINATES_CONE] = {base->x, base->y, base->z, base_radius, apex->x, apex->y, apex->z, apex_radius};
    cone_bounds(at, &low, &high);
    if (b->phase == PHASE_MEASURE) {
        measure(b, low, high, 1);
    } else if (is_kept(b, low, high, 1)) {
        return b->stage_sink.cone(b->stage_sink.context, base, base_radius, apex, apex_radius);
    } else if (b->phase == PHASE_FIT) {
        fit(b, low, high);
    } else {
        sample_cone(b, *base, base_radius, *apex, apex_radius);
    }
    return ASET_OK;
}
#endif

aset_sink aset_baker_sink(aset_baker *baker) {
    aset_sink sink;
    sink.context = baker;
    sink.background = take_background;
    sink.view = take_view;
    sink.light = take_light;
    sink.material = take_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = take_polygon_begin;
    sink.polygon_point = take_polygon_point;
    sink.polygon_end = take_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = take_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = take_cone;
#endif
    return sink;
}

/* ---- passes ---- */

/*
 * Which objects are kept: the largest, no more than ASET_KEPT_MAX, and of equally large ones all or none, so that their order
 * does not matter.
 */
static void choose_kept(aset_baker *b) {
    aset_vec3 d = vec_sub(b->high, b->low);
    aset_real least = KEPT_DIAGONAL * KEPT_DIAGONAL * vec_dot(d, d);
    uint32_t n = 0;
    for (uint32_t i = 1; i <= b->n_largest && i <= ASET_KEPT_MAX && b->largest[i - 1] >= least; i++) {
        if (i == b->n_largest || b->largest[i] < b->largest[i - 1]) {
            n = i;
        }
    }
    b->n_kept = b->options.keep_none ? 0 : n;
    b->kept_from = n > 0 ? b->largest[n - 1] : 0;
}

static void choose_divisions(aset_baker *b, size_t bytes, uint32_t longest_max) {
    aset_vec3 extent = vec_sub(b->high, b->low);
    uint32_t longest = AUTO_LONGEST_MIN;
    if (b->options.divisions[0] > 0) {
        memcpy(b->n, b->options.divisions, sizeof b->n);
        return;
    }
    while (longest + 4 <= longest_max && (uint64_t)(longest + 4) * (longest + 4) * AUTO_BYTES_PER_SQUARE <= bytes) {
        longest += 4;
    }
    for (int a = 0; a < 3; a++) {
        aset_real share = vec_largest(extent) > 0 ? vec_at(&extent, a) / vec_largest(extent) : 1;
        b->n[a] = (uint32_t)(share * (aset_real)longest + R(0.999));
        b->n[a] = b->n[a] > 0 ? b->n[a] : 1;
    }
}

/* The box of what the cells hold, a little larger, in numbers that the words can say. */
static void place_cells(aset_baker *b) {
    aset_vec3 low = b->low, high = b->high;
    if (b->n_materials == 0) { /* all objects are kept */
        low = high = vec(0, 0, 0);
    }
    aset_vec3 extent = vec_sub(high, low);
    aset_real slack = R(1e-3) * vec_largest(extent) + 16 * REAL_UNIT * real_max(vec_largest(low), vec_largest(high));
    slack = slack > LEAST_SLACK ? slack : vec_largest(extent) > 0 ? LEAST_SLACK : 1;
    for (int a = 0; a < 3; a++) {
        aset_real grown = vec_at(&extent, a) + 2 * slack / 16;
        b->origin[a] = float_of_word(word_of_float(vec_at(&low, a) - slack / 16));
        b->size[a] = float_of_word(word_of_float(grown / (aset_real)(4 * b->n[a])));
        b->scale[a] = 1 / b->size[a];
        b->blocks[a] = (b->n[a] + 3) / 4;
    }
}

static size_t fixed_bytes(const aset_baker *b) {
    return ASET_ROUND((size_t)b->max_points * 3 * sizeof *b->points) + ASET_ROUND((size_t)b->max_points * sizeof *b->crossings) +
           (size_t)n_all_blocks(b) * sizeof *b->marks + ASET_ROUND(b->texture_capacity * sizeof *b->textures);
}

/* Cuts the region up; the bins of a pass take what the raw facets leave. */
static void cut_region(aset_baker *b) {
    unsigned char *at = b->region;
    b->points = (aset_real *)(void *)at;
    at += ASET_ROUND((size_t)b->max_points * 3 * sizeof *b->points);
    b->crossings = (aset_real *)(void *)at;
    at += ASET_ROUND((size_t)b->max_points * sizeof *b->crossings);
    b->marks = (uint64_t *)(void *)at;
    at += (size_t)n_all_blocks(b) * sizeof *b->marks;
    b->textures = (aset_material *)(void *)at;
    at += ASET_ROUND(b->texture_capacity * sizeof *b->textures);
    b->after = at;
    b->raw = (uint64_t *)(void *)(b->region + b->region_bytes);
    memset(b->marks, 0, (size_t)n_all_blocks(b) * sizeof *b->marks);
}

/* A key, a bin, and the raw facet that it may become. */
#define BYTES_PER_BIN(b) (sizeof *(b)->keys + (b)->bin_bytes + sizeof *(b)->raw)
/* The fewest bins worth a pass. */
#define BINS_MIN 64u

static bool start_pass(aset_baker *b) {
    size_t left = (size_t)((unsigned char *)(b->raw - b->n_raw) - b->after);
    size_t capacity = left / BYTES_PER_BIN(b);
    b->capacity = capacity < UINT32_MAX / 2 ? (uint32_t)capacity : UINT32_MAX / 2;
    b->ceiling_block = n_all_blocks(b);
    if (b->capacity <= BINS_MIN) {
        return false;
    }
    b->capacity--; /* for the rounding of the keys */
    b->keys = (uint32_t *)(void *)b->after;
    b->bins = b->after + ASET_ROUND(b->capacity * sizeof *b->keys);
    clear_bins(b);
    if (b->floor_block == 0) {
        b->report.unseen = 0;
    }
    return true;
}

/* A region of need bytes would have done; there is none now. */
static aset_status give_up(aset_baker *b, size_t need) {
    size_t left = b->arena->size - b->arena->used;
    b->arena->missing = need > left ? need - left : 1;
    b->phase = PHASE_FAILED;
    aset_arena_release(b->arena, &b->mark);
    return ASET_ERR_NOMEM;
}

/* Memory for one block in which every side is marked. */
static size_t need_at_most(const aset_baker *b) {
    size_t sides = 64 * 6;
    return fixed_bytes(b) + (sides + sides / 4 + 2 * BINS_MIN) * BYTES_PER_BIN(b) +
           (size_t)b->n_counted * sizeof *b->raw;
}

/* The most bytes that the region may take. */
static size_t room_for_region(const aset_baker *b) {
    size_t left = b->arena->size - b->arena->used, taken = b->arena->used - b->mark.used, most = b->options.bytes;
    most = most > taken ? most - taken : 0;
    return (b->options.bytes > 0 && most < left ? most : left) / ASET_ALIGN * ASET_ALIGN;
}

/* The region, and in it everything for the divisions; wanted: its bytes, 0 for as many as usual. */
static aset_status start_baking(aset_baker *b, size_t wanted, uint32_t longest_max) {
    size_t room = room_for_region(b);
    b->single = b->n_materials <= 1;
    b->bin_bytes = ASET_ROUND(b->single ? BIN_BYTES_SINGLE : sizeof(bin));
    b->texture_capacity = b->single ? 1 : TEXTURES_MAX;
    choose_divisions(b, room, longest_max);
    place_cells(b);
    if (wanted == 0) {
        wanted = b->options.bytes > 0 ? room : ASET_BYTES_BAKE(b->n[0], b->n[1], b->n[2]);
    }
    b->region_bytes = wanted < room ? wanted / ASET_ALIGN * ASET_ALIGN : room;
    while (!b->single && b->texture_capacity > 64 && fixed_bytes(b) > b->region_bytes / 4) {
        b->texture_capacity /= 2;
    }
    b->n_raw = 0;
    b->n_counted = 0;
    b->n_textures = 0;
    b->floor_block = 0;
    b->counting = false;
    b->failure = ASET_OK;
    b->report.voxels = b->report.merged = 0;
    if (b->region_bytes < fixed_bytes(b) + 2 * BINS_MIN * BYTES_PER_BIN(b)) {
        b->region_bytes = 0;
        return give_up(b, need_at_most(b));
    }
    b->region = aset_arena_alloc(b->arena, b->region_bytes, ASET_CATEGORY_SCRATCH);
    cut_region(b);
    (void)start_pass(b);
    b->phase = PHASE_BAKE;
    return ASET_OK;
}

static void free_region(aset_baker *b) {
    b->arena->used -= b->region_bytes; /* it was taken last */
    b->arena->used_by[ASET_CATEGORY_SCRATCH] -= b->region_bytes;
}

/* The region was too small: once more with a larger one, or coarser if the divisions are ours to choose. */
static aset_status bake_again(aset_baker *b, size_t need) {
    uint32_t longest = b->n[0] > b->n[1] ? b->n[0] : b->n[1];
    longest = longest > b->n[2] ? longest : b->n[2];
    size_t had = b->region_bytes;
    bool is_auto = b->options.divisions[0] == 0;
    free_region(b);
    size_t room = room_for_region(b);
    b->stage_sink = aset_counter_sink(&b->counter);
    if (had < room) {
        return start_baking(b, had / 4 * 5 < room ? had / 4 * 5 : room, longest);
    }
    if (is_auto && longest > AUTO_LONGEST_MIN) {
        return start_baking(b, 0, longest * 3 / 4 > AUTO_LONGEST_MIN ? longest * 3 / 4 : AUTO_LONGEST_MIN);
    }
    return give_up(b, need);
}

/* The stage takes its memory when all its counts are known; its entities come with the next pass. */
static aset_status start_stage(aset_baker *b) {
    b->report.kept = b->counter.counts.objects;
    if (b->report.kept != b->n_kept) {
        return ASET_ERR_GEOMETRY; /* not the same source as in the first pass */
    }
    aset_status status = aset_scene_init(&b->stage, b->arena, &b->counter.counts);
    if (status == ASET_OK) {
        b->stage_sink = aset_scene_sink(&b->stage);
        status = start_baking(b, 0, AUTO_LONGEST_MAX);
    }
    return status;
}

/* After the first pass. */
static aset_status end_measuring(aset_baker *b) {
    if (b->report.objects == 0) {
        b->phase = PHASE_FAILED;
        return ASET_ERR_GEOMETRY;
    }
    choose_kept(b);
    if (b->n_kept == 0) {
        return start_stage(b);
    }
    size_t bytes = ASET_KEPT_POINTS_MAX * 3 * sizeof *b->points; /* while fitting, kept polygons are counted only */
    bytes = bytes > (size_t)b->max_points * 3 * sizeof *b->points ? bytes : (size_t)b->max_points * 3 * sizeof *b->points;
    b->points = aset_arena_alloc(b->arena, bytes, ASET_CATEGORY_SCRATCH);
    if (b->points == NULL) {
        b->phase = PHASE_FAILED;
        return ASET_ERR_NOMEM;
    }
    b->phase = PHASE_FIT;
    b->n_materials = 0;
    b->is_other = true;
    b->stage_sink = aset_counter_sink(&b->counter);
    return ASET_OK;
}

static aset_status end_baking(aset_baker *b) {
    if (b->failure == ASET_ERR_NOMEM) {
        return bake_again(b, need_at_most(b));
    }
    if (b->failure != ASET_OK) {
        return b->failure;
    }
    baker_harvest(b);
    b->floor_block = b->ceiling_block;
    b->stage_sink = aset_counter_sink(&b->counter); /* the stage has its entities: further ones go nowhere */
    if (b->floor_block == n_all_blocks(b)) {
        size_t work = baker_words_bound(b, b->n_counted), bins = need_at_most(b);
        if (b->counting) {
            return bake_again(b, work > bins ? work : bins);
        }
        if (baker_write(b) != ASET_OK) {
            return bake_again(b, work);
        }
        b->phase = PHASE_DONE;
        return ASET_OK;
    }
    if (!start_pass(b)) {
        b->counting = true; /* no room for more facets: they are counted, to tell the need */
        b->n_raw = 0;
        (void)start_pass(b);
    }
    return ASET_OK;
}

aset_status aset_baker_init(aset_baker *baker, aset_arena *arena, const aset_bake_options *options) {
    if (baker == NULL || arena == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    memset(baker, 0, sizeof *baker);
    if (options != NULL) {
        baker->options = *options;
        bool is_auto = options->divisions[0] == 0 && options->divisions[1] == 0 && options->divisions[2] == 0;
        for (int a = 0; a < 3 && !is_auto; a++) {
            if (options->divisions[a] < 1 || options->divisions[a] > ASET_BAKE_DIVISIONS_MAX) {
                return ASET_ERR_ARGUMENT;
            }
        }
    }
    baker->arena = arena;
    baker->mark = aset_arena_mark(arena);
    baker->phase = PHASE_MEASURE;
    baker->stage_sink = aset_counter_sink(&baker->counter);
    return ASET_OK;
}

aset_status aset_baker_pass(aset_baker *baker, bool *again) {
    aset_status status = ASET_ERR_ARGUMENT;
    if (baker == NULL || again == NULL) {
        return status;
    }
    baker->counter.outline.open = false;
    switch (baker->phase) {
    case PHASE_MEASURE: status = end_measuring(baker); break;
    case PHASE_FIT:
        aset_arena_release(baker->arena, &baker->mark);
        baker->points = NULL;
        status = start_stage(baker);
        break;
    case PHASE_BAKE: status = end_baking(baker); break;
    default: *again = false; return status; /* whatever it had is no longer ours to release */
    }
    baker->report.passes++;
    if (status != ASET_OK) {
        aset_arena_release(baker->arena, &baker->mark);
        baker->phase = PHASE_FAILED;
    }
    if (baker->phase == PHASE_FAILED || baker->phase == PHASE_DONE) {
        baker->failure = ASET_ERR_ARGUMENT; /* of every entity that still comes */
    }
    *again = status == ASET_OK && baker->phase != PHASE_DONE;
    return status;
}

#endif
