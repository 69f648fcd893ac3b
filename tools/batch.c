/*
 * batch.c - entities on their way from a reader to a sink, held back a few hundred at a time so that a clock is read twice
 * for each batch and not for each triangle.
 *
 * Records stand one behind the other in a buffer of fixed size: a head, then what the entity consists of. Consecutive
 * triangles share a head and are an array of coordinates. A polygon's points are records like any other, so that a polygon
 * may be larger than the buffer.
 */
#include "prepare.h"

#include <string.h>

typedef enum kind {
    KIND_BACKGROUND,
    KIND_VIEW,
    KIND_LIGHT,
    KIND_MATERIAL,
    KIND_TRIANGLES,
    KIND_BEGIN,
    KIND_POINT,
    KIND_END,
    KIND_SPHERE,
    KIND_CONE
} kind;

/* What stands behind it is bytes long, and the next head begins at a multiple of ALIGNED. */
typedef struct head {
    uint32_t kind, bytes;
} head;

#define ALIGNED sizeof(double)
#define ROUNDED(size) (((size) + ALIGNED - 1) / ALIGNED * ALIGNED)
#define NO_RUN SIZE_MAX

typedef struct begin {
    uint32_t n_points;
    bool with_normals;
} begin;

typedef struct point {
    aset_vec3 point, normal;
    bool has_normal;
} point;

#if ASET_WITH_SPHERES
typedef struct sphere {
    aset_vec3 centre;
    aset_real radius;
} sphere;
#endif

#if ASET_WITH_CONES
typedef struct cone {
    aset_vec3 base, apex;
    aset_real base_radius, apex_radius;
} cone;
#endif

/* ---- out of the buffer ---- */

#if ASET_WITH_POLYGONS
static aset_status give_triangles(const tool_batch *batch, const aset_real *coordinates, size_t n) {
    aset_status status = ASET_OK;
    if (batch->baker != NULL) {
        return aset_baker_triangles(batch->baker, coordinates, n);
    }
    for (size_t i = 0; i < n && status == ASET_OK; i++, coordinates += 9) {
        aset_vec3 points[3];
        for (int k = 0; k < 3; k++) {
            points[k] = (aset_vec3){coordinates[3 * k], coordinates[3 * k + 1], coordinates[3 * k + 2]};
        }
        status = aset_sink_polygon(&batch->target, points, NULL, 3);
    }
    return status;
}
#endif

/* One record; the buffer is aligned for all that stands in it. */
static aset_status give(const tool_batch *batch, const head *h) {
    const aset_sink *to = &batch->target;
    const void *at = h + 1;
    switch ((kind)h->kind) {
    case KIND_BACKGROUND: return to->background(to->context, at);
    case KIND_VIEW: return to->view(to->context, at);
    case KIND_LIGHT: return to->light(to->context, at);
    case KIND_MATERIAL: return to->material(to->context, at);
#if ASET_WITH_POLYGONS
    case KIND_TRIANGLES: return give_triangles(batch, at, h->bytes / sizeof batch->triangle);
    case KIND_BEGIN: return to->polygon_begin(to->context, ((const begin *)at)->n_points, ((const begin *)at)->with_normals);
    case KIND_POINT: {
        const point *p = at;
        return to->polygon_point(to->context, &p->point, p->has_normal ? &p->normal : NULL);
    }
    case KIND_END: return to->polygon_end(to->context);
#endif
#if ASET_WITH_SPHERES
    case KIND_SPHERE: return to->sphere(to->context, &((const sphere *)at)->centre, ((const sphere *)at)->radius);
#endif
#if ASET_WITH_CONES
    case KIND_CONE: {
        const cone *c = at;
        return to->cone(to->context, &c->base, c->base_radius, &c->apex, c->apex_radius);
    }
#endif
    default: return ASET_ERR_UNSUPPORTED;
    }
}

static void flush(tool_batch *batch) {
    double start = tool_seconds();
    for (size_t at = 0; at < batch->used && batch->status == ASET_OK;) {
        const head *h = (const void *)(batch->records.bytes + at);
        batch->status = give(batch, h);
        at += sizeof *h + ROUNDED(h->bytes);
    }
    batch->seconds += tool_seconds() - start;
    batch->used = 0;
    batch->run = NO_RUN;
}

