/*
 * emit.c - from the procedural scenes' doubles to a sink's entities. The one place where they are rounded to aset_real.
 */
#include "emit.h"

static aset_vec3 rounded(const emit_point *point) {
    aset_vec3 result;
    result.x = (aset_real)point->x;
    result.y = (aset_real)point->y;
    result.z = (aset_real)point->z;
    return result;
}

aset_status aset_emit_size(uint32_t *size, uint32_t default_size, uint32_t largest_size) {
    if (*size == 0) {
        *size = default_size;
    }
    return *size <= largest_size ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_emit_background(const aset_sink *sink, double r, double g, double b) {
    aset_colour colour;
    if (sink == NULL || sink->background == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    colour.r = (aset_real)r;
    colour.g = (aset_real)g;
    colour.b = (aset_real)b;
    return sink->background(sink->context, &colour);
}

aset_status aset_emit_view(const aset_sink *sink, const emit_point *from, const emit_point *at, const emit_point *up,
                           double angle_deg, uint32_t size_px) {
    aset_view view;
    if (sink == NULL || sink->view == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    view.from = rounded(from);
    view.at = rounded(at);
    view.up = rounded(up);
    view.angle_deg = (aset_real)angle_deg;
    view.height = 0;
    view.width_px = size_px;
    view.height_px = size_px;
    return sink->view(sink->context, &view);
}

aset_status aset_emit_light(const aset_sink *sink, const emit_point *position) {
    aset_light light;
    if (sink == NULL || sink->light == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    light.position = rounded(position);
    light.colour.r = light.colour.g = light.colour.b = 0;
    light.has_colour = false;
    light.directional = false;
    return sink->light(sink->context, &light);
}

aset_status aset_emit_material(const aset_sink *sink, const emit_surface *surface) {
    aset_material material;
    if (sink == NULL || sink->material == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    material.fill.r = (aset_real)surface->r;
    material.fill.g = (aset_real)surface->g;
    material.fill.b = (aset_real)surface->b;
    material.diffuse = (aset_real)surface->diffuse;
    material.specular = (aset_real)surface->specular;
    material.shine = (aset_real)surface->shine;
#if ASET_WITH_REFRACTION
    material.transmittance = (aset_real)surface->transmittance;
    material.refraction_index = (aset_real)surface->refraction_index;
#else
    if (surface->transmittance > 0) {
        return ASET_ERR_UNSUPPORTED;
    }
#endif
    material.one_sided = false;
    return sink->material(sink->context, &material);
}

#if ASET_WITH_POLYGONS
aset_status aset_emit_polygon(const aset_sink *sink, const emit_point *points, const emit_point *normals,
                              uint32_t n_points) {
    aset_status status;
    if (!ASET_WITH_PATCHES && normals != NULL) {
        return ASET_ERR_UNSUPPORTED;
    }
    if (sink == NULL || sink->polygon_begin == NULL || sink->polygon_point == NULL || sink->polygon_end == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    status = sink->polygon_begin(sink->context, n_points, normals != NULL);
    for (uint32_t i = 0; i < n_points && status == ASET_OK; i++) {
        aset_vec3 point = rounded(&points[i]);
        if (normals != NULL) {
            aset_vec3 normal = rounded(&normals[i]);
            status = sink->polygon_point(sink->context, &point, &normal);
        } else {
            status = sink->polygon_point(sink->context, &point, NULL);
        }
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
}
#else
aset_status aset_emit_polygon(const aset_sink *sink, const emit_point *points, const emit_point *normals,
                              uint32_t n_points) {
    (void)sink, (void)points, (void)normals, (void)n_points;
    return ASET_ERR_UNSUPPORTED;
}
#endif

#if ASET_WITH_SPHERES
aset_status aset_emit_sphere(const aset_sink *sink, const emit_point *centre, double radius) {
    aset_vec3 point;
    if (sink == NULL || sink->sphere == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    point = rounded(centre);
    return sink->sphere(sink->context, &point, (aset_real)radius);
}
#else
aset_status aset_emit_sphere(const aset_sink *sink, const emit_point *centre, double radius) {
    (void)sink, (void)centre, (void)radius;
    return ASET_ERR_UNSUPPORTED;
}
#endif

#if ASET_WITH_CONES
aset_status aset_emit_cone(const aset_sink *sink, const emit_point *base, double base_radius, const emit_point *apex,
                           double apex_radius) {
    aset_vec3 low, high;
    if (sink == NULL || sink->cone == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    low = rounded(base);
    high = rounded(apex);
    return sink->cone(sink->context, &low, (aset_real)base_radius, &high, (aset_real)apex_radius);
}
#else
aset_status aset_emit_cone(const aset_sink *sink, const emit_point *base, double base_radius, const emit_point *apex,
                           double apex_radius) {
    (void)sink, (void)base, (void)base_radius, (void)apex, (void)apex_radius;
    return ASET_ERR_UNSUPPORTED;
}
#endif

aset_status aset_emit_setting(const aset_sink *sink, const emit_setting *setting) {
    aset_status status = aset_emit_background(sink, 0.078, 0.361, 0.753);
    if (status == ASET_OK) {
        status = aset_emit_view(sink, &setting->from, &setting->at, &setting->up, 45.0, 512);
    }
    for (uint32_t i = 0; i < setting->n_lights && status == ASET_OK; i++) {
        status = aset_emit_light(sink, &setting->lights[i]);
    }
    return status;
}
