/*
 * query.c - the exact and the approximate consumer of a space's walk.
 *
 * Exact: test what a cell refers to, keep the nearest hit, and tell the walk to go no farther than it. At equal t the object
 * added first wins, so that every space and brute force agree. Approximate: the first cell entered at t > 0 that has a
 * texture is the hit.
 *
 * A ray that starts away from the scene is first brought near it: from afar the rounding of its slice crossings would exceed
 * the boxes' margins. All spaces see the same moved ray.
 */
#include "trace/query.h"

#include "approx/summary.h"
#include "scene/shape.h"
#include "space/walk.h"

/* Where a ray from outside is made to start: this part of the scene's size before the box. */
#define NEAR R(0.0625)
#define APPROACHES 4

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
        aset_real t = object_nearest(q->scene, object, q->ray, q->end);
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

/* t_max as the moved ray counts it, and the rounding of that. */
static aset_real end_of(aset_real moved, aset_real t_max) {
    return t_max - moved + 4 * REAL_UNIT * moved;
}

static bool exact(exact_query *q, const aset_tracer *tracer, const probe *ray, aset_real moved, aset_real t_max, bool any,
                  aset_statistics *statistics) {
    q->moved = moved;
    q->t_max = t_max;
    q->end = end_of(moved, t_max);
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
    aset_real bound = tracer->curtail * vec_length(vec(w[0], w[1], w[2]));
    return tracer->curtail_more ? t > bound : t < bound;
}

