/*
 * sheet.c - surfaces into samples.
 *
 * A polygon is sampled in the columns of the side that it mostly faces: for each row of columns the places where its edges cross
 * the row's middle are put in order, and the columns whose middle lies between an odd and the next even one are covered. An
 * edge's crossings are computed from its lower to its upper end whichever polygon it belongs to, and a middle on an edge belongs
 * to one side of it: so polygons that share an edge share the columns out, none counts twice and none is lost, concave or
 * not. What is smaller than a column is met in proportion to its area, which is also what it covers in a picture. Spheres
 * and cones come as polygons of about a column.
 */
#include "approx/sheet.h"

#if ASET_WITH_DRAFTS

/* A polygon's plane over the columns (u, v) of the side that it faces. */
typedef struct sheet {
    int a, u, v;
    const aset_real *normal, *corner; /* its normal, a point of it */
    int32_t from, to;                 /* of its columns on the axis that it faces: it may lie in the one before from, and in to */
    aset_real low, high;              /* so that its heights are between these */
    aset_real at_u, at_v, at_a, slope_u, slope_v; /* the same point, its slopes */
    int64_t unit_u, unit_v;                       /* the slopes in units */
    uint32_t side;
    bool seen; /* a middle was met, and what follows from normal and corner is there */
} sheet;

/* The bin of a voxel's side, NULL if it is not of this pass's blocks; kept as the side's last one, which the next sample mostly wants. */
static bin *find_bin(aset_baker *b, const sheet *s, uint32_t key, uint32_t u, uint32_t v, uint32_t a) {
    uint32_t at[3];
    at[s->u] = u;
    at[s->v] = v;
    at[s->a] = a;
    uint32_t block = baker_block_at(b, at[0], at[1], at[2]);
    bin *it = block >= b->floor_block && block < b->ceiling_block ? aset_bins_find(b, key) : NULL;
    b->recent_keys[s->side] = key; /* finding may have moved all bins, which empties these */
    b->recent[s->side] = it;
    return it;
}

/* One column's middle. */
static void add_sample(aset_baker *b, const sheet *s, int32_t i, int32_t j) {
    aset_real du = (aset_real)i + R(0.5) - s->at_u, dv = (aset_real)j + R(0.5) - s->at_v;
    aset_real height = s->at_a + s->slope_u * du + s->slope_v * dv;
    height = height > s->low ? (height < s->high ? height : s->high) : s->low;
    uint32_t k = (uint32_t)(int32_t)height / 4;
    k -= k == b->n[s->a];
    const uint32_t strides[3] = {6, 6 * b->n[0], 6 * b->n[0] * b->n[1]};
    uint32_t key = (uint32_t)i / 4 * strides[s->u] + (uint32_t)j / 4 * strides[s->v] + s->side + k * strides[s->a];
    bin *it = key == b->recent_keys[s->side] ? b->recent[s->side] : find_bin(b, s, key, (uint32_t)i / 4, (uint32_t)j / 4, k);
    if (it == NULL) {
        return;
    }
    if (it->n == (b->single ? SAMPLES_MAX : SAMPLES_MAX_MIXED)) {
        b->failure = ASET_ERR_LIMIT;
        return;
    }
    it->footprint |= 1u << ((i & 3) + 4 * (j & 3));
    it->n++;
    it->columns_u += (uint32_t)i & 3u;
    it->columns_v += (uint32_t)j & 3u;
    it->height += real_to_whole((height - (aset_real)(int32_t)k * 4) * BIN_UNIT);
    it->slope_u += s->unit_u;
    it->slope_v += s->unit_v;
    if (!b->single) {
        for (int p = 0; p < TEXTURE_PARTS; p++) {
            it->parts[p] += b->parts[p];
        }
    }
}

static int64_t to_units(aset_real slope) {
    slope = real_min(real_max(slope, -1), 1); /* no number, if the source gives others than it measured, becomes -1 */
    return real_to_whole(slope * BIN_UNIT + (R(0.5) - (aset_real)(slope < 0)));
}