/* ---- into the buffer ---- */

static aset_status put(tool_batch *batch, kind k, const void *bytes, size_t size) {
    head h = {(uint32_t)k, (uint32_t)size};
    if (sizeof h + ROUNDED(size) > TOOL_BATCH_BYTES - batch->used) {
        flush(batch);
    }
    batch->run = k == KIND_TRIANGLES ? batch->used : NO_RUN;
    memcpy(batch->records.bytes + batch->used, &h, sizeof h);
    if (size > 0) {
        memcpy(batch->records.bytes + batch->used + sizeof h, bytes, size);
    }
    batch->used += sizeof h + ROUNDED(size);
    return ASET_OK;
}

static aset_status put_background(void *context, const aset_colour *colour) {
    return put(context, KIND_BACKGROUND, colour, sizeof *colour);
}

static aset_status put_view(void *context, const aset_view *view) {
    return put(context, KIND_VIEW, view, sizeof *view);
}

static aset_status put_light(void *context, const aset_light *light) {
    return put(context, KIND_LIGHT, light, sizeof *light);
}

static aset_status put_material(void *context, const aset_material *material) {
    return put(context, KIND_MATERIAL, material, sizeof *material);
}

#if ASET_WITH_POLYGONS
static aset_status put_begin(void *context, uint32_t n_points, bool with_normals) {
    tool_batch *batch = context;
    begin record;
    batch->is_triangle = n_points == 3 && !with_normals;
    batch->n_points = 0;
    if (batch->is_triangle) {
        return ASET_OK;
    }
    memset(&record, 0, sizeof record);
    record.n_points = n_points;
    record.with_normals = with_normals;
    return put(batch, KIND_BEGIN, &record, sizeof record);
}

static aset_status put_point(void *context, const aset_vec3 *at, const aset_vec3 *normal) {
    tool_batch *batch = context;
    point record;
    if (batch->is_triangle) {
        if (batch->n_points == 3 || normal != NULL) {
            return ASET_ERR_GEOMETRY;
        }
        memcpy(batch->triangle + 3 * batch->n_points++, at, sizeof *at);
        return ASET_OK;
    }
    memset(&record, 0, sizeof record);
    record.point = *at;
    record.has_normal = normal != NULL;
    if (normal != NULL) {
        record.normal = *normal;
    }
    return put(batch, KIND_POINT, &record, sizeof record);
}

/* A triangle joins those before it if there is room, with at most 7 bytes between two batches of them unused. */
static aset_status put_end(void *context) {
    tool_batch *batch = context;
    if (!batch->is_triangle) {
        return put(batch, KIND_END, NULL, 0);
    }
    if (batch->n_points != 3) {
        return ASET_ERR_GEOMETRY;
    }
    head *run = batch->run == NO_RUN ? NULL : (void *)(batch->records.bytes + batch->run);
    size_t end = run == NULL ? 0 : batch->run + sizeof *run + run->bytes;
    if (run == NULL || end + ROUNDED(sizeof batch->triangle) > TOOL_BATCH_BYTES) {
        return put(batch, KIND_TRIANGLES, batch->triangle, sizeof batch->triangle);
    }
    memcpy(batch->records.bytes + end, batch->triangle, sizeof batch->triangle);
    run->bytes += (uint32_t)sizeof batch->triangle;
    batch->used = batch->run + sizeof *run + ROUNDED(run->bytes);
    return ASET_OK;
}
#endif

#if ASET_WITH_SPHERES
static aset_status put_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    sphere record = {*centre, radius};
    return put(context, KIND_SPHERE, &record, sizeof record);
}
#endif

#if ASET_WITH_CONES
static aset_status put_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                            aset_real apex_radius) {
    cone record = {*base, *apex, base_radius, apex_radius};
    return put(context, KIND_CONE, &record, sizeof record);
}
#endif

