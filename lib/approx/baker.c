/*
 * baker.c - a stream of entities in: measured in the first pass, fitted in the second if large ones are kept exact, sampled (sheet.c)
 * in the others. None is kept but those.
 */
#include "approx/sheet.h"

#if ASET_WITH_DRAFTS

#include "scene/entity.h"
#include "scene/shape.h"

/* What the cells take as coordinates: so that squares of lengths, in the words' floats too, stay within the range of numbers. */
#define COORDINATE_MAX R(1e15)

#if ASET_WITH_OBJECTS

static aset_status check_box(aset_vec3 low, aset_vec3 high) {
    bool fits = vec_largest(low) <= COORDINATE_MAX && vec_largest(high) <= COORDINATE_MAX;
    return fits ? ASET_OK : ASET_ERR_GEOMETRY;
}

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
    } else if (b->n_materials < 2 && b->is_other && !entity_same_look(&b->only, &b->material)) {
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

#endif

#if ASET_WITH_POLYGONS
/* The polygon in hand is whole, in points. */
static void take_polygon(aset_baker *b, uint32_t n) {
    aset_vec3 low = b->counter.outline.low, high = b->counter.outline.high;
    if (b->phase == PHASE_FIT) {
        fit(b, low, high);
    } else if (b->phase == PHASE_BAKE) {
        aset_sheet_polygon(b, b->points, n, b->crossings);
    }
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
    aset_texture_sum_add(&sum, material);
    memcpy(b->parts, sum.parts, sizeof b->parts);
    b->material = *material;
    b->has_material = b->is_other = true;
    return ASET_OK;
}

#if ASET_WITH_OBJECTS
static aset_status check_material(const aset_baker *b) {
    return b->has_material ? b->failure == ASET_ERR_NOMEM ? ASET_OK : b->failure : ASET_ERR_ARGUMENT;
}
#endif

#if ASET_WITH_POLYGONS
static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_baker *b = context;
    aset_status status = aset_outline_begin(&b->counter.outline, n_points, with_normals);
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
    aset_status status = aset_outline_point(&b->counter.outline, point, normal);
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
    aset_status status = aset_outline_end(outline);
    status = status == ASET_OK ? check_box(outline->low, outline->high) : status;
    if (status != ASET_OK) {
        return status;
    }
    b->taken++;
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
        b->taken++;
        return ASET_OK;
    }
    return take_triangle(b, x);
}

/* Triangles looked at together: their box is checked once. */
#define CHUNK 64u

typedef struct chunk_box {
    aset_real low[AXES], high[AXES], sum[AXES];
} chunk_box;

/* Grows the box by a triangle, of which ten numbers are read; its own extent. */
static inline void grow(chunk_box *restrict box, aset_real *restrict extent, const aset_real *restrict x) {
    for (int a = 0; a < AXES; a++) {
        aset_real low = real_min(x[a], real_min(x[a + 3], x[a + 6])), high = real_max(x[a], real_max(x[a + 3], x[a + 6]));
        box->low[a] = real_min(box->low[a], low);
        box->high[a] = real_max(box->high[a], high);
        box->sum[a] += x[a] + x[a + 3] + x[a + 6]; /* not finite if any is not */
        extent[a] = high - low;
    }
}

/* n triangles, at most CHUNK and others behind them, in the first pass. False, and nothing done, if one may have to be refused. */
static bool measure_chunk(aset_baker *b, const aset_real *x, size_t n) {
    chunk_box box = {{x[0], x[1], x[2]}, {x[0], x[1], x[2]}, {0, 0, 0}};
    aset_real diagonals[CHUNK];
    for (size_t i = 0; i < n; i++) {
        aset_real d[AXES];
        grow(&box, d, x + 9 * i);
        diagonals[i] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    }
    aset_vec3 low = vec(box.low[0], box.low[1], box.low[2]), high = vec(box.high[0], box.high[1], box.high[2]);
    if (check_box(low, high) != ASET_OK || !vec_finite(vec(box.sum[0], box.sum[1], box.sum[2]))) {
        return false;
    }
    fit(b, low, high);
    b->report.objects += n;
    b->taken += n;
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
        size_t some = n <= CHUNK ? n - 1 : CHUNK; /* the last one of all is measured alone */
        if (some == 0 || b->phase != PHASE_MEASURE || !measure_chunk(b, x, some)) {
            some = some > 0 ? some : 1;
            for (size_t i = 0; i < some && status == ASET_OK; i++) {
                status = measure_triangle(b, x + 9 * i);
            }
        }
        x += 9 * some;
        n -= some;
    }
    return status;
}

