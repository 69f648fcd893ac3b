/*
 * summary_query.c - the approximate consumer of a space's walk: the first cell entered at t > 0 that has a texture is the hit.
 */
#include "approx/summary.h"
#include "scene/approach.h"
#include "space/answers.h"
#include "space/walk.h"

#if ASET_WITH_APPROXIMATION

typedef struct approximate_query {
    walk_request walk;
    aset_real t;
    uint32_t cell;
    int face;
    bool found;
} approximate_query;

static aset_real visit_approximate(walk_request *walk, const walk_cell *cell) {
    approximate_query *q = (approximate_query *)walk;
    q->t = cell->t;
    q->cell = cell->index;
    q->face = cell->face;
    q->found = true;
    return -REAL_INFINITY;
}

/* Is the distance to the cell on the wrong side of the fraction of a voxel's diagonal? */
static bool trapped(const aset_tracer *tracer, aset_real t) {
    const aset_real *w = tracer->space->slices.width;
    if (!(tracer->curtail > 0)) {
        return false;
    }
    if (t > tracer->curtail * R(1.01) * (w[0] + w[1] + w[2])) { /* behind all three sides one after another: most hits */
        return tracer->curtail_more;
    }
    aset_real bound = tracer->curtail * aset_vec_length(vec(w[0], w[1], w[2]));
    return tracer->curtail_more ? t > bound : t < bound;
}

static bool approximate_hit(query_hit *hit, const aset_tracer *tracer, const probe *ray, aset_real moved, aset_real t_max,
                            aset_statistics *statistics) {
    approximate_query q;
    q.walk.visit = visit_approximate;
    q.walk.limit = approach_end(moved, t_max);
    q.walk.wants_references = false;
    q.walk.cells = q.walk.nonempty = 0;
    q.found = false;
    tracer->space->method->go(tracer->space, ray, &q.walk);
    statistics->cells_visited += q.walk.cells;
    statistics->nonempty_visited += (uint32_t)q.walk.nonempty; /* 32 bits: as a pair, both would wait for their stores */
    if (!q.found || !(q.t + moved < t_max)) {
        return false;
    }
    hit->t = q.t;
    hit->cell = q.cell;
    hit->face = q.face;
    hit->object = ASET_NO_OBJECT;
    return true;
}

#if ASET_FUSED
static inline void walk_axis(probe *ray, int a, aset_real origin, aset_real direction) {
    ray->moves[a] = real_abs(direction) > STILL;
    ray->inverse[a] = ray->moves[a] ? 1 / direction : 0;
    ray->origin[a] = origin;
    ray->direction[a] = direction;
}

/* aset_probe_make without what only polygons want. */
static void walk_probe(probe *ray, aset_vec3 origin, aset_vec3 direction) {
    walk_axis(ray, 0, origin.x, direction.x);
    walk_axis(ray, 1, origin.y, direction.y);
    walk_axis(ray, 2, origin.z, direction.z);
}

/* aset_approach_ready for such a ray. */
static aset_real walk_ready(probe *ray, const aset_scene *scene, aset_vec3 origin, aset_vec3 direction) {
    origin = aset_approach_origin(scene, origin);
    walk_probe(ray, origin, direction);
    return approach_entered(scene, origin) ? 0 : aset_approach_move(ray, scene);
}
#else
#define walk_ready aset_approach_ready
#endif

static uint32_t summary_meet(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                             bool is_seen, aset_statistics *statistics) {
    (void)is_seen;
    probe ray;
    aset_real moved = walk_ready(&ray, tracer->scene, origin, direction);
    hit->near = probe_origin(&ray);
    hit->cover = 1;
    hit->scene = NULL;
    hit->by = &aset_summary_answers;
    if (!approximate_hit(hit, tracer, &ray, moved, t_max * tracer->scene->scale, statistics)) {
        return 0;
    }
    hit->t_near = hit->t;
    hit->t += moved;
    hit->curtailed = trapped(tracer, hit->t);
    answers_to_caller(hit, tracer->scene);
    statistics->curtailed += hit->curtailed;
    statistics->approx_hits += !hit->curtailed;
    return !hit->curtailed;
}

/* The first cell is any cell. */
static bool summary_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                        aset_statistics *statistics) {
    (void)t_last;
    query_hit hit;
    return summary_meet(&hit, tracer, origin, direction, t_max, false, statistics) > 0;
}

static void summary_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit) {
    (void)own;
    surface->cell = hit->cell;
    surface->geometric = answers_slice_normal(hit->face);
    surface->normal = surface->geometric;
    surface->material = summary_texture(tracer->summary, hit->cell);
}

const struct aset_answers aset_summary_answers = {false, summary_meet, summary_any, summary_surface, NULL};

#endif