aset_sink tool_batch_sink(tool_batch *batch, const aset_sink *target, aset_baker *baker) {
    batch->target = target != NULL ? *target : aset_baker_sink(baker);
    batch->baker = baker;
    batch->seconds = 0;
    batch->status = ASET_OK;
    batch->used = 0;
    batch->run = NO_RUN;
    batch->n_points = 0;
    batch->is_triangle = false;
    aset_sink sink;
    sink.context = batch;
    sink.background = put_background;
    sink.view = put_view;
    sink.light = put_light;
    sink.material = put_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = put_begin;
    sink.polygon_point = put_point;
    sink.polygon_end = put_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = put_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = put_cone;
#endif
    return sink;
}

aset_status tool_batch_end(tool_batch *batch) {
    flush(batch);
    return batch->status;
}

/* One reading into the baker. */
static aset_status bake_pass(tool_baking *b, tool_source *source, aset_baker *baker, bool *again) {
    tool_batch batch;
    aset_sink sink = tool_batch_sink(&batch, NULL, baker);
    double start = tool_seconds();
    b->told = !tool_source_read(source, &sink);
    aset_status status = b->told ? ASET_ERR_SYNTAX : tool_batch_end(&batch);
    b->load_s += tool_seconds() - start - batch.seconds;
    start = tool_seconds();
    if (status == ASET_OK) {
        status = aset_baker_pass(baker, again);
    }
    b->build_s += batch.seconds + tool_seconds() - start;
    return status;
}

aset_status tool_bake(tool_baking *baking, tool_source *source, const aset_bake_options *options, aset_arena *arena) {
    aset_baker baker;
    bool again = true;
    memset(baking, 0, sizeof *baking);
    aset_status status = aset_baker_init(&baker, arena, options);
    while (status == ASET_OK && again) {
        status = bake_pass(baking, source, &baker, &again);
    }
    double start = tool_seconds();
    status = status == ASET_OK ? aset_baker_finish(&baking->draft, &baker) : status;
    aset_baker_abandon(&baker);
    baking->build_s += tool_seconds() - start;
    baking->report = baker.report;
    if (status == ASET_ERR_GEOMETRY && baker.report.objects == 0 && baker.report.passes == 1) { /* the pass was ended: nothing was refused */
        tool_error(source->path, 0, "there is no object in it, expected one at least for a draft");
        baking->told = true;
    }
    return status;
}

/* What a scene refuses its reader tells. */
bool tool_bake_tell(tool_source *source, aset_status status) {
    const aset_real most = (aset_real)1e15;
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    if (status != ASET_ERR_GEOMETRY) {
        return false;
    }
    if (!tool_source_read(source, &sink)) {
        return true;
    }
    if (-most <= counter.low.x && -most <= counter.low.y && -most <= counter.low.z && counter.high.x <= most && counter.high.y <= most &&
        counter.high.z <= most) {
        return false;
    }
    tool_error(source->path, 0, "an object reaches beyond 10^15, expected a draft's to lie within");
    return true;
}

/* One reading into the builder. */
static aset_status flat_pass(tool_flat *f, tool_source *source, aset_flat *flat, bool *again) {
    tool_batch batch;
    aset_sink to = aset_flat_sink(flat), sink = tool_batch_sink(&batch, &to, NULL);
    double start = tool_seconds();
    f->told = !tool_source_read(source, &sink);
    aset_status status = f->told ? ASET_ERR_SYNTAX : tool_batch_end(&batch);
    f->load_s += tool_seconds() - start - batch.seconds;
    start = tool_seconds();
    if (status == ASET_OK) {
        status = aset_flat_pass(flat, again);
    }
    f->build_s += batch.seconds + tool_seconds() - start;
    return status;
}

aset_status tool_flatten(tool_flat *flat, tool_source *source, const aset_counter *counter, const aset_method *method,
                         const aset_space_options *options, aset_arena *arena) {
    aset_flat maker;
    bool again = true;
    flat->load_s = flat->build_s = 0;
    flat->told = false;
    aset_status status = aset_flat_init(&maker, arena, counter, method, options);
    while (status == ASET_OK && again) {
        status = flat_pass(flat, source, &maker, &again);
    }
    flat->least = status == ASET_OK ? maker.least : 0;
    return status == ASET_OK ? aset_flat_finish(flat->stage, flat->space, flat->summary, &maker) : status;
}
