/*
 * beam_shade.c - trace.c's and shade.c's arithmetic, number for number, with layers side by side: they are in the innermost loops, and
 * no branch is in these, so that compilers use wide registers. What looks things up goes one by one: facets, materials, the voxels of
 * shadow rays.
 *
 *     rays       0      1   2             of a few beams
 *     layers     0a 0b  1a  2a 2b 2c      in a queue, as many at a time as a beam has rays: point and normal of all;
 *                                         light by light the shadow rays of all, and what it adds to each
 *     sums       0      1   2             += the share of each layer
 */
#include "trace/beam_shade.h"

#include "approx/draft_shadows.h"
#include "trace/reach.h"
#include "trace/shade.h"

#include <string.h>

#if ASET_WITH_DRAFTS && DRAFT_SHADES_BEAMS

#define BEAM_RAYS ((uint32_t)DRAFT_BEAM)

/* aset_query_surface and aset_shading_make, with normals as facet_faces has them. */
static void place(beam_queue *q) {
    aset_real length[DRAFT_BEAM], (*n)[DRAFT_BEAM] = q->normal, (*d)[DRAFT_BEAM] = q->direction;
    if (draft_lane_lengths(length, n) == 0) {
        draft_lanes_divide(n, length);
    } else {
        for (uint32_t i = 0; i < q->n; i++) {
            draft_set_lane(n, i, aset_vec_unit(draft_lane(n, i)));
        }
    }
    EACH_RAY(i) {
        aset_real towards = n[0][i] * d[0][i] + n[1][i] * d[1][i] + n[2][i] * d[2][i], side = towards <= 0 ? R(1) : R(-1);
        aset_real x = q->origin[0][i] + q->t[i] * d[0][i], y = q->origin[1][i] + q->t[i] * d[1][i];
        aset_real z = q->origin[2][i] + q->t[i] * d[2][i];
        n[0][i] *= side;
        n[1][i] *= side;
        n[2][i] *= side;
        q->point[0][i] = x;
        q->point[1][i] = y;
        q->point[2][i] = z;
        q->nudge[i] = (real_max(real_abs(x), real_max(real_abs(y), real_abs(z))) + q->t[i]) * SHADE_NUDGE;
    }
}

/* A light as the layers have it. */
typedef struct lighting {
    aset_real direction[3][DRAFT_BEAM], distance[DRAFT_BEAM], n_dot_l[DRAFT_BEAM]; /* 0 if it is the point itself */
    aset_real start[3][DRAFT_BEAM];                                                /* of its shadow rays */
} lighting;

/* A point's directions, not yet of unit length. How many of the distances are no usual ones. */
static int32_t look_at_point(lighting *restrict l, const beam_queue *restrict q, aset_vec3 light) {
    int32_t unusual = 0;
    EACH_RAY(i) {
        l->direction[0][i] = light.x - q->point[0][i];
        l->direction[1][i] = light.y - q->point[1][i];
        l->direction[2][i] = light.z - q->point[2][i];
    }
    (void)draft_lane_lengths(l->distance, l->direction);
    EACH_RAY(i) {
        unusual += !((l->distance[i] > LIGHT_NEAR) & (l->distance[i] < LIGHT_FAR));
    }
    return unusual;
}

/* aset_light_towards, but for the colour. */
static void look_towards(lighting *restrict l, const beam_queue *restrict q, const aset_scene *scene, const aset_light *light) {
    if (light->directional) {
        aset_vec3 direction = light->position;
        EACH_RAY(i) {
            l->direction[0][i] = direction.x;
            l->direction[1][i] = direction.y;
            l->direction[2][i] = direction.z;
            l->distance[i] = REAL_INFINITY;
        }
        return;
    }
    if (look_at_point(l, q, light->position) == 0) {
        draft_lanes_divide(l->direction, l->distance);
        return;
    }
    for (uint32_t i = 0; i < BEAM_RAYS; i++) {
        light_ray towards = {{0, 0, 0}, 0, {0, 0, 0}}; /* the point may be the light */
        (void)aset_light_towards(&towards, scene, light, vec(q->point[0][i], q->point[1][i], q->point[2][i]));
        draft_set_lane(l->direction, i, towards.direction);
        l->distance[i] = towards.distance;
    }
}