static bool approximate_hit(query_hit *hit, const aset_tracer *tracer, const probe *ray, aset_real moved, aset_real t_max,
                            aset_statistics *statistics) {
    approximate_query q;
    q.walk.visit = visit_approximate;
    q.walk.limit = end_of(moved, t_max);
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

#endif

/* The larger of an origin's distances to both sides of a box, on one axis. */
static inline aset_real farther(aset_real low, aset_real high, aset_real origin) {
    return real_max(high - origin, origin - low);
}

/* Narrows the ray's stay in a box by one axis, as probe_box does. False: it misses. */
static inline bool narrow(const probe *ray, int a, aset_real low, aset_real high, aset_real *t_in, aset_real *t_out) {
    aset_real origin = ray->origin[a], inverse = ray->inverse[a];
    if (!ray->moves[a]) {
        return origin >= low && origin <= high;
    }
    bool up = ray->direction[a] > 0;
    *t_in = real_max(((up ? low : high) - origin) * inverse, *t_in);
    *t_out = real_min(((up ? high : low) - origin) * inverse, *t_out);
    return true;
}

/*
 * How far the ray is from the scene's box: t at which it enters, 0 if it misses or has entered. The box is grown by more than any
 * object's, and by the rounding of its sides' t from here: a ray that misses it is refused by the clamp of every object too.
 */
static aset_real distance_to(const probe *ray, aset_vec3 low, aset_vec3 high, aset_real margin) {
    const aset_real *o = ray->origin;
    aset_real t_in = -REAL_INFINITY, t_out = REAL_INFINITY;
    aset_real away = real_max(farther(low.x, high.x, o[0]), farther(low.y, high.y, o[1]));
    away = real_max(away, farther(low.z, high.z, o[2]));
    aset_real grown = 4 * margin + 4 * REAL_UNIT * away;
    bool meets = narrow(ray, 0, low.x - grown, high.x + grown, &t_in, &t_out) &&
                 narrow(ray, 1, low.y - grown, high.y + grown, &t_in, &t_out) &&
                 narrow(ray, 2, low.z - grown, high.z + grown, &t_in, &t_out);
    return meets && t_in <= t_out && t_in > 0 ? t_in : 0;
}

#if ASET_WITH_APPROXIMATION

/* Below this a component of a unit direction moves a ray by less than any margin: as probe_make's. */
#define STILL R(8.7e-19)

static inline void walk_axis(probe *ray, int a, aset_real origin, aset_real direction) {
    ray->moves[a] = real_abs(direction) > STILL;
    ray->inverse[a] = ray->moves[a] ? 1 / direction : 0;
    ray->origin[a] = origin;
    ray->direction[a] = direction;
}

/* probe_make without what only polygons want. */
static void walk_probe(probe *ray, aset_vec3 origin, aset_vec3 direction) {
    walk_axis(ray, 0, origin.x, direction.x);
    walk_axis(ray, 1, origin.y, direction.y);
    walk_axis(ray, 2, origin.z, direction.z);
}

#endif

/* Is the origin in less than the box of distance_to? Then that is 0: so with most rays that a surface sends on. */
static inline bool has_entered(const aset_scene *scene, aset_vec3 origin) {
    aset_vec3 low = scene->low, high = scene->high;
    aset_real grown = 4 * scene->margin;
    return origin.x >= low.x - grown && origin.x <= high.x + grown && origin.y >= low.y - grown &&
           origin.y <= high.y + grown && origin.z >= low.z - grown && origin.z <= high.z + grown;
}

/* Moves a ray from outside near the scene. By how much. */
static aset_real approach(probe *ray, const aset_scene *scene) {
    if (scene->counts.objects == 0) {
        return 0;
    }
    aset_real moved = 0, near = NEAR * vec_largest(vec_sub(scene->high, scene->low));
    for (int i = 0; i < APPROACHES; i++) { /* from very far away the first move ends up somewhere near: so again */
        aset_real step = distance_to(ray, scene->low, scene->high, scene->margin) - near;
        if (!(step > 0)) {
            break;
        }
        for (int a = 0; a < 3; a++) {
            ray->origin[a] += step * ray->direction[a];
        }
        moved += step;
    }
    return moved;
}

aset_real query_ready(probe *ray, const aset_scene *scene, aset_vec3 origin, aset_vec3 direction) {
    *ray = probe_make(origin, direction);
    return has_entered(scene, origin) ? 0 : approach(ray, scene);
}

#if ASET_WITH_DRAFTS

static bool has_draft(const aset_tracer *tracer) {
    return tracer->draft != NULL;
}

static draft_mode mode_of(const aset_tracer *tracer) {
    return tracer->draft_sides ? DRAFT_SIDE : DRAFT_PLANE;
}

/* The nearest of the objects that the draft keeps exact; t_max if there is none before it. */
static aset_real nearest_kept(query_hit *hit, const aset_draft *draft, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                              aset_statistics *statistics) {
    const aset_scene *stage = &draft->stage;
    probe ray;
    aset_real best = t_max;
    if (stage->counts.objects == 0) {
        return best;
    }
    aset_real moved = query_ready(&ray, stage, origin, direction);
    for (uint32_t i = 0; i < stage->counts.objects; i++) {
        aset_real t = object_nearest(stage, i, &ray, best - moved);
        statistics->tests++;
        if (t + moved < best) {
            statistics->test_hits++;
            best = t + moved;
            hit->object = i;
            hit->t_near = t;
        }
    }
    hit->near = probe_origin(&ray);
    hit->t = best;
    hit->scene = stage;
    hit->cell = 0;
    hit->curtailed = false;
    return best;
}

static uint32_t layers_of_draft(query_hit layers[QUERY_LAYERS_MAX], const aset_tracer *tracer, aset_vec3 origin,
                                aset_vec3 direction, aset_real t_max, aset_statistics *statistics) {
    draft_layer met[DRAFT_LAYERS_MAX];
    draft_counts counts;
    query_hit kept;
    aset_real end = nearest_kept(&kept, tracer->draft, origin, direction, t_max, statistics), left = 1;
    uint32_t n = draft_layers(met, tracer->draft, mode_of(tracer), origin, direction, end, &counts);
    statistics->cells_visited += counts.cells;
    statistics->nonempty_visited += counts.nonempty;
    statistics->approx_hits += n > 0;
    for (uint32_t i = 0; i < n; i++) {
        query_hit *hit = layers + i;
        hit->t = hit->t_near = met[i].t;
        hit->near = origin;
        hit->object = ASET_NO_OBJECT;
        hit->cell = met[i].facet;
        hit->face = met[i].face;
        hit->curtailed = false;
        hit->cover = met[i].cover;
        hit->scene = NULL;
        left -= met[i].cover;
    }
    if (end < t_max && left > 0) {
        layers[n] = kept;
        layers[n++].cover = left;
    }
    return n;
}

static bool draft_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                      aset_statistics *statistics) {
    draft_counts counts;
    query_hit kept;
    if (nearest_kept(&kept, tracer->draft, origin, direction, t_max, statistics) < t_max) {
        return true;
    }
    bool blocked = draft_blocks(tracer->draft, mode_of(tracer), origin, direction, t_max, &counts);
    statistics->cells_visited += counts.cells;
    statistics->nonempty_visited += counts.nonempty;
    statistics->approx_hits += blocked;
    return blocked;
}

