/*
 * nff.c - a sink that writes the Neutral File Format (Haines 1987), laid out like the files of the SPD programs: b,
 * the block of v, all l, then f and objects, one entity after another.
 *
 * Invariant: background and view are held or written, never lost: whatever needs them first flushes both, b before v.
 * NFF has no place for a view behind the objects, so the first object needs one.
 */
#include "tool.h"

#include <errno.h>
#include <math.h>

#define DEFAULT_SIDE_PX 512u

/* SPD files carry six significant digits; a real number of 24 bits holds a little over seven. */
static void write_numbers(FILE *stream, const char *key, const aset_real *numbers, unsigned n) {
    (void)fputs(key, stream);
    for (unsigned i = 0; i < n; i++) {
        (void)fprintf(stream, "%s%g", i == 0 && key[0] == '\0' ? "" : " ", (double)numbers[i]);
    }
    (void)fputc('\n', stream);
}

static aset_status line_status(tool_nff *nff) {
    if (ferror(nff->stream) == 0) {
        return ASET_OK;
    }
    if (nff->error == 0) {
        nff->error = errno != 0 ? errno : EIO;
    }
    return ASET_ERR_STOPPED;
}

/* One line: the key and its numbers. ASET_ERR_GEOMETRY, and nothing written, if one is not finite. */
static aset_status write_line(tool_nff *nff, const char *key, const aset_real *numbers, unsigned n) {
    for (unsigned i = 0; i < n; i++) {
        if (!isfinite(numbers[i])) {
            return ASET_ERR_GEOMETRY;
        }
    }
    write_numbers(nff->stream, key, numbers, n);
    return line_status(nff);
}

static aset_status write_vec3(tool_nff *nff, const char *key, const aset_vec3 *vector) {
    const aset_real numbers[3] = {vector->x, vector->y, vector->z};
    return write_line(nff, key, numbers, 3);
}

static aset_status write_view(tool_nff *nff, const aset_view *view) {
    const aset_real angle = view->angle_deg;
    (void)fputs("v\n", nff->stream);
    aset_status status = write_vec3(nff, "from", &view->from);
    if (status == ASET_OK) {
        status = write_vec3(nff, "at", &view->at);
    }
    if (status == ASET_OK) {
        status = write_vec3(nff, "up", &view->up);
    }
    if (status == ASET_OK) {
        status = write_line(nff, "angle", &angle, 1);
    }
    if (status != ASET_OK) {
        return status;
    }
    bool has_size = view->width_px > 0 && view->height_px > 0;
    (void)fprintf(nff->stream, "hither %g\nresolution %lu %lu\n", nff->hither,
                  (unsigned long)(has_size ? view->width_px : DEFAULT_SIDE_PX),
                  (unsigned long)(has_size ? view->height_px : DEFAULT_SIDE_PX));
    nff->view_written = true;
    return line_status(nff);
}

static aset_status write_held(tool_nff *nff) {
    aset_status status = ASET_OK;
    if (nff->background_held) {
        const aset_real numbers[3] = {nff->background.r, nff->background.g, nff->background.b};
        nff->background_held = false;
        status = write_line(nff, "b", numbers, 3);
    }
    if (status == ASET_OK && nff->view_held) {
        nff->view_held = false;
        status = write_view(nff, &nff->view);
    }
    return status;
}

/* What every object asks first. */
static aset_status before_object(tool_nff *nff) {
    aset_status status = write_held(nff);
    if (status == ASET_OK && (!nff->view_written || !nff->material_written || nff->n_left > 0)) {
        status = ASET_ERR_ARGUMENT;
    }
    return status;
}

static aset_status take_background(void *context, const aset_colour *colour) {
    tool_nff *nff = context;
    nff->background = *colour;
    nff->background_held = true;
    return ASET_OK;
}

static aset_status take_view(void *context, const aset_view *view) {
    tool_nff *nff = context;
    if (view->height != 0) {
        return ASET_ERR_UNSUPPORTED;
    }
    nff->view = *view;
    nff->view_held = true;
    return ASET_OK;
}

static aset_status take_light(void *context, const aset_light *light) {
    tool_nff *nff = context;
    const aset_real numbers[6] = {light->position.x, light->position.y, light->position.z,
                                  light->colour.r,   light->colour.g,   light->colour.b};
    if (light->directional) {
        return ASET_ERR_UNSUPPORTED;
    }
    aset_status status = write_held(nff);
    return status == ASET_OK ? write_line(nff, "l", numbers, light->has_colour ? 6 : 3) : status;
}

static aset_status take_material(void *context, const aset_material *material) {
    tool_nff *nff = context;
    aset_real numbers[8] = {material->fill.r,  material->fill.g,   material->fill.b, material->diffuse,
                            material->specular, material->shine, 0, 0};
#if ASET_WITH_REFRACTION
    numbers[6] = material->transmittance;
    numbers[7] = material->refraction_index;
#endif
    if (material->one_sided) {
        return ASET_ERR_UNSUPPORTED;
    }
    aset_status status = write_held(nff);
    if (status == ASET_OK) {
        status = write_line(nff, "f", numbers, 8);
        nff->material_written = status == ASET_OK;
    }
    return status;
}

#if ASET_WITH_POLYGONS
static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    tool_nff *nff = context;
    aset_status status = before_object(nff);
    if (status != ASET_OK) {
        return status;
    }
    if (n_points < 3) {
        return ASET_ERR_GEOMETRY;
    }
    nff->n_left = n_points;
    nff->with_normals = with_normals;
    (void)fprintf(nff->stream, "%s %lu\n", with_normals ? "pp" : "p", (unsigned long)n_points);
    return line_status(nff);
}

static aset_status take_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    tool_nff *nff = context;
    if (nff->n_left == 0 || nff->with_normals != (normal != NULL)) {
        return ASET_ERR_ARGUMENT;
    }
    nff->n_left--;
    if (normal == NULL) {
        return write_vec3(nff, "", point);
    }
    const aset_real numbers[6] = {point->x, point->y, point->z, normal->x, normal->y, normal->z};
    return write_line(nff, "", numbers, 6);
}

static aset_status take_polygon_end(void *context) {
    const tool_nff *nff = context;
    return nff->n_left == 0 ? ASET_OK : ASET_ERR_ARGUMENT;
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    tool_nff *nff = context;
    const aset_real numbers[4] = {centre->x, centre->y, centre->z, radius};
    aset_status status = before_object(nff);
    return status == ASET_OK ? write_line(nff, "s", numbers, 4) : status;
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    tool_nff *nff = context;
    const aset_real numbers[8] = {base->x, base->y, base->z, base_radius, apex->x, apex->y, apex->z, apex_radius};
    aset_status status = before_object(nff);
    return status == ASET_OK ? write_line(nff, "c", numbers, 8) : status;
}
#endif

aset_sink tool_nff_sink(tool_nff *nff, FILE *stream, double hither) {
    const tool_nff fresh = {.stream = stream, .hither = hither};
    *nff = fresh;
    aset_sink sink = {
        .context = nff,
        .background = take_background,
        .view = take_view,
        .light = take_light,
        .material = take_material,
#if ASET_WITH_POLYGONS
        .polygon_begin = take_polygon_begin,
        .polygon_point = take_polygon_point,
        .polygon_end = take_polygon_end,
#endif
#if ASET_WITH_SPHERES
        .sphere = take_sphere,
#endif
#if ASET_WITH_CONES
        .cone = take_cone,
#endif
    };
    return sink;
}

aset_status tool_nff_end(tool_nff *nff) {
    return nff->n_left == 0 ? write_held(nff) : ASET_ERR_ARGUMENT;
}
