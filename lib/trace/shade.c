/*
 * shade.c - Whitted's model (1980): ambient, diffuse, Phong's highlight, shadows, directions of reflected and refracted
 * rays.
 */
#include "trace/shade.h"

#include "trace/reach.h"

bool aset_policy_approximate(const aset_tracer *tracer, aset_kind kind, uint32_t depth) {
#if ASET_WITH_APPROXIMATION
    bool can = tracer->summary != NULL;
#if ASET_WITH_DRAFTS
    can = can || tracer->draft != NULL;
#endif
    return can && (tracer->approx_kinds & (uint32_t)kind) != 0 && depth >= tracer->approx_depth;
#else
    (void)tracer;
    (void)kind;
    (void)depth;
    return false;
#endif
}

void aset_shading_make(shading *s, const aset_tracer *tracer, const query_hit *hit, aset_vec3 direction) {
    aset_query_surface(&s->hit, &s->own, tracer, hit, direction);
    s->direction = direction;
    s->entering = vec_dot(s->hit.geometric, direction) <= 0;
    s->facing = s->entering ? s->hit.geometric : vec_scale(s->hit.geometric, -1);
    s->normal = s->entering ? s->hit.normal : vec_scale(s->hit.normal, -1);
    s->nudge = (vec_largest(s->hit.point) + hit->t_near) * SHADE_NUDGE;
    s->clearance = aset_query_clearance(tracer);
    s->known = s->dark = 0;
}

aset_vec3 aset_shade_start(const shading *s, aset_vec3 direction, bool approximate, aset_real share) {
#if ASET_WITH_OBJECTS
    share = approximate ? share : s->hit.object == ASET_NO_OBJECT ? SHADE_EXACT_SHARE : 0;
#else
    (void)approximate; /* always */
#endif
    aset_real off = real_max(s->nudge, share * s->clearance);
    return vec_along(s->hit.point, vec_dot(direction, s->facing) < 0 ? -off : off, s->facing);
}

/* Where on the shadow ray to light number light nothing of the draft is left ahead. */
static aset_real last_before(const aset_tracer *tracer, const shading *s, uint32_t light, const light_ray *towards) {
#if ASET_WITH_DRAFTS
    if (reach_is_of(tracer, light)) {
        return tracer->reach->calls->last(tracer->reach, light, s->hit.point, real_max(s->clearance, s->nudge), towards);
    }
#endif
    (void)tracer, (void)s, (void)light, (void)towards;
    return REAL_INFINITY;
}

static bool in_shadow(const aset_tracer *tracer, shading *s, uint32_t light, const light_ray *towards, uint32_t depth,
                      aset_statistics *statistics) {
    uint32_t bit = light < 32 ? UINT32_C(1) << light : 0;
    if ((s->known & bit) != 0) {
        return (s->dark & bit) != 0;
    }
    bool approximate = aset_policy_approximate(tracer, ASET_SHADOW, depth);
    aset_vec3 start = aset_shade_start(s, towards->direction, approximate, SHADE_SHADOW_SHARE);
    bool hit = aset_query_any(tracer, start, towards->direction, towards->distance, approximate,
                              last_before(tracer, s, light, towards), statistics);
    statistics->shadow++;
    statistics->shadow_hit += hit;
    s->known |= bit;
    s->dark |= hit ? bit : 0;
    return hit;
}

/*
 * The normal that faces the lights: turned to the side that is seen. The SPD's rules take it as given: the far side of a glass
 * sphere, seen from within, is lit from without, and so is the inside of the teapot (so Havran's counts come out).
 */
static aset_vec3 lit_normal(const aset_tracer *tracer, const shading *s) {
    return tracer->spd_rules ? s->hit.normal : s->normal;
}

aset_colour aset_shade_local(const aset_tracer *tracer, shading *s, uint32_t depth, aset_statistics *statistics) {
    const aset_scene *scene = tracer->scene;
    const aset_material *m = s->hit.material;
    aset_vec3 normal = lit_normal(tracer, s);
    aset_colour sum = shade_ambient(m);
    for (uint32_t i = 0; i < scene->counts.lights; i++) {
        light_ray towards;
        if (!aset_light_towards(&towards, scene, scene->lights + i, s->hit.point)) {
            continue;
        }
        aset_real n_dot_l = vec_dot(normal, towards.direction);
        if (n_dot_l > 0 && !in_shadow(tracer, s, i, &towards, depth, statistics)) {
            shade_add_light(&sum, m, normal, s->direction, &towards, n_dot_l);
        }
    }
    return sum;
}

aset_vec3 aset_shade_reflected(const shading *s) {
    aset_real twice = 2 * vec_dot(s->normal, s->direction);
    return aset_vec_unit(vec_along(s->direction, -twice, s->normal));
}

#if ASET_WITH_REFRACTION
bool aset_shade_refracted(const shading *s, aset_vec3 *direction) {
    aset_real index = s->hit.material->refraction_index;
    index = index > 0 ? index : 1;
    aset_real ratio = s->entering ? 1 / index : index;
    aset_real cosine = -vec_dot(s->normal, s->direction);
    aset_real under_root = 1 - ratio * ratio * (1 - cosine * cosine);
    if (!(under_root >= 0)) {
        return false;
    }
    aset_vec3 along = vec_scale(s->direction, ratio);
    *direction = aset_vec_unit(vec_along(along, ratio * cosine - real_sqrt(under_root), s->normal));
    if (!(vec_largest(*direction) > 0)) { /* straight in, by a ratio beyond the digits of 1: nothing is left of it */
        *direction = s->direction;
    }
    return true;
}
#endif