/* How many columns there are on an axis. */
static inline aset_real columns_on(const aset_baker *b, int a) {
    return (aset_real)(int32_t)(b->n[a] * 4);
}

/* The first column of n whose middle is not below x, or n; x of any size. */
static inline int32_t first_column(aset_real x, aset_real n) {
    aset_real k = real_min(real_max(x - R(0.5), 0), n); /* 0 if it is not a number */
    int32_t below = (int32_t)k;
    return below + ((aset_real)below < k);
}

/* u where the edge from low to high, which the row's middle lies between, crosses it: not beyond its ends, whatever rounding does. */
static inline aset_real crossing(const aset_real *low, const aset_real *high, int u, int v, aset_real middle) {
    aset_real at = low[u] + (middle - low[v]) / (high[v] - low[v]) * (high[u] - low[u]);
    return real_min(real_max(at, real_min(low[u], high[u])), real_max(low[u], high[u]));
}

/* Whether the edge from p to q crosses the row's middle, and where: computed the same way from both sides of the edge. */
static inline bool crosses(const aset_real *p, const aset_real *q, int u, int v, aset_real middle, aset_real *at) {
    if ((p[v] <= middle) == (q[v] <= middle)) {
        return false;
    }
    *at = p[v] < q[v] ? crossing(p, q, u, v, middle) : crossing(q, p, u, v, middle);
    return true;
}

/* The plane and its extent, when the first middle is met: most sheets meet none. */
static void make_plane(sheet *s, const aset_baker *b) {
    s->low = s->from > 0 ? (aset_real)(s->from - 1) : 0;
    s->high = real_min((aset_real)s->to + R(0.99), columns_on(b, s->a));
    s->slope_u = -s->normal[s->u] / s->normal[s->a];
    s->slope_v = -s->normal[s->v] / s->normal[s->a];
    s->unit_u = to_units(s->slope_u);
    s->unit_v = to_units(s->slope_v);
    s->at_u = s->corner[s->u];
    s->at_v = s->corner[s->v];
    s->at_a = s->corner[s->a];
    s->seen = true;
}

/* Columns that are looked at one by one: the places of a span's ends are longer to find. */
#define FEW_COLUMNS 3

/* The columns whose middles lie between from and to, of those from first to end. */
static inline void fill_span(aset_baker *b, sheet *s, aset_real from, aset_real to, int32_t row, int32_t first, int32_t end) {
    if (end - first > FEW_COLUMNS) {
        int32_t above = first_column(from, columns_on(b, s->u)), below = first_column(to, columns_on(b, s->u));
        first = above > first ? above : first;
        end = below < end ? below : end;
    }
    for (int32_t column = first; column < end; column++) {
        aset_real middle = (aset_real)column + R(0.5);
        if (!(from <= middle && middle < to)) {
            continue;
        }
        if (!s->seen) {
            make_plane(s, b);
        }
        add_sample(b, s, column, row);
    }
}

static void fill_row(aset_baker *b, sheet *s, const aset_real *points, uint32_t n, int32_t row, int32_t first, int32_t end,
                     aset_real *crossings) {
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
        fill_span(b, s, crossings[i], crossings[i + 1], row, first, end);
    }
}

/* The side that a surface faces. False: none. */
static inline bool sheet_begin(sheet *s, const aset_real normal[3], const aset_real *corner) {
    aset_real x = real_abs(normal[0]), y = real_abs(normal[1]), z = real_abs(normal[2]);
    s->a = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    s->u = s->a < 2 ? s->a + 1 : 0;
    s->v = s->u < 2 ? s->u + 1 : 0;
    s->normal = normal;
    s->corner = corner;
    s->side = (uint32_t)s->a * 2 + (normal[s->a] < 0);
    s->seen = false;
    return normal[s->a] != 0;
}