static void start_rays(lighting *restrict l, const beam_queue *restrict q, aset_real least) {
    EACH_RAY(i) {
        aset_real off = real_max(q->nudge[i], least);
        l->n_dot_l[i] = q->normal[0][i] * l->direction[0][i] + q->normal[1][i] * l->direction[1][i] + q->normal[2][i] * l->direction[2][i];
        l->start[0][i] = q->point[0][i] + off * q->normal[0][i];
        l->start[1][i] = q->point[1][i] + off * q->normal[1][i];
        l->start[2][i] = q->point[2][i] + off * q->normal[2][i];
    }
}

/*
 * Which layers' shadow rays must be sent, a bit each: where the light may shine and its shadow is not known yet. known: of the layer
 * before, and then of the last one.
 */
static uint32_t ask(bool *known, draft_shadows *restrict shadows, const lighting *restrict l, const beam_queue *restrict q,
                    bool remembers, const aset_real *restrict last) {
    uint32_t asked = 0;
    EACH_RAY(i) {
        shadows->t_max[i] = l->distance[i];
        shadows->t_last[i] = 0;
    }
    for (uint32_t i = 0; i < q->n; i++) {
        *known = *known && q->same[i] != 0;
        if (l->n_dot_l[i] > 0 && !*known) {
            shadows->t_last[i] = last[i];
            asked |= UINT32_C(1) << i;
            *known = remembers;
        }
    }
    return asked;
}

/* Where on each layer's shadow ray nothing of the draft is left ahead. */
static void find_last(aset_real *restrict last, const lighting *restrict l, const beam_queue *restrict q, const aset_tracer *tracer,
                      uint32_t number) {
    aset_real clearance = aset_query_clearance(tracer);
    reach_points points;
    EACH_RAY(i) {
        last[i] = REAL_INFINITY;
        points.point[0][i] = q->point[0][i];
        points.point[1][i] = q->point[1][i];
        points.point[2][i] = q->point[2][i];
        points.off[i] = real_max(clearance, q->nudge[i]);
        points.distance[i] = l->distance[i];
    }
    if (reach_is_of(tracer, number) && tracer->reach->calls->last_each != NULL) {
        tracer->reach->calls->last_each(last, tracer->reach, number, &points);
    }
}

/* Those of the rays that are asked for which meet something. */
static uint32_t send(draft_shadows *shadows, lighting *l, const aset_draft *draft, uint32_t asked, aset_statistics *statistics) {
    draft_counts counts = {0, 0};
    uint32_t met = aset_draft_shadows_send(shadows, draft, l->start, l->direction, asked, &counts), n_met = bits_count(met);
    statistics->cells_visited += counts.cells;
    statistics->nonempty_visited += counts.nonempty;
    statistics->approx_hits += n_met;
    statistics->shadow += bits_count(asked);
    statistics->shadow_hit += n_met;
    return met;
}

/* Adds what light number `number` gives to the layers. */
static void add_light(aset_colour *colours, beam_queue *q, const drawing *d, uint32_t number) {
    const aset_tracer *tracer = d->tracer;
    const aset_light *light = tracer->scene->lights + number;
    uint32_t bit = number < 32 ? UINT32_C(1) << number : 0;
    bool known = (q->known & bit) != 0, dark = (q->dark & bit) != 0;
    lighting l;
    draft_shadows shadows;
    aset_real last[DRAFT_BEAM];
    look_towards(&l, q, tracer->scene, light);
    start_rays(&l, q, SHADE_SHADOW_SHARE * aset_query_clearance(tracer));
    find_last(last, &l, q, tracer, number);
    uint32_t asked = ask(&known, &shadows, &l, q, bit != 0, last);
    uint32_t met = send(&shadows, &l, tracer->draft, asked, d->statistics);
    light_ray towards = {{0, 0, 0}, 0, light_colour(tracer->scene, light)};
    for (uint32_t i = 0; i < q->n; i++) {
        dark = (asked >> i & 1u) != 0 ? (met >> i & 1u) != 0 : dark;
        if (l.n_dot_l[i] > 0 && !dark) {
            towards.direction = draft_lane(l.direction, i);
            shade_add_light(&colours[i], q->material[i], draft_lane(q->normal, i), draft_lane(q->direction, i), &towards, l.n_dot_l[i]);
        }
    }
    q->known = known ? q->known | bit : q->known & ~bit;
    q->dark = dark ? q->dark | bit : q->dark & ~bit;
}

/* Shades the layers in the queue, which is empty then. */
static void shade_queue(beam_queue *q, const drawing *d) {
    aset_colour colours[DRAFT_BEAM];
    if (q->n == 0) {
        return;
    }
    place(q);
    for (uint32_t i = 0; i < q->n; i++) {
        colours[i] = shade_ambient(q->material[i]);
    }
    for (uint32_t i = 0; i < d->tracer->scene->counts.lights; i++) {
        add_light(colours, q, d, i);
    }
    for (uint32_t i = 0; i < q->n; i++) {
        shade_add(q->sum[i], q->share[i], &colours[i]);
    }
    q->n = 0;
}