aset_real query_clearance(const aset_tracer *tracer) {
    return has_draft(tracer) ? draft_clearance(tracer->draft) : 0;
}

#else

aset_real query_clearance(const aset_tracer *tracer) {
    (void)tracer;
    return 0;
}

#endif

bool query_closest(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                   bool approximate, aset_statistics *statistics) {
    probe ray;
#if ASET_WITH_DRAFTS
    if (approximate && has_draft(tracer)) { /* what covers most */
        query_hit layers[QUERY_LAYERS_MAX];
        uint32_t n = layers_of_draft(layers, tracer, origin, direction, t_max, statistics), most = 0;
        for (uint32_t i = 1; i < n; i++) {
            most = layers[i].cover > layers[most].cover ? i : most;
        }
        if (n > 0) {
            *hit = layers[most];
        }
        return n > 0;
    }
#endif
    hit->curtailed = false;
    hit->cover = 1;
    hit->scene = NULL;
#if ASET_WITH_APPROXIMATION
    if (approximate) {
        walk_probe(&ray, origin, direction);
        aset_real moved = has_entered(tracer->scene, origin) ? 0 : approach(&ray, tracer->scene);
        hit->near = probe_origin(&ray);
        bool found = approximate_hit(hit, tracer, &ray, moved, t_max, statistics);
        if (!found) {
            return false;
        }
        hit->t_near = hit->t;
        hit->t += moved;
        hit->curtailed = trapped(tracer, hit->t);
        statistics->curtailed += hit->curtailed;
        statistics->approx_hits += !hit->curtailed;
        return !hit->curtailed;
    }
#endif
    (void)approximate;
    aset_real moved = query_ready(&ray, tracer->scene, origin, direction);
    hit->near = probe_origin(&ray);
    exact_query q;
    bool found = exact(&q, tracer, &ray, moved, t_max, false, statistics);
    hit->t_near = q.best;
    hit->t = q.best + moved;
    hit->object = q.object;
    hit->scene = tracer->scene;
    return found;
}

uint32_t query_layers(query_hit layers[QUERY_LAYERS_MAX], const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction,
                      bool approximate, aset_statistics *statistics) {
#if ASET_WITH_DRAFTS
    if (approximate && has_draft(tracer)) {
        return layers_of_draft(layers, tracer, origin, direction, REAL_INFINITY, statistics);
    }
#endif
    return query_closest(layers, tracer, origin, direction, REAL_INFINITY, approximate, statistics);
}

bool query_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, bool approximate,
               aset_statistics *statistics) {
#if ASET_WITH_DRAFTS
    if (approximate && has_draft(tracer)) {
        return draft_any(tracer, origin, direction, t_max, statistics);
    }
#endif
#if ASET_WITH_APPROXIMATION
    if (approximate) {
        query_hit hit; /* the first cell is any cell */
        return query_closest(&hit, tracer, origin, direction, t_max, true, statistics);
    }
#endif
    (void)approximate;
    probe ray;
    exact_query q;
    aset_real moved = query_ready(&ray, tracer->scene, origin, direction);
    return exact(&q, tracer, &ray, moved, t_max, true, statistics);
}

#if ASET_WITH_APPROXIMATION

