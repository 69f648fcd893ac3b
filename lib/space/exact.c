/*
 * exact.c - the exact consumer of a space's walk: test what a cell refers to, keep the nearest hit, and tell the walk to go no
 * farther than it. At equal t the object added first wins, so that every space and brute force agree.
 */
#include "scene/approach.h"
#include "space/answers.h"
#include "space/walk.h"

typedef struct exact_query {
    walk_request walk;
    const aset_scene *scene;
    const probe *ray;
    aset_real moved, t_max; /* a hit counts if t + moved < t_max: in the caller's numbers, not in the moved ray's */
    aset_real end;          /* no hit that counts lies behind this t */
    aset_real best;         /* t of the nearest hit so far, or end */
    uint32_t object;
    bool any; /* the first hit ends it */
    uint64_t tests, hits;
} exact_query;

static aset_real visit_exact(walk_request *walk, const walk_cell *cell) {
    exact_query *q = (exact_query *)walk; /* walk is its first member */
    for (uint32_t i = 0; i < cell->n; i++) {
        uint32_t object = cell->objects[i];
        aset_real t = aset_object_nearest(q->scene, object, q->ray, q->end);
        q->tests++;
        bool counts = t + q->moved < q->t_max;
        bool nearer = counts && (t < q->best || (t == q->best && object < q->object)); /* ASET_NO_OBJECT is the largest */
        q->hits += counts;
        if (nearer) {
            q->best = t;
            q->object = object;
            if (q->any) {
                q->best = 0; /* nothing is nearer: whatever is still visited is tested in vain */
                return -REAL_INFINITY;
            }
        }
    }
    return q->best;
}

static bool exact(exact_query *q, const aset_tracer *tracer, const probe *ray, aset_real moved, aset_real t_max, bool any,
                  aset_statistics *statistics) {
    q->moved = moved;
    q->t_max = t_max;
    q->end = approach_end(moved, t_max);
    q->walk.visit = visit_exact;
    q->walk.limit = q->end;
    q->walk.wants_references = true;
    q->walk.cells = q->walk.nonempty = 0;
    q->scene = tracer->scene;
    q->ray = ray;
    q->best = q->end;
    q->object = ASET_NO_OBJECT;
    q->any = any;
    q->tests = q->hits = 0;
    tracer->space->method->go(tracer->space, ray, &q->walk);
    statistics->tests += q->tests;
    statistics->test_hits += q->hits;
    statistics->cells_visited += q->walk.cells;
    statistics->nonempty_visited += q->walk.nonempty;
    return q->object != ASET_NO_OBJECT;
}

static uint32_t exact_meet(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                           bool is_seen, aset_statistics *statistics) {
    (void)is_seen;
    probe ray;
    exact_query q;
    aset_real moved = aset_approach_ready(&ray, tracer->scene, origin, direction);
    bool found = exact(&q, tracer, &ray, moved, t_max * tracer->scene->scale, false, statistics);
    hit->near = probe_origin(&ray);
    hit->t_near = q.best;
    hit->t = q.best + moved;
    hit->object = q.object;
    hit->curtailed = false;
    hit->cover = 1;
    hit->scene = tracer->scene;
    hit->by = &aset_exact_answers;
    answers_to_caller(hit, tracer->scene);
    return found;
}

static bool exact_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                      aset_statistics *statistics) {
    (void)t_last;
    probe ray;
    exact_query q;
    aset_real moved = aset_approach_ready(&ray, tracer->scene, origin, direction);
    return exact(&q, tracer, &ray, moved, t_max * tracer->scene->scale, true, statistics);
}

static void exact_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit) {
    (void)own, (void)tracer;
    aset_object_surface(surface, hit->scene, hit->object);
}

const struct aset_answers aset_exact_answers = {false, exact_meet, exact_any, exact_surface, NULL};