static void enter(beam_queue *q, const drawing *d, const beam_sight *sight, uint32_t ray, const draft_layer *layer) {
    const aset_draft *draft = d->tracer->draft;
    uint32_t i = q->n++;
    facet f = facet_read(draft, layer->facet);
    q->share[i] = layer->cover;
    q->t[i] = layer->t;
    draft_set_lane(q->origin, i, draft_lane(sight->origins, ray));
    draft_set_lane(q->direction, i, draft_lane(sight->directions, ray));
    draft_set_lane(q->normal, i, facet_faces(draft, &f));
    q->texture[i] = f.texture;
    if (i > 0 && q->texture[i - 1] == f.texture) {
        q->material[i] = q->material[i - 1];
    } else {
        q->own[i] = aset_draft_material(draft, f.texture);
        q->material[i] = &q->own[i];
    }
}

/* Would any of the layers send rays on? Not at depth 1. */
static bool sends_on(const drawing *d, const beam_sight *sight) {
    const aset_draft *draft = d->tracer->draft;
    if (tracer_depth(d->tracer) == 1) {
        return false;
    }
    for (uint32_t i = 0; i < sight->n; i++) {
        for (uint32_t j = 0; j < sight->met->cover[i].n; j++) {
            aset_material m = aset_draft_texture(draft, sight->met->layers[i][j].facet);
#if ASET_WITH_REFRACTION
            if (m.transmittance > 0) {
                return true;
            }
#endif
#if ASET_WITH_REFLECTION
            if (m.specular > 0) {
                return true;
            }
#endif
            (void)m;
        }
    }
    return false;
}

bool aset_beam_shader_start(beam_shader *shader, const drawing *d) {
    const aset_tracer *tracer = d->tracer;
    if (tracer->spd_rules || tracer->draft->stage.counts.objects > 0 || !aset_policy_approximate(tracer, ASET_SHADOW, 0)) {
        return false;
    }
    shader->d = d;
    shader->n_beams = 0;
    memset(&shader->queue, 0, sizeof shader->queue);
    EACH_RAY(i) { /* layers that are not entered are usual, too */
        shader->queue.normal[0][i] = 1;
    }
    return true;
}

bool aset_beam_shader_add(beam_shader *shader, const beam_sight *sight, gathered *into) {
    const drawing *d = shader->d;
    beam_queue *q = &shader->queue;
    aset_real clearance = aset_query_clearance(d->tracer);
    if (sends_on(d, sight)) {
        return false;
    }
    uint32_t beam = shader->n_beams++;
    shader->into[beam] = into;
    shader->n_rays[beam] = sight->n;
    for (uint32_t i = 0; i < sight->n; i++) {
        const draft_layer *layers = sight->met->layers[i];
        uint32_t n = sight->met->cover[i].n;
        aset_colour *sum = &shader->sum[beam][i];
        aset_real left = 1;
        sum->r = sum->g = sum->b = 0;
        for (uint32_t j = 0; j < n; j++) {
            q->sum[q->n] = sum;
            q->same[q->n] = j > 0 && shade_is_same(layers[j - 1].t, layers[j].t, clearance);
            enter(q, d, sight, i, layers + j);
            left -= layers[j].cover;
            if (q->n == DRAFT_BEAM) {
                shade_queue(q, d);
            }
        }
        shader->left[beam][i] = left > 0 ? left : 0;
        d->statistics->primary_hit += n > 0;
    }
    d->statistics->primary += sight->n;
    if (shader->n_beams == BEAM_SHADER_BEAMS) {
        aset_beam_shader_finish(shader);
    }
    return true;
}

void aset_beam_shader_finish(beam_shader *shader) {
    const aset_colour *background = &shader->d->tracer->scene->background;
    shade_queue(&shader->queue, shader->d);
    for (uint32_t beam = 0; beam < shader->n_beams; beam++) {
        for (uint32_t i = 0; i < shader->n_rays[beam]; i++) {
            aset_real left = shader->left[beam][i];
            if (left > 0) {
                shade_add(&shader->sum[beam][i], left, background);
            }
            aset_drawing_gather(&shader->into[beam][i], shader->sum[beam][i], 1 - left);
        }
    }
    shader->n_beams = 0;
}

#endif