/* How many triangles come before the first that is kept. */
static size_t first_kept(const aset_baker *b, const aset_real *x, size_t n) {
    for (size_t i = 0; i < n && b->n_kept > 0; i++, x += 9) {
        aset_vec3 low, high;
        box_of(x, &low, &high);
        if (is_kept(b, low, high, 3)) {
            return i;
        }
    }
    return n;
}

aset_status aset_baker_triangles(aset_baker *baker, const aset_real *coordinates, size_t n) {
    if (baker == NULL || (coordinates == NULL && n > 0)) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = check_material(baker);
    baker->counter.outline.open = false; /* a polygon in progress is abandoned, as a scene abandons it */
    if (status != ASET_OK || baker->phase != PHASE_BAKE) {
        return status != ASET_OK ? status : measure_triangles(baker, coordinates, n);
    }
    while (n > 0 && status == ASET_OK) {
        size_t others = first_kept(baker, coordinates, n);
        aset_sheet_triangles(baker, coordinates, others);
        baker->taken += others;
        coordinates += 9 * others;
        n -= others;
        if (n > 0) {
            status = take_triangle(baker, coordinates);
            coordinates += 9;
            n--;
        }
    }
    return status;
}
#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
/* What becomes of an object that comes whole, by its box, if that is fine: is it to be kept, or to be sampled? */
enum { WHOLE_DONE, WHOLE_KEPT, WHOLE_SAMPLED };

static aset_status take_whole(aset_baker *b, aset_vec3 low, aset_vec3 high, int *what) {
    aset_status status = check_material(b);
    status = status == ASET_OK ? check_box(low, high) : status;
    b->counter.outline.open = false; /* a polygon in progress is abandoned, as a scene abandons it */
    *what = WHOLE_DONE;
    if (status != ASET_OK) {
        return status;
    }
    b->taken++;
    if (b->phase == PHASE_MEASURE) {
        measure(b, low, high, 1);
    } else if (is_kept(b, low, high, 1)) {
        *what = WHOLE_KEPT;
    } else if (b->phase == PHASE_FIT) {
        fit(b, low, high);
    } else {
        *what = WHOLE_SAMPLED;
    }
    return ASET_OK;
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_baker *b = context;
    aset_real at[ASET_COORDINATES_SPHERE];
    aset_vec3 low, high;
    int what = WHOLE_DONE;
    aset_status status = aset_entity_sphere(at, &low, &high, centre, radius);
    status = status == ASET_OK ? take_whole(b, low, high, &what) : status;
    if (what == WHOLE_KEPT) {
        return b->stage_sink.sphere(b->stage_sink.context, centre, radius);
    }
    if (what == WHOLE_SAMPLED) {
        aset_sheet_sphere(b, *centre, radius);
    }
    return status;
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    aset_baker *b = context;
    aset_real at[ASET_COORDINATES_CONE];
    aset_vec3 low, high;
    int what = WHOLE_DONE;
    aset_status status = aset_entity_cone(at, &low, &high, base, base_radius, apex, apex_radius);
    status = status == ASET_OK ? take_whole(b, low, high, &what) : status;
    if (what == WHOLE_KEPT) {
        return b->stage_sink.cone(b->stage_sink.context, base, base_radius, apex, apex_radius);
    }
    if (what == WHOLE_SAMPLED) {
        aset_sheet_cone(b, *base, base_radius, *apex, apex_radius);
    }
    return status;
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

#endif
