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

#include <string.h>

static uint32_t tracer_depth(const aset_tracer *tracer) {
    return tracer->depth > 0 ? tracer->depth : ASET_DEPTH_DEFAULT;
}

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
    return ASET_OK;
}

/* A ray to be traced later; depth is the new ray's. */
static void leave(aset_scratch *scratch, uint32_t *n, const shading *s, aset_vec3 direction, aset_real weight,
                  uint32_t depth, aset_kind kind) {
    aset_waiting *w = scratch->stack + (*n)++;
    w->origin = shade_start(s, direction);
    w->direction = direction;
    w->weight = weight;
    w->depth = (uint16_t)depth;
    w->kind = (uint16_t)kind;
}

/* The rays that the hit sends on. Under the SPD's rules they are sent even where their weight is 0. */
static void send_on(aset_scratch *scratch, uint32_t *n, const aset_tracer *tracer, const shading *s,
                    const aset_waiting *from) {
#if ASET_WITH_REFLECTION || ASET_WITH_REFRACTION
    const aset_material *m = s->hit.material;
    uint32_t depth = from->depth + 1u;
    if (depth >= tracer_depth(tracer)) {
        return;
    }
#if ASET_WITH_REFRACTION
    bool transmits = m->transmittance > 0;
    aset_vec3 direction;
    if (transmits && shade_refracted(s, &direction)) {
        leave(scratch, n, s, direction, from->weight * m->transmittance, depth, ASET_REFRACTED);
    }
#else
    bool transmits = false;
#endif
#if ASET_WITH_REFLECTION
    if (m->specular > 0 || (tracer->spd_rules && transmits)) {
        leave(scratch, n, s, shade_reflected(s), from->weight * m->specular, depth, ASET_REFLECTED);
    }
#else
    (void)transmits;
#endif
#else
    (void)scratch, (void)n, (void)tracer, (void)s, (void)from;
#endif
}

static void count_ray(aset_statistics *statistics, uint16_t kind, bool hit) {
    statistics->primary += kind == ASET_PRIMARY;
    statistics->primary_hit += kind == ASET_PRIMARY && hit;
    statistics->reflected += kind == ASET_REFLECTED;
    statistics->refracted += kind == ASET_REFRACTED;
    statistics->secondary_hit += kind != ASET_PRIMARY && hit;
}

static void add_colour(aset_colour *sum, aset_real weight, const aset_colour *colour) {
    sum->r += weight * colour->r;
    sum->g += weight * colour->g;
    sum->b += weight * colour->b;
}

/* The tree behind one eye ray of unit direction; *hit: whether the eye ray itself hit something. */
aset_colour trace_tree(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_scratch *scratch,
                       aset_statistics *statistics, bool *hit) {
    aset_colour sum = {0, 0, 0};
    uint32_t n = 1;
    scratch->stack[0].origin = origin;
    scratch->stack[0].direction = direction;
    scratch->stack[0].weight = 1;
    scratch->stack[0].depth = 0;
    scratch->stack[0].kind = ASET_PRIMARY;
    *hit = false;
    while (n > 0) {
        aset_waiting ray = scratch->stack[--n];
        query_hit found;
        bool is_hit = query_closest(&found, tracer, ray.origin, ray.direction, REAL_INFINITY,
                                    policy_approximate(tracer, (aset_kind)ray.kind, ray.depth), statistics);
        count_ray(statistics, ray.kind, is_hit);
        *hit = *hit || (is_hit && ray.kind == ASET_PRIMARY);
        if (!is_hit) {
            add_colour(&sum, ray.weight, &tracer->scene->background);
            continue;
        }
        shading s;
        shading_make(&s, tracer, &found, ray.direction);
        aset_colour local = shade_local(tracer, &s, ray.depth, statistics);
        add_colour(&sum, ray.weight, &local);
        send_on(scratch, &n, tracer, &s, &ray);
    }
    return sum;
}

aset_status trace_check(const aset_tracer *tracer, const aset_scratch *scratch) {
    bool fine = tracer != NULL && scratch != NULL && tracer->scene != NULL && tracer->space != NULL &&
                scratch->stack != NULL && scratch->capacity >= tracer_depth(tracer);
    return fine ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_ray_colour(aset_colour *colour, const aset_tracer *tracer, const aset_ray *ray, aset_scratch *scratch,
                            aset_statistics *statistics) {
    aset_statistics ignored;
    bool hit;
    aset_status status = trace_check(tracer, scratch);
    if (status != ASET_OK || colour == NULL || ray == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_vec3 direction = vec_unit(ray->direction);
    if (!vec_finite(ray->origin) || !vec_finite(ray->direction) || !(vec_largest(direction) > 0)) {
        return ASET_ERR_ARGUMENT;
    }
    memset(&ignored, 0, sizeof ignored);
    *colour = trace_tree(tracer, ray->origin, direction, scratch, statistics != NULL ? statistics : &ignored, &hit);
    return ASET_OK;
}