/* The columns upwards that this pass's blocks are among: low to, not including, high. */
typedef struct layers {
    int32_t low, high;
} layers;

static inline layers layers_of_pass(const aset_baker *b) {
    uint32_t in_layer = b->blocks[0] * b->blocks[1];
    layers l = {(int32_t)(b->floor_block / in_layer * 16), (int32_t)((b->ceiling_block - 1) / in_layer * 16 + 16)};
    return l;
}

/*
 * What a further pass has to look at of a surface whose columns reach from..to: of one that goes up through the layers of blocks, the
 * columns in its own layers, and of one that lies, all or nothing. A first pass looks at all, to count those that are unseen.
 * False: nothing.
 */
static bool enters_pass(const aset_baker *b, sheet *s, int32_t from[3], int32_t to[3]) {
    if (b->floor_block == 0) {
        return true;
    }
    layers l = layers_of_pass(b);
    if (s->a != 2) {
        from[2] = from[2] > l.low ? from[2] : l.low;
        to[2] = to[2] < l.high ? to[2] : l.high;
        return true;
    }
    make_plane(s, b);
    aset_real u = real_max(real_abs((aset_real)from[0] - s->at_u), real_abs((aset_real)to[0] - s->at_u));
    aset_real v = real_max(real_abs((aset_real)from[1] - s->at_v), real_abs((aset_real)to[1] - s->at_v));
    aset_real above = s->at_a + real_abs(s->slope_u) * u + real_abs(s->slope_v) * v + 1, below = 2 * s->at_a - above;
    /* what leaves the cells counts in the outermost layers */
    return (l.low == 0 || above >= (aset_real)l.low) && (l.high >= (int32_t)b->n[2] * 4 || below <= (aset_real)l.high);
}

/* Newell's normal, from the first point so that nothing large cancels. */
static aset_vec3 normal_of(const aset_real *points, uint32_t n) {
    aset_vec3 normal = {0, 0, 0};
    for (uint32_t i = 1; i + 1 < n; i++) {
        const aset_real *q = points + 3 * i, *r = q + 3;
        aset_vec3 e = vec(q[0] - points[0], q[1] - points[1], q[2] - points[2]);
        aset_vec3 f = vec(r[0] - points[0], r[1] - points[1], r[2] - points[2]);
        normal = vec_add(normal, vec_cross(e, f));
    }
    return normal;
}

/* A polygon in columns, which reach from..to on each axis. */
static void sample_polygon(aset_baker *b, const aset_real *points, uint32_t n, aset_real *crossings, int32_t from[3],
                           int32_t to[3]) {
    aset_vec3 facing = normal_of(points, n);
    const aset_real normal[3] = {facing.x, facing.y, facing.z};
    sheet s;
    bool faces = sheet_begin(&s, normal, points);
    s.from = 0;
    s.to = INT32_MAX / 2; /* the mean plane of a bent one may leave its box */
    if (faces && enters_pass(b, &s, from, to)) {
        for (int32_t row = from[s.v]; row < to[s.v] && b->failure == ASET_OK; row++) {
            fill_row(b, &s, points, n, row, from[s.u], to[s.u], crossings);
        }
        b->report.unseen -= s.seen && b->floor_block == 0;
    }
}

/* Not for triangles: these take aset_sheet_triangles. */
static void look_at_polygon(aset_baker *b, aset_real *points, uint32_t n, aset_real *crossings) {
    int32_t from[3], to[3];
    for (int a = 0; a < 3; a++) {
        aset_real low = REAL_INFINITY, high = -REAL_INFINITY;
        for (uint32_t i = 0; i < n; i++) {
            aset_real x = (points[3 * i + (uint32_t)a] - b->origin[a]) * b->scale[a];
            points[3 * i + (uint32_t)a] = x;
            low = real_min(low, x);
            high = real_max(high, x);
        }
        from[a] = first_column(low, columns_on(b, a));
        to[a] = first_column(high, columns_on(b, a));
    }
    b->report.unseen += b->floor_block == 0; /* until it is seen */
    if ((from[0] == to[0]) + (from[1] == to[1]) + (from[2] == to[2]) < 2) {
        sample_polygon(b, points, n, crossings, from, to);
    }
}

