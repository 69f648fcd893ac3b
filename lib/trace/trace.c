/*
 * trace.c - the tree of rays behind an eye ray, with an explicit stack.
 *
 * Every ray carries the weight with which its colour counts in the pixel, so a colour is a plain sum over the rays and
 * nothing has to come back up. A ray is taken off the stack and leaves at most two new ones, one level deeper, of which one
 * is taken next: so at most one waits on each level, and depth entries suffice (2 on the deepest level but one, 1 on each
 * above).
 */
#include "trace/trace_tree.h"

#include "trace/shade.h"

aset_status aset_scratch_init(aset_scratch *scratch, uint32_t depth, aset_arena *arena) {
    depth = depth > 0 ? depth : ASET_DEPTH_DEFAULT;
    if (scratch == NULL || arena == NULL || depth > ASET_DEPTH_MAX) {
        return ASET_ERR_ARGUMENT;
    }
    aset_waiting *stack = aset_arena_alloc(arena, ASET_BYTES_SCRATCH(depth), ASET_CATEGORY_SCRATCH);
    if (stack == NULL) {
        return ASET_ERR_NOMEM;
    }
    scratch->stack = stack;
    scratch->capacity = depth;
#if ASET_WITH_DRAFTS
    scratch->beams = NULL;
#endif
    return ASET_OK;
}

#if ASET_WITH_REFLECTION || ASET_WITH_REFRACTION
/* A ray to be traced later; depth is the new ray's. */
static void leave(aset_scratch *scratch, uint32_t *n, const aset_tracer *tracer, const shading *s, aset_vec3 direction,
                  aset_real weight, uint32_t depth, aset_kind kind) {
    aset_waiting *w = scratch->stack + (*n)++;
    w->origin = aset_shade_start(s, direction, aset_policy_approximate(tracer, kind, depth), 1);
    w->direction = direction;
    w->weight = real_min(weight, REAL_MAX); /* by amounts above 1, again and again; infinity times black is no colour */
    w->depth = (uint16_t)depth;
    w->kind = (uint16_t)kind;
}
#endif

/* The rays that the hit sends on. Under the SPD's rules they are sent even where their weight is 0. */
static void send_on(aset_scratch *scratch, uint32_t *n, const aset_tracer *tracer, const shading *s,
                    uint32_t depth, aset_real weight) {
#if ASET_WITH_REFLECTION || ASET_WITH_REFRACTION
    const aset_material *m = s->hit.material;
    depth++;
    if (depth >= tracer_depth(tracer)) {
        return;
    }
#if ASET_WITH_REFRACTION
    bool transmits = m->transmittance > 0;
    aset_vec3 direction;
    if (transmits && aset_shade_refracted(s, &direction)) {
        leave(scratch, n, tracer, s, direction, weight * m->transmittance, depth, ASET_REFRACTED);
    }
#else
    bool transmits = false;
#endif
#if ASET_WITH_REFLECTION
    if (m->specular > 0 || (tracer->spd_rules && transmits)) {
        leave(scratch, n, tracer, s, aset_shade_reflected(s), weight * m->specular, depth, ASET_REFLECTED);
    }
#else
    (void)transmits;
#endif
#else
    (void)scratch, (void)n, (void)tracer, (void)s, (void)depth, (void)weight;
#endif
}

static void count_ray(aset_statistics *statistics, aset_kind kind, bool hit) {
    statistics->primary += kind == ASET_PRIMARY;
    statistics->primary_hit += kind == ASET_PRIMARY && hit;
    statistics->reflected += kind == ASET_REFLECTED;
    statistics->refracted += kind == ASET_REFRACTED;
    statistics->secondary_hit += kind != ASET_PRIMARY && hit;
}

static bool is_same_surface(const query_hit *before, const query_hit *hit, aset_real clearance) {
    return hit->object == ASET_NO_OBJECT && shade_is_same(before->t, hit->t, clearance); /* an object comes last */
}

/*
 * The layers of a draft that a ray meets, shaded; the rays sent on leave from the layer that covers most, so that there are no
 * more of them than of a single hit. What of the ray is left uncovered.
 */
