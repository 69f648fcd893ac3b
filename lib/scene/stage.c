/*
 * stage.c - view, lights and ground for a model's box.
 *
 * Everything is placed relative to a sphere around the box, so one rule serves flat, tall and round models alike, and a
 * model that is scaled or moved gives the same picture. The square root is all that comes from libm.
 */
#include "aset/stage.h"

#include "scene/shape.h"

#include <float.h>
#include <string.h>

/* The tangent of half the view's angle of 30 degrees. */
#define TANGENT_15 R(0.26794919243112270)
#define ANGLE_DEG R(30)

/* A radius below this is no extent: squares of it come near the least numbers there are. */
#if ASET_REAL_BITS == 32
#define RADIUS_LEAST R(1e-17)
#else
#define RADIUS_LEAST R(1e-150)
#endif
/*
 * Of the largest coordinate: with less, points of the stage would round to the same ones; in float whatever aset_real is, for
 * a draft's words are floats.
 */
#define RADIUS_SHARE R(128 * (FLT_EPSILON / 2))

typedef struct stage {
    const aset_sink *sink;
    aset_up up;
    aset_vec3 centre;
    aset_real radius, lowest;
} stage;

/* A direction from the right, up and to the front. */
INLINE_BUT_FOR_SIZE aset_vec3 turned(const stage *s, aset_real right, aset_real up, aset_real front) {
    return s->up == ASET_UP_Z ? vec(right, -front, up) : vec(right, up, front);
}

static aset_real radius_of(aset_vec3 low, aset_vec3 high, aset_vec3 centre) {
    aset_real radius = aset_vec_length(vec_sub(high, low)) / 2;
    radius = real_max(radius, vec_largest(centre) * RADIUS_SHARE);
    return radius >= RADIUS_LEAST ? radius : 1;
}

static aset_status emit_background(const stage *s) {
    static const aset_colour sky = {R(0.80), R(0.84), R(0.90)};
    return s->sink->background(s->sink->context, &sky);
}

/* A sphere fits in a cone if its radius is the distance times the sine of the cone's half angle. */
static aset_status emit_view(const stage *s, aset_real aspect) {
    aset_real tangent = TANGENT_15 * real_min(aspect, 1);
    aset_real distance = s->radius * real_sqrt(1 + tangent * tangent) / tangent;
    aset_view view;
    memset(&view, 0, sizeof view);
    view.at = s->centre;
    view.from = vec_along(s->centre, distance, aset_vec_unit(turned(s, R(-0.5), R(0.4), 1)));
    view.up = turned(s, 0, 1, 0);
    view.angle_deg = ANGLE_DEG;
    return s->sink->view(s->sink->context, &view);
}

/* A key light from the left, and a dim one from the right and the front. */
static aset_status emit_lights(const stage *s) {
    static const struct {
        aset_real right, up, front, brightness;
    } lights[] = {{R(-1.2), R(1.6), R(0.8), R(0.85)}, {R(1.2), R(0.8), R(1.6), R(0.3)}};
    aset_status status = ASET_OK;
    for (int i = 0; i < 2 && status == ASET_OK; i++) {
        aset_light light;
        memset(&light, 0, sizeof light);
        light.position = vec_along(s->centre, 4 * s->radius, turned(s, lights[i].right, lights[i].up, lights[i].front));
        light.colour.r = light.colour.g = light.colour.b = lights[i].brightness;
        light.has_colour = true;
        status = s->sink->light(s->sink->context, &light);
    }
    return status;
}

static aset_status emit_ground(const stage *s) {
#if ASET_WITH_POLYGONS
    aset_material grey;
    aset_vec3 corners[4], middle = s->centre;
    /* right, front: counter-clockwise from above */
    static const signed char at[4][2] = {{-3, 3}, {3, 3}, {3, -3}, {-3, -3}};
    memset(&grey, 0, sizeof grey);
    grey.fill.r = grey.fill.g = grey.fill.b = R(0.62);
    grey.diffuse = 1;
    *(s->up == ASET_UP_Z ? &middle.z : &middle.y) = s->lowest - s->radius / 1024;
    for (int i = 0; i < 4; i++) {
        corners[i] = vec_along(middle, s->radius, turned(s, at[i][0], 0, at[i][1]));
    }
    aset_status status = s->sink->material(s->sink->context, &grey);
    return status == ASET_OK ? aset_sink_polygon(s->sink, corners, NULL, 4) : status;
#else
    (void)s;
    return ASET_ERR_UNSUPPORTED;
#endif
}

aset_material aset_stage_material(void) {
    aset_material material;
    memset(&material, 0, sizeof material);
    material.fill.r = R(0.80);
    material.fill.g = R(0.75);
    material.fill.b = R(0.68);
    material.diffuse = 1;
    return material;
}

aset_status aset_stage_emit(const aset_sink *sink, const aset_vec3 *low, const aset_vec3 *high,
                            const aset_stage_options *options) {
    static const aset_stage_options defaults;
    const aset_stage_options *o = options != NULL ? options : &defaults;
    if (sink == NULL || low == NULL || high == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_real aspect = o->aspect != 0 ? o->aspect : 1;
    bool is_box = vec_finite(*low) && vec_finite(*high) && low->x <= high->x && low->y <= high->y && low->z <= high->z;
    if (!is_box || !(aspect > 0) || !real_finite(aspect) || (o->up != ASET_UP_Y && o->up != ASET_UP_Z)) {
        return ASET_ERR_ARGUMENT;
    }
    if (!aset_box_is_precise(*low, *high)) { /* a scene would say so too, but not with the ground */
        return ASET_ERR_PRECISION;
    }
    stage s;
    s.sink = sink;
    s.up = o->up;
    s.centre = vec_along(*low, R(0.5), vec_sub(*high, *low));
    s.radius = radius_of(*low, *high, s.centre);
    s.lowest = s.up == ASET_UP_Z ? low->z : low->y;
    aset_status status = emit_background(&s);
    status = status == ASET_OK ? emit_view(&s, aspect) : status;
    status = status == ASET_OK ? emit_lights(&s) : status;
    return status == ASET_OK && !o->no_ground ? emit_ground(&s) : status;
}