/* ---- triangles ---- */

typedef struct frame {
    aset_real origin[AXES], scale[AXES], columns[AXES]; /* columns: how many */
} frame;

/* In columns: corners, and the columns whose middles their box holds. */
typedef struct triangle {
    aset_real corners[3][AXES];
    int32_t from[AXES], to[AXES];
} triangle;

static frame frame_of(const aset_baker *b) {
    frame f;
    for (int a = 0; a < AXES; a++) {
        int axis = a % 3;
        f.origin[a] = b->origin[axis];
        f.scale[a] = b->scale[axis];
        f.columns[a] = columns_on(b, axis);
    }
    return f;
}

/* Reads ten numbers. */
static inline triangle place_triangle(const frame *restrict f, const aset_real *restrict points) {
    triangle t;
    aset_real *p = t.corners[0], *q = t.corners[1], *r = t.corners[2];
    for (int a = 0; a < AXES; a++) {
        p[a] = (points[a] - f->origin[a]) * f->scale[a];
        q[a] = (points[a + 3] - f->origin[a]) * f->scale[a];
        r[a] = (points[a + 6] - f->origin[a]) * f->scale[a];
        t.from[a] = first_column(real_min(p[a], real_min(q[a], r[a])), f->columns[a]);
        t.to[a] = first_column(real_max(p[a], real_max(q[a], r[a])), f->columns[a]);
    }
    return t;
}

/*
 * A row of a triangle, whose middle lies between its lowest and its highest corner: so the edges that cross it are both of the corner
 * that lies alone on its side.
 */
static inline void fill_triangle_row(aset_baker *b, sheet *s, const triangle *t, int32_t row) {
    aset_real middle = (aset_real)row + R(0.5);
    const aset_real *p = t->corners[0], *q = t->corners[1], *r = t->corners[2], *alone = p;
    bool p_below = p[s->v] <= middle, q_below = q[s->v] <= middle, up = p_below;
    if (p_below == q_below) {
        alone = r;
        r = p;
        up = !p_below;
    } else if ((r[s->v] <= middle) == p_below) {
        alone = q;
        q = p;
        up = q_below;
    }
    aset_real x, y;
    if (up) {
        x = crossing(alone, q, s->u, s->v, middle);
        y = crossing(alone, r, s->u, s->v, middle);
    } else {
        x = crossing(q, alone, s->u, s->v, middle);
        y = crossing(r, alone, s->u, s->v, middle);
    }
    fill_span(b, s, real_min(x, y), real_max(x, y), row, t->from[s->u], t->to[s->u]);
}

static void sample_triangle(aset_baker *b, triangle *t) {
    const aset_real *p = t->corners[0], *q = t->corners[1], *r = t->corners[2];
    aset_vec3 facing = vec_cross(vec(q[0] - p[0], q[1] - p[1], q[2] - p[2]), vec(r[0] - p[0], r[1] - p[1], r[2] - p[2]));
    const aset_real normal[3] = {facing.x, facing.y, facing.z};
    sheet s;
    bool faces = sheet_begin(&s, normal, p);
    s.from = t->from[s.a]; /* the plane of a sliver, as rounding has it, may lie far beside it */
    s.to = t->to[s.a];
    if (faces && enters_pass(b, &s, t->from, t->to)) {
        for (int32_t row = t->from[s.v]; row < t->to[s.v] && b->failure == ASET_OK; row++) {
            fill_triangle_row(b, &s, t, row);
        }
        b->report.unseen -= s.seen && b->floor_block == 0;
    }
}