static aset_real shade_layers(aset_colour *sum, const aset_tracer *tracer, aset_vec3 direction, uint32_t depth,
                              aset_real weight, const query_hit *layers, uint32_t n_layers, aset_scratch *scratch,
                              uint32_t *n, aset_statistics *statistics) {
    aset_real left = 1, most = 0;
    shading pair[2]; /* the one that covers most so far, and the next */
    uint32_t sender = 1, known = 0, dark = 0; /* of the layer before */
    for (uint32_t i = 0; i < n_layers; i++) {
        shading *s = pair + (1 - sender);
        aset_shading_make(s, tracer, layers + i, direction);
        if (i > 0 && is_same_surface(layers + i - 1, layers + i, s->clearance)) {
            s->known = known;
            s->dark = dark;
        }
        aset_colour local = aset_shade_local(tracer, s, depth, statistics);
        known = s->known;
        dark = s->dark;
        shade_add(sum, weight * layers[i].cover, &local);
        left -= layers[i].cover;
        if (layers[i].cover > most) {
            most = layers[i].cover;
            sender = 1 - sender;
        }
    }
    left = left > 0 ? left : 0;
    send_on(scratch, n, tracer, pair + sender, depth, weight * (1 - left));
    return left;
}

/* The tree behind one eye ray of unit direction; *cover: the share of the eye ray itself that hit something. */
aset_colour aset_trace_tree(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, const eye_hits *known,
                            aset_scratch *scratch, aset_statistics *statistics, aset_real *cover) {
    aset_colour sum = {0, 0, 0};
    uint32_t n = 1;
    scratch->stack[0].origin = origin;
    scratch->stack[0].direction = direction;
    scratch->stack[0].weight = 1;
    scratch->stack[0].depth = 0;
    scratch->stack[0].kind = ASET_PRIMARY;
    *cover = 0;
    for (; n > 0; known = NULL) { /* the eye ray comes first */
        const aset_waiting *ray = scratch->stack + --n; /* gone when the next ones are left */
        aset_vec3 direction_of = ray->direction;
        aset_real weight = ray->weight, left = 1;
        uint32_t depth = ray->depth;
        aset_kind kind = (aset_kind)ray->kind;
        query_hit found[QUERY_LAYERS_MAX];
        const query_hit *layers = known != NULL ? known->layers : found;
        uint32_t n_layers = known != NULL ? known->n
                                          : aset_query_layers(found, tracer, ray->origin, direction_of,
                                                              aset_policy_approximate(tracer, kind, depth), kind == ASET_PRIMARY, statistics);
        count_ray(statistics, kind, n_layers > 0);
        if (n_layers > 0) {
            left = shade_layers(&sum, tracer, direction_of, depth, weight, layers, n_layers, scratch, &n, statistics);
        }
        if (left > 0) {
            shade_add(&sum, weight * left, &tracer->scene->background);
        }
        *cover += kind == ASET_PRIMARY ? 1 - left : 0;
    }
    return sum;
}

/* No ray needs the space. */
static bool always_approximate(const aset_tracer *tracer) {
#if ASET_WITH_APPROXIMATION
    return (tracer->approx_kinds & ASET_ALL_KINDS) == ASET_ALL_KINDS && tracer->approx_depth == 0 && aset_query_can(tracer, true);
#else
    (void)tracer;
    return false;
#endif
}

aset_status aset_trace_check(const aset_tracer *tracer, const aset_scratch *scratch) {
    bool fine = tracer != NULL && scratch != NULL && (aset_query_can(tracer, false) || always_approximate(tracer)) &&
                scratch->stack != NULL && scratch->capacity >= tracer_depth(tracer);
    return fine ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_ray_colour(aset_colour *colour, const aset_tracer *tracer, const aset_ray *ray, aset_scratch *scratch,
                            aset_statistics *statistics) {
    aset_statistics ignored = {0};
    aset_real cover, length;
    aset_vec3 direction;
    aset_status status = aset_trace_check(tracer, scratch);
    if (status != ASET_OK || colour == NULL || ray == NULL || !aset_query_unit(&direction, &length, ray)) {
        return ASET_ERR_ARGUMENT;
    }
    *colour =
        aset_trace_tree(tracer, ray->origin, direction, NULL, scratch, statistics != NULL ? statistics : &ignored, &cover);
    return ASET_OK;
}
