/*
 * draft_query.c - a draft's answers: the layers that its facets lay over a ray, and before them the objects that it keeps exact.
 */
#include "approx/draft_query.h"

#include "scene/approach.h"

#if ASET_WITH_DRAFTS

static draft_mode mode_of(const aset_tracer *tracer) {
    return tracer->draft_sides ? DRAFT_SIDE : DRAFT_PLANE;
}

#if ASET_WITH_OBJECTS

aset_real aset_draft_query_kept(query_hit *hit, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction,
                                aset_real t_max, aset_statistics *statistics) {
    const aset_scene *stage = &draft->stage;
    probe ray;
    if (stage->counts.objects == 0) {
        return t_max;
    }
    aset_real best = t_max * stage->scale;
    bool found = false;
    aset_real moved = aset_approach_ready(&ray, stage, origin, direction);
    for (uint32_t i = 0; i < stage->counts.objects; i++) {
        aset_real t = aset_object_nearest(stage, i, &ray, best - moved);
        statistics->tests++;
        if (t + moved < best) {
            statistics->test_hits++;
            found = true;
            best = t + moved;
            hit->object = i;
            hit->t_near = t;
        }
    }
    hit->near = probe_origin(&ray);
    hit->t = best;
    hit->scene = stage;
    hit->by = &aset_draft_answers;
    hit->cell = 0;
    hit->curtailed = false;
    if (!found) {
        return t_max;
    }
    answers_to_caller(hit, stage);
    return hit->t;
}

#else

/* aset_draft_open refuses a draft that keeps objects. */
aset_real aset_draft_query_kept(query_hit *hit, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction,
                                aset_real t_max, aset_statistics *statistics) {
    (void)hit, (void)draft, (void)origin, (void)direction, (void)statistics;
    return t_max;
}

#endif

uint32_t aset_draft_query_layers(query_hit *hits, const draft_cover *met, aset_vec3 origin, const query_hit *kept) {
    uint32_t n = met->n;
    for (uint32_t i = 0; i < n; i++) {
        query_hit *hit = hits + i;
        const draft_layer *layer = met->layers + i;
        hit->t = hit->t_near = layer->t;
        hit->near = origin;
        hit->object = ASET_NO_OBJECT;
        hit->cell = layer->facet;
        hit->face = layer->face;
        hit->curtailed = false;
        hit->cover = layer->cover;
        hit->scene = NULL;
        hit->by = &aset_draft_answers;
    }
    if (kept != NULL && met->left > 0) {
        hits[n] = *kept;
        hits[n++].cover = met->left;
    }
    return n;
}

static uint32_t draft_meet(query_hit *hits, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                           bool is_seen, aset_statistics *statistics) {
    draft_layer layers[DRAFT_LAYERS_MAX];
    draft_counts counts = {0, 0};
    query_hit kept;
    aset_real end = aset_draft_query_kept(&kept, tracer->draft, origin, direction, t_max, statistics);
    draft_cover met = aset_draft_layers(layers, tracer->draft, mode_of(tracer), origin, direction, end, &counts);
    if (is_seen && !tracer->draft_sides) { /* what mirrors show is not worth the time */
        aset_draft_close_seam(&met, tracer->draft, origin, direction, end, &counts);
    }
    statistics->cells_visited += counts.cells;
    statistics->nonempty_visited += counts.nonempty;
    statistics->approx_hits += met.n > 0;
    return aset_draft_query_layers(hits, &met, origin, ASET_WITH_OBJECTS && end < t_max ? &kept : NULL);
}

static bool draft_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                      aset_statistics *statistics) {
    draft_counts counts = {0, 0};
    query_hit kept;
    if (aset_draft_query_kept(&kept, tracer->draft, origin, direction, t_max, statistics) < t_max) {
        return true;
    }
    bool blocked = aset_draft_blocks(tracer->draft, mode_of(tracer), origin, direction, t_max, t_last, &counts);
    statistics->cells_visited += counts.cells;
    statistics->nonempty_visited += counts.nonempty;
    statistics->approx_hits += blocked;
    return blocked;
}

static void draft_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit) {
#if ASET_WITH_OBJECTS
    if (hit->object != ASET_NO_OBJECT) {
        aset_object_surface(surface, hit->scene, hit->object);
        return;
    }
#endif
    facet f = facet_read(tracer->draft, hit->cell);
    surface->cell = hit->cell;
    surface->normal = facet_normal(tracer->draft, &f);
    surface->geometric = tracer->draft_sides ? answers_slice_normal(hit->face) : surface->normal;
    *own = aset_draft_material(tracer->draft, f.texture);
    surface->material = own;
}

static aset_real clearance(const aset_tracer *tracer) {
    return aset_draft_clearance(tracer->draft);
}

const struct aset_answers aset_draft_answers = {true, draft_meet, draft_any, draft_surface, clearance};

#endif