/* Is nothing of a triangle in a further pass's layers? Its samples do not leave its box: so that is seen before anything is computed. */
static inline bool is_elsewhere(const aset_baker *b, const triangle *t) {
    if (b->floor_block == 0) {
        return false;
    }
    layers l = layers_of_pass(b);
    return t->to[2] < l.low || t->from[2] > l.high;
}

/*
 * Most of a fine model's triangles hold no column's middle: if their box has none along two axes, no side sees one, and that is found
 * before anything else is computed.
 */
static inline void look_at_triangle(aset_baker *b, const frame *f, const aset_real *points) {
    triangle t = place_triangle(f, points);
    if ((t.from[0] == t.to[0]) + (t.from[1] == t.to[1]) + (t.from[2] == t.to[2]) < 2 && !is_elsewhere(b, &t)) {
        sample_triangle(b, &t);
    }
}

void aset_sheet_triangles(aset_baker *b, const aset_real *points, size_t n) {
    const frame f = frame_of(b);
    b->report.unseen += b->floor_block == 0 ? n : 0; /* until they are seen */
    for (; n > 1; n--, points += 9) {
        look_at_triangle(b, &f, points);
    }
    if (n > 0) {
        aset_real last[10] = {0};
        memcpy(last, points, 9 * sizeof *points);
        look_at_triangle(b, &f, last);
    }
}

void aset_sheet_polygon(aset_baker *b, aset_real *points, uint32_t n, aset_real *crossings) {
    if (n == 3) {
        aset_sheet_triangles(b, points, 1);
    } else {
        look_at_polygon(b, points, n, crossings);
    }
}

#if ASET_WITH_SPHERES || ASET_WITH_CONES
static void sample_quad(aset_baker *b, aset_vec3 corners[4]) {
    const aset_vec3 p = corners[0], q = corners[1], r = corners[2], s = corners[3];
    const aset_real points[18] = {p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z, p.x, p.y, p.z, r.x, r.y, r.z, s.x, s.y, s.z};
    aset_sheet_triangles(b, points, 2);
}

/* An object of n quads is unseen if all their triangles are. unseen: the count before it. */
static void count_unseen(aset_baker *b, uint64_t unseen, uint32_t n) {
    bool none = b->floor_block == 0 && b->report.unseen - unseen == 2 * (uint64_t)n;
    b->report.unseen = unseen + none;
}

#define TURN_MAX 192u

/* How many parts a circle of that radius is taken in: edges of about a column, from 12 to TURN_MAX. */
static uint32_t parts_of_turn(const aset_baker *b, aset_real radius) {
    aset_real parts = R(6.2831853) * radius * real_max(b->scale[0], real_max(b->scale[1], b->scale[2]));
    return parts < 12 ? 12 : parts > R(TURN_MAX) ? TURN_MAX : (uint32_t)parts;
}

/* A point's turn by 360 / parts degrees: cosine and sine made of tangents, as the core has no others. */
static void turn_of(uint32_t parts, aset_real *cosine, aset_real *sine) {
    aset_real t = aset_real_tangent_deg(R(180) / (aset_real)parts);
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

void aset_sheet_sphere(aset_baker *b, aset_vec3 centre, aset_real radius) {
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
    count_unseen(b, unseen, parts * (parts / 2));
}
#endif

#if ASET_WITH_CONES
void aset_sheet_cone(aset_baker *b, aset_vec3 base, aset_real base_radius, aset_vec3 apex, aset_real apex_radius) {
    aset_vec3 axis = aset_vec_unit(vec_sub(apex, base));
    aset_vec3 other = real_abs(axis.x) < R(0.6) ? vec(1, 0, 0) : vec(0, 1, 0);
    aset_vec3 x = aset_vec_unit(vec_cross(other, axis)), y = vec_cross(axis, x);
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
    count_unseen(b, unseen, parts);
}
#endif

#endif
