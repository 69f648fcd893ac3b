/* emit.c - a scene as a source: what was put into it goes into another sink, in the same order. */
#include "scene/shape.h"

#if ASET_WITH_POLYGONS
static aset_status emit_outline(const aset_sink *sink, const shape *s, aset_real per_scale, bool with_normals) {
    uint32_t stride = with_normals ? 6 : 3, n;
    const aset_real *at = aset_polygon_points(s->at, s->n, stride, &n);
    aset_status status = sink->polygon_begin(sink->context, n, with_normals);
    for (; n > 0 && status == ASET_OK; n--, at += stride) {
        aset_vec3 point = vec_scale(vec(at[0], at[1], at[2]), per_scale), normal = vec(0, 0, 0);
        if (with_normals) {
            normal = vec(at[3], at[4], at[5]);
        }
        status = sink->polygon_point(sink->context, &point, with_normals ? &normal : NULL);
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
}
#endif

/* per_scale: from the scene's own lengths to the caller's. */
static aset_status emit_object(const aset_sink *sink, const shape *s, aset_real per_scale) {
    (void)sink, (void)per_scale; /* a library without kinds of objects */
    switch (s->kind) {
#if ASET_WITH_POLYGONS
    case KIND_POLYGON: return emit_outline(sink, s, per_scale, false);
#if ASET_WITH_PATCHES
    case KIND_PATCH: return emit_outline(sink, s, per_scale, true);
#endif
#endif
#if ASET_WITH_SPHERES
    case KIND_SPHERE: {
        aset_vec3 centre = vec_scale(vec(s->at[0], s->at[1], s->at[2]), per_scale);
        return sink->sphere(sink->context, &centre, s->at[3] * per_scale);
    }
#endif
#if ASET_WITH_CONES
    case KIND_CONE: {
        aset_vec3 base = vec_scale(vec(s->at[0], s->at[1], s->at[2]), per_scale);
        aset_vec3 apex = vec_scale(vec(s->at[4], s->at[5], s->at[6]), per_scale);
        return sink->cone(sink->context, &base, s->at[3] * per_scale, &apex, s->at[7] * per_scale);
    }
#endif
    default: return ASET_ERR_UNSUPPORTED;
    }
}

aset_status aset_scene_emit(const aset_sink *sink, const aset_scene *scene) {
    if (sink == NULL || scene == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    const aset_material *material = NULL;
    aset_status status = sink->background(sink->context, &scene->background);
    if (status == ASET_OK && scene->has_view) {
        status = sink->view(sink->context, &scene->view);
    }
    for (uint32_t i = 0; i < scene->counts.lights && status == ASET_OK; i++) {
        status = sink->light(sink->context, scene->lights + i);
    }
    for (uint32_t i = 0; i < scene->counts.objects && status == ASET_OK; i++) {
        shape s = shape_of(scene, i);
        if (s.material != material) {
            material = s.material;
            status = sink->material(sink->context, material);
        }
        status = status == ASET_OK ? emit_object(sink, &s, 1 / scene->scale) : status;
    }
    return status;
}
