/*
 * shade.c - Whitted's model (1980): ambient, diffuse, Phong's highlight, shadows, directions of reflected and refracted
 * rays.
 *
 * New rays start off the surface by nudge along its geometric normal. The point of a hit errs by a few units in the last
 * place of the numbers it is made of, |point| and t, so the nudge is NUDGE of those: no length in scene units.
 */
#include "trace/shade.h"

#include "trace/reach.h"

#define AMBIENT R(0.1)
#define NUDGE (32 * REAL_UNIT)
/* Shadow rays need less of a draft's clearance: they ignore the voxel that they start in. */
#define SHADOW_SHARE (R(1) / 3)

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
    s->nudge = (vec_largest(s->hit.point) + hit->t_near) * NUDGE;
    s->clearance = aset_query_clearance(tracer);
    s->known = s->dark = 0;
}

aset_vec3 aset_shade_start(const shading *s, aset_vec3 direction, aset_real clearance) {
    aset_real off = real_max(s->nudge, clearance);
    return vec_along(s->hit.point, vec_dot(direction, s->facing) < 0 ? -off : off, s->facing);
}

#if ASET_WITH_DRAFTS
/* Was the reach made for this very light? A tracer's scene may have other ones than the draft's stage. */
static bool is_reached(const aset_tracer *tracer, uint32_t light) {
    const aset_reach *reach = tracer->reach;
    if (reach == NULL || reach->draft != tracer->draft || light >= reach->n_lights) {
        return false;
    }
    const aset_reach_map *map = reach->lights + light;
    const aset_light *asked = tracer->scene->lights + light;
    return map->directional == asked->directional && map->position.x == asked->position.x &&
           map->position.y == asked->position.y && map->position.z == asked->position.z;
}
#endif

/* Where on the shadow ray to light number light nothing of the draft is left ahead. */
static aset_real last_before(const aset_tracer *tracer, const shading *s, uint32_t light, const light_ray *towards) {
#if ASET_WITH_DRAFTS
    if (is_reached(tracer, light)) {
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
    aset_vec3 start = aset_shade_start(s, towards->direction, approximate ? SHADOW_SHARE * s->clearance : 0);
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

static aset_real highlight(const shading *s, aset_vec3 normal, aset_vec3 to_light, aset_real n_dot_l) {
    aset_vec3 mirrored = vec_sub(vec_scale(normal, 2 * n_dot_l), to_light);
    aset_real r_dot_v = -vec_dot(mirrored, s->direction);
    return r_dot_v > 0 ? aset_real_power(r_dot_v, s->hit.material->shine) : 0;
}

aset_colour aset_shade_local(const aset_tracer *tracer, shading *s, uint32_t depth, aset_statistics *statistics) {
    const aset_scene *scene = tracer->scene;
    const aset_material *m = s->hit.material;
    aset_vec3 normal = lit_normal(tracer, s);
    aset_colour sum = {AMBIENT * m->fill.r, AMBIENT * m->fill.g, AMBIENT * m->fill.b};
    for (uint32_t i = 0; i < scene->counts.lights; i++) {
        light_ray towards;
        if (!aset_light_towards(&towards, scene, scene->lights + i, s->hit.point)) {
            continue;
        }
        aset_real n_dot_l = vec_dot(normal, towards.direction);
        if (!(n_dot_l > 0) || in_shadow(tracer, s, i, &towards, depth, statistics)) {
            continue;
        }
        aset_real diffuse = m->diffuse * n_dot_l;
        aset_real specular = m->specular > 0 ? m->specular * highlight(s, normal, towards.direction, n_dot_l) : 0;
        sum.r += (m->fill.r * diffuse + specular) * towards.colour.r;
        sum.g += (m->fill.g * diffuse + specular) * towards.colour.g;
        sum.b += (m->fill.b * diffuse + specular) * towards.colour.b;
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
