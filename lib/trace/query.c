/*
 * query.c - one ray put to whoever answers it: the space's objects, the summary's textures or the draft's facets (answers.h).
 */
#include "trace/query.h"

#include "space/answers.h"

/* Who answers; what the tracer lacks is aset_query_can's affair. */
static const struct aset_answers *answers_of(const aset_tracer *tracer, bool approximate) {
#if ASET_WITH_DRAFTS
    if (approximate && tracer->draft != NULL) {
        return tracer->draft->answers;
    }
#endif
#if ASET_WITH_APPROXIMATION
    if (approximate) {
        return tracer->summary->answers;
    }
#endif
    (void)approximate;
    return tracer->space->answers;
}

aset_real aset_query_clearance(const aset_tracer *tracer) {
#if ASET_WITH_DRAFTS
    return tracer->draft != NULL ? tracer->draft->answers->clearance(tracer) : 0;
#else
    (void)tracer;
    return 0;
#endif
}

bool aset_query_closest(query_hit *hit, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                        bool approximate, aset_statistics *statistics) {
    const struct aset_answers *answers = answers_of(tracer, approximate);
    if (!answers->layered) {
        return answers->meet(hit, tracer, origin, direction, t_max, true, statistics) > 0;
    }
    query_hit layers[QUERY_LAYERS_MAX];
    uint32_t n = answers->meet(layers, tracer, origin, direction, t_max, true, statistics), most = 0;
    for (uint32_t i = 1; i < n; i++) {
        most = layers[i].cover > layers[most].cover ? i : most;
    }
    if (n > 0) { /* what covers most */
        *hit = layers[most];
    }
    return n > 0;
}

uint32_t aset_query_layers(query_hit layers[QUERY_LAYERS_MAX], const aset_tracer *tracer, aset_vec3 origin,
                           aset_vec3 direction, bool approximate, bool is_seen, aset_statistics *statistics) {
    return answers_of(tracer, approximate)->meet(layers, tracer, origin, direction, REAL_INFINITY, is_seen, statistics);
}

bool aset_query_any(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, bool approximate,
                    aset_real t_last, aset_statistics *statistics) {
    return answers_of(tracer, approximate)->any(tracer, origin, direction, t_max, t_last, statistics);
}

void aset_query_surface(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit,
                        aset_vec3 direction) {
    surface->t = hit->t;
    surface->point = vec_along(hit->near, hit->t_near, direction);
    surface->object = hit->object;
    surface->cell = 0;
    hit->by->surface(surface, own, tracer, hit);
    if (!(vec_largest(surface->geometric) > 0)) { /* a sphere smaller than its place can be told: it faces the ray */
        surface->normal = surface->geometric = vec_scale(direction, -1);
    }
}

bool aset_query_can(const aset_tracer *tracer, bool approximate) {
    if (tracer->scene == NULL) {
        return false;
    }
#if ASET_WITH_DRAFTS
    if (approximate && tracer->draft != NULL) {
        return tracer->draft->answers != NULL;
    }
#endif
#if ASET_WITH_APPROXIMATION
    if (tracer->space == NULL) {
        return false;
    }
    return approximate ? tracer->summary != NULL : !tracer->space->is_flat;
#else
    return tracer->space != NULL && !approximate;
#endif
}

bool aset_query_unit(aset_vec3 *direction, aset_real *length, const aset_ray *ray) {
    *direction = aset_vec_unit_length(ray->direction, length);
    return vec_finite(ray->origin) && vec_finite(ray->direction) && real_finite(*length) && *length > 0;
}

/* A caller's ray, checked; its direction in unit length. length: of the caller's direction. */
static aset_status accept_ray(const aset_tracer *tracer, const aset_ray *ray, bool approximate, aset_vec3 *direction,
                              aset_real *length) {
    bool fine = tracer != NULL && ray != NULL && aset_query_can(tracer, approximate) && aset_query_unit(direction, length, ray) &&
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
    *found = aset_query_closest(&q, tracer, ray->origin, direction, ray->t_max * length, approximate,
                                statistics != NULL ? statistics : &ignored);
    if (*found) {
        aset_material own;
        aset_query_surface(hit, &own, tracer, &q, direction);
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
        *found = aset_query_any(tracer, ray->origin, direction, ray->t_max * length, approximate, REAL_INFINITY,
                                statistics != NULL ? statistics : &ignored);
    }
    return status;
}