/* The normal of a slice, towards the ray. */
static aset_vec3 slice_normal(int face) {
    aset_real towards = (face & 1) != 0 ? R(1) : R(-1);
    int axis = face / 2;
    return vec(axis == 0 ? towards : 0, axis == 1 ? towards : 0, axis == 2 ? towards : 0);
}

static void cell_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit) {
    surface->cell = hit->cell;
#if ASET_WITH_DRAFTS
    if (has_draft(tracer)) {
        facet f = facet_read(tracer->draft, hit->cell);
        surface->normal = facet_normal(tracer->draft, &f);
        surface->geometric = tracer->draft_sides ? slice_normal(hit->face) : surface->normal;
        *own = draft_material(tracer->draft, f.texture);
        surface->material = own;
        return;
    }
#endif
    (void)own;
    surface->geometric = slice_normal(hit->face);
    surface->normal = surface->geometric;
    surface->material = summary_texture(tracer->summary, hit->cell);
}

#endif

void query_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit,
                   aset_vec3 direction) {
    surface->t = hit->t;
    surface->point = vec_along(hit->near, hit->t_near, direction);
    surface->object = hit->object;
    surface->cell = 0;
#if ASET_WITH_APPROXIMATION
    if (hit->object == ASET_NO_OBJECT) {
        cell_surface(surface, own, tracer, hit);
        return;
    }
#endif
    (void)own, (void)tracer;
    object_normals(hit->scene, hit->object, surface->point, &surface->normal, &surface->geometric);
    surface->material = shape_of(hit->scene, hit->object).material;
}

static bool can_approximate(const aset_tracer *tracer) {
#if ASET_WITH_DRAFTS
    return tracer->summary != NULL || has_draft(tracer);
#elif ASET_WITH_APPROXIMATION
    return tracer->summary != NULL;
#else
    (void)tracer;
    return false;
#endif
}

bool query_can(const aset_tracer *tracer, bool approximate) {
#if ASET_WITH_DRAFTS
    if (approximate && has_draft(tracer)) {
        return tracer->scene != NULL;
    }
#endif
    return tracer->scene != NULL && tracer->space != NULL && (!approximate || can_approximate(tracer));
}

/* A caller's ray, checked; its direction and t_max in unit lengths. length: of the caller's direction. */
static aset_status accept_ray(const aset_tracer *tracer, const aset_ray *ray, bool approximate, aset_vec3 *direction,
                              aset_real *length) {
    if (tracer == NULL || ray == NULL || !query_can(tracer, approximate)) {
        return ASET_ERR_ARGUMENT;
    }
    *direction = vec_unit(ray->direction);
    *length = vec_length(ray->direction);
    bool fine = vec_finite(ray->origin) && vec_finite(ray->direction) && real_finite(*length) && *length > 0 &&
                ray->t_max == ray->t_max;
    return fine ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_closest_hit(bool *found, aset_hit *hit, const aset_tracer *tracer, const aset_ray *ray,
                             bool approximate, aset_statistics *statistics) {
    aset_vec3 direction;
    aset_real length;
    aset_statistics ignored = {0};
    query_hit q;
    if (found == NULL || hit == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = accept_ray(tracer, ray, approximate, &direction, &length);
    if (status != ASET_OK) {
        return status;
    }
    *found = query_closest(&q, tracer, ray->origin, direction, ray->t_max * length, approximate,
                           statistics != NULL ? statistics : &ignored);
    if (*found) {
        aset_material own;
        query_surface(hit, &own, tracer, &q, direction);
        hit->material = hit->material != &own ? hit->material : NULL;
        hit->t = q.t / length;
    }
    return ASET_OK;
}

aset_status aset_any_hit(bool *found, const aset_tracer *tracer, const aset_ray *ray, bool approximate,
                         aset_statistics *statistics) {
    aset_vec3 direction;
    aset_real length;
    aset_statistics ignored = {0};
    if (found == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_status status = accept_ray(tracer, ray, approximate, &direction, &length);
    if (status == ASET_OK) {
        *found = query_any(tracer, ray->origin, direction, ray->t_max * length, approximate,
                           statistics != NULL ? statistics : &ignored);
    }
    return status;
}
