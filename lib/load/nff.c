/*
 * nff.c - the Neutral File Format (Eric Haines, "A Proposal for Standard Graphics Environments", 1987), read token by token.
 *
 * Nothing of the file is kept but the entity in hand, and of a polygon only the point in hand, so no announced count can ask
 * for memory: a polygon of 10^9 points fails where its points end or where the sink has enough. Every error names a place: a
 * token that cannot be, or the word of an entity that makes no sense as a whole or that the sink refused.
 *
 * Lines are counted but decide nothing: old files set a cone on three lines, current ones on one. So three numbers behind a
 * light's position are its colour wherever they stand; nothing else could begin with a number there. A second view or
 * background is passed on like the first, and the sink keeps which it will.
 */
#include "reader.h"

typedef struct nff {
    aset_reader reader;
    const aset_sink *sink;
    aset_place entity; /* the word of the entity in hand */
    bool one_sided_opaque, has_view, has_material;
} nff;

/* ---- errors and numbers ---- */

/* An entity that is wrong as a whole. */
static aset_status fail_entity(nff *file, aset_status status, const char *what) {
    return aset_reader_fail_at(&file->reader, &file->entity, status, what, NULL);
}

/* Passes on what the sink said; degenerate is the sentence for geometry that it refused. */
static aset_status answer(nff *file, aset_status status, const char *degenerate) {
    const char *what = "the sink refused it";
    switch (status) {
    case ASET_OK:
        return ASET_OK;
    case ASET_ERR_GEOMETRY:
        what = degenerate;
        break;
    case ASET_ERR_NOMEM:
        what = "it does not fit in the arena's limits";
        break;
    case ASET_ERR_LIMIT:
        what = "more than the library can count";
        break;
    case ASET_ERR_UNSUPPORTED:
        what = "it was switched off when the library was compiled";
        break;
    case ASET_ERR_STOPPED:
        what = "the sink asked to stop";
        break;
    default:
        break;
    }
    return fail_entity(file, status, what);
}

static aset_status read_numbers(nff *file, aset_real *to, uint32_t n, const char *expected) {
    aset_status status = ASET_OK;
    for (uint32_t i = 0; i < n && status == ASET_OK; i++) {
        status = aset_reader_real(&file->reader, &to[i], expected);
    }
    return status;
}

/* Numbers of 0 or more. Those above 1 pass, for colours and shares too: real files have them. */
static aset_status read_amounts(nff *file, aset_real *to, uint32_t n, const char *expected) {
    for (uint32_t i = 0; i < n; i++) {
        const aset_status status = aset_reader_real(&file->reader, &to[i], expected);
        if (status != ASET_OK) {
            return status;
        }
        if (to[i] < 0) {
            return aset_reader_fail(&file->reader, ASET_ERR_SYNTAX, "a negative number where none can be", expected);
        }
    }
    return ASET_OK;
}

static aset_status read_point(nff *file, aset_vec3 *point, const char *expected) {
    aset_real x[3];
    const aset_status status = read_numbers(file, x, 3, expected);
    if (status == ASET_OK) {
        *point = (aset_vec3){x[0], x[1], x[2]};
    }
    return status;
}

static aset_status read_colour(nff *file, aset_colour *colour, const char *expected) {
    aset_real x[3];
    const aset_status status = read_amounts(file, x, 3, expected);
    if (status == ASET_OK) {
        *colour = (aset_colour){x[0], x[1], x[2]};
    }
    return status;
}

/* ---- the view ---- */

enum { PART_FROM, PART_AT, PART_UP, PART_ANGLE, PART_HITHER, PART_RESOLUTION, N_PARTS };

static const struct {
    const char *word, *form;
} view_parts[N_PARTS] = {
    {"from", "from x y z"},
    {"at", "at x y z"},
    {"up", "up x y z"},
    {"angle", "angle, in degrees, above 0 and below 180"},
    {"hither", "hither d"},
    {"resolution", "resolution, two whole numbers from 1 to 65535"},
};

static aset_status read_angle(nff *file, aset_view *view, const char *form) {
    const aset_status status = aset_reader_real(&file->reader, &view->angle_deg, form);
    if (status == ASET_OK && !(view->angle_deg > 0 && view->angle_deg < 180)) {
        return aset_reader_fail(&file->reader, ASET_ERR_SYNTAX, "an angle that no picture can have", form);
    }
    return status;
}

static aset_status read_resolution(nff *file, aset_view *view, const char *form) {
    const char *outside = "a resolution outside 1 to 65535";
    const aset_status status = aset_reader_whole(&file->reader, &view->width_px, 1, 65535, outside, form);
    return status != ASET_OK ? status : aset_reader_whole(&file->reader, &view->height_px, 1, 65535, outside, form);
}

static aset_status read_view_part(nff *file, int part, aset_view *view) {
    const char *form = view_parts[part].form;
    aset_real hither;
    switch (part) {
    case PART_FROM:
        return read_point(file, &view->from, form);
    case PART_AT:
        return read_point(file, &view->at, form);
    case PART_UP:
        return read_point(file, &view->up, form);
    case PART_ANGLE:
        return read_angle(file, view, form);
    case PART_RESOLUTION:
        return read_resolution(file, view, form);
    default: /* for hidden-surface programs only */
        return read_numbers(file, &hither, 1, form);
    }
}

/* The part that the current token names, or N_PARTS. */
static int view_part(const aset_reader *reader) {
    int part = 0;
    while (part < N_PARTS && !aset_reader_is(reader, view_parts[part].word)) {
        part++;
    }
    return part;
}

/* The first part that a view must have and that is not among seen, one bit for each; N_PARTS if there is none. */
static int missing_part(unsigned seen) {
    int part = 0;
    while (part < N_PARTS && (part == PART_HITHER || (seen >> part & 1u) != 0)) {
        part++;
    }
    return part;
}

/* Reads parts as long as the next token names one. */
static aset_status read_view_parts(nff *file, aset_view *view) {
    aset_reader *reader = &file->reader;
    unsigned seen = 0;
    for (;;) {
        aset_status status = aset_reader_keep(reader);
        if (status != ASET_OK) {
            return status;
        }
        const int part = view_part(reader), missing = missing_part(seen);
        if (part == N_PARTS && missing == N_PARTS) {
            return ASET_OK;
        }
        if (part == N_PARTS) {
            const char *what = reader->length == 0 ? reader->cut : "a view is not complete before this";
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, what, view_parts[missing].form);
        }
        if ((seen >> part & 1u) != 0) {
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "a part that the view already has", NULL);
        }
        seen |= 1u << part;
        status = aset_reader_next(reader); /* the word that was kept */
        if (status == ASET_OK) {
            status = read_view_part(file, part, view);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

/*
 * The least sine of the angle between up and the view direction. The six digits of a file leave parallel vectors several
 * 1e-6 apart, and in float a sine of 1e-5 leaves the picture's horizontal two digits.
 */
#define LEAST_UP_SINE 1e-5

static double magnitude(double x) {
    return x < 0 ? -x : x;
}

/* Scales x so that its largest coordinate is 1, so that products neither overflow nor vanish. False: x is 0. */
static bool scale_to_one(double x[3]) {
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        largest = magnitude(x[i]) > largest ? magnitude(x[i]) : largest;
    }
    for (int i = 0; i < 3 && largest > 0; i++) {
        x[i] /= largest;
    }
    return largest > 0;
}

/* Why there is no picture from this view, or NULL. */
static const char *view_fault(const aset_view *view) {
    const aset_vec3 *from = &view->from, *at = &view->at;
    /* halves, as the difference of two doubles may overflow */
    double along[3] = {(double)at->x / 2 - (double)from->x / 2, (double)at->y / 2 - (double)from->y / 2,
                       (double)at->z / 2 - (double)from->z / 2};
    double up[3] = {(double)view->up.x, (double)view->up.y, (double)view->up.z};
    if (!scale_to_one(along)) {
        return "zero view vector: from and at are the same point";
    }
    if (!scale_to_one(up)) {
        return "zero up vector";
    }
    double cross_squared = 0, along_squared = 0, up_squared = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double cross = along[j] * up[k] - along[k] * up[j];
        cross_squared += cross * cross;
        along_squared += along[i] * along[i];
        up_squared += up[i] * up[i];
    }
    if (cross_squared <= LEAST_UP_SINE * LEAST_UP_SINE * along_squared * up_squared) {
        return "up is parallel to the view direction";
    }
    return NULL;
}

static aset_status read_view(nff *file) {
    aset_view view = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0};
    file->reader.cut = "the file ends within a view";
    const aset_status status = read_view_parts(file, &view);
    if (status != ASET_OK) {
        return status;
    }
    const char *fault = view_fault(&view);
    if (fault != NULL) {
        return fail_entity(file, ASET_ERR_GEOMETRY, fault);
    }
    file->has_view = true;
    return answer(file, file->sink->view(file->sink->context, &view), "degenerate view");
}

/* ---- background, light, material ---- */

static aset_status read_background(nff *file) {
    aset_colour colour;
    file->reader.cut = "the file ends within a background";
    const aset_status status = read_colour(file, &colour, "b r g b");
    if (status != ASET_OK) {
        return status;
    }
    return answer(file, file->sink->background(file->sink->context, &colour), "a background that is not finite");
}

static aset_status read_light(nff *file) {
    const char *form = "l x y z, or l x y z r g b";
    aset_light light = {{0, 0, 0}, {0, 0, 0}, false, false};
    file->reader.cut = "the file ends within a light";
    aset_status status = read_point(file, &light.position, form);
    if (status == ASET_OK) {
        status = aset_reader_keep(&file->reader);
    }
    if (status == ASET_OK && aset_reader_is_numeric(&file->reader)) {
        light.has_colour = true;
        status = read_colour(file, &light.colour, form);
    }
    if (status != ASET_OK) {
        return status;
    }
    return answer(file, file->sink->light(file->sink->context, &light), "a light that is not finite");
}

static aset_status read_material(nff *file) {
    const char *form = "f r g b Kd Ks shine T ior";
    aset_material material;
    aset_real surface[3], transmittance, refraction_index;
    file->reader.cut = "the file ends within a material";
    aset_status status = read_colour(file, &material.fill, form);
    if (status == ASET_OK) {
        status = read_amounts(file, surface, 3, form);
    }
    if (status == ASET_OK) {
        status = read_amounts(file, &transmittance, 1, form);
    }
#if !ASET_WITH_REFRACTION
    if (status == ASET_OK && transmittance > 0) {
        return aset_reader_fail(&file->reader, ASET_ERR_UNSUPPORTED,
                                "transmission was switched off when the library was compiled", "T = 0");
    }
#endif
    if (status == ASET_OK) {
        status = read_amounts(file, &refraction_index, 1, form);
    }
    if (status != ASET_OK) {
        return status;
    }
    material.diffuse = surface[0];
    material.specular = surface[1];
    material.shine = surface[2];
#if ASET_WITH_REFRACTION
    material.transmittance = transmittance;
    material.refraction_index = refraction_index;
#endif
    material.one_sided = file->one_sided_opaque && !(transmittance > 0);
    file->has_material = true;
    return answer(file, file->sink->material(file->sink->context, &material), "a material that is not finite");
}

/* ---- objects ---- */

#if !(ASET_WITH_POLYGONS && ASET_WITH_PATCHES && ASET_WITH_SPHERES && ASET_WITH_CONES)
static aset_status switched_off(nff *file, const char *what) {
    return fail_entity(file, ASET_ERR_UNSUPPORTED, what);
}
#endif

#if ASET_WITH_OBJECTS
/* Before an object: what it is seen by and made of. cut as in the reader. */
static aset_status begin_object(nff *file, const char *cut) {
    file->reader.cut = cut;
    if (!file->has_view) {
        return aset_reader_fail(&file->reader, ASET_ERR_SYNTAX, "an object before the view", "v");
    }
    if (!file->has_material) {
        return aset_reader_fail(&file->reader, ASET_ERR_SYNTAX, "an object before any material", "f");
    }
    return ASET_OK;
}
#endif

#if ASET_WITH_CONES
static aset_status read_cone(nff *file) {
    const char *form = "c base.x base.y base.z base_radius apex.x apex.y apex.z apex_radius";
    aset_real x[8];
    aset_status status = begin_object(file, "the file ends within a cone");
    if (status == ASET_OK) {
        status = read_numbers(file, x, 8, form);
    }
    if (status != ASET_OK) {
        return status;
    }
    const aset_vec3 base = {x[0], x[1], x[2]}, apex = {x[4], x[5], x[6]};
    return answer(file, file->sink->cone(file->sink->context, &base, x[3], &apex, x[7]),
                  "degenerate cone: no length, no radius, radii of different sign, or a number beyond 10^30");
}
#else
static aset_status read_cone(nff *file) {
    return switched_off(file, "cones were switched off when the library was compiled");
}
#endif

#if ASET_WITH_SPHERES
static aset_status read_sphere(nff *file) {
    aset_real x[4];
    aset_status status = begin_object(file, "the file ends within a sphere");
    if (status == ASET_OK) {
        status = read_numbers(file, x, 4, "s x y z radius");
    }
    if (status != ASET_OK) {
        return status;
    }
    const aset_vec3 centre = {x[0], x[1], x[2]};
    return answer(file, file->sink->sphere(file->sink->context, &centre, x[3]), "degenerate sphere: its radius is 0, or a number beyond 10^30");
}
#else
static aset_status read_sphere(nff *file) {
    return switched_off(file, "spheres were switched off when the library was compiled");
}
#endif

#if ASET_WITH_POLYGONS
static aset_status read_points(nff *file, uint32_t n_points, bool with_normals, const char *degenerate) {
    const char *form = with_normals ? "x y z and normal x y z of each point" : "x y z of each point";
    for (uint32_t i = 0; i < n_points; i++) {
        aset_vec3 point, normal;
        aset_status status = read_point(file, &point, form);
        if (status == ASET_OK && with_normals) {
            status = read_point(file, &normal, form);
        }
        if (status != ASET_OK) {
            return status;
        }
        status = file->sink->polygon_point(file->sink->context, &point, with_normals ? &normal : NULL);
        if (status != ASET_OK) {
            return answer(file, status, degenerate);
        }
    }
    return ASET_OK;
}

static aset_status read_any_polygon(nff *file, bool with_normals, const char *cut, const char *degenerate) {
    uint32_t n_points;
    aset_status status = begin_object(file, cut);
    if (status == ASET_OK) {
        status = aset_reader_whole(&file->reader, &n_points, 3, UINT32_MAX, "a polygon of fewer than 3 points",
                                   "the number of points, 3 or more");
    }
    if (status != ASET_OK) {
        return status;
    }
    status = file->sink->polygon_begin(file->sink->context, n_points, with_normals);
    if (status != ASET_OK) {
        return answer(file, status, degenerate);
    }
    status = read_points(file, n_points, with_normals, degenerate);
    return status != ASET_OK ? status : answer(file, file->sink->polygon_end(file->sink->context), degenerate);
}

static aset_status read_polygon(nff *file) {
    return read_any_polygon(file, false, "the file ends within a polygon",
                            "a polygon with a number beyond 10^30");
}
#else
static aset_status read_polygon(nff *file) {
    return switched_off(file, "polygons were switched off when the library was compiled");
}
#endif

#if ASET_WITH_PATCHES
static aset_status read_patch(nff *file) {
    return read_any_polygon(file, true, "the file ends within a patch", "a patch with a number beyond 10^30");
}
#else
static aset_status read_patch(nff *file) {
    return switched_off(file, "patches were switched off when the library was compiled");
}
#endif

/* ---- the file ---- */

static const struct {
    const char *word;
    aset_status (*read)(nff *file);
} entities[] = {
    {"v", read_view}, {"b", read_background}, {"l", read_light},   {"f", read_material},
    {"c", read_cone}, {"s", read_sphere},     {"p", read_polygon}, {"pp", read_patch},
};

/* Reads the entity whose word is the current token. */
static aset_status read_entity(nff *file) {
    for (size_t i = 0; i < sizeof entities / sizeof entities[0]; i++) {
        if (aset_reader_is(&file->reader, entities[i].word)) {
            file->entity = aset_reader_place(&file->reader);
            return entities[i].read(file);
        }
    }
    const bool number = aset_reader_is_numeric(&file->reader);
    return aset_reader_fail(&file->reader, ASET_ERR_SYNTAX,
                            number ? "a number where an entity should begin" : "an unknown entity",
                            "one of v b l f c s p pp");
}

aset_status aset_load_nff(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    if (sink == NULL || read == NULL || report == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    nff file;
    aset_reader_init(&file.reader, read, context, report);
    file.sink = sink;
    file.one_sided_opaque = options != NULL && options->one_sided_opaque;
    file.has_view = file.has_material = false;
    aset_status status = aset_reader_skip_mark(&file.reader);
    for (bool empty = true; status == ASET_OK; empty = false) {
        status = aset_reader_next(&file.reader);
        if (status == ASET_OK && file.reader.length == 0) {
            if (file.has_view) {
                return ASET_OK;
            }
            return aset_reader_fail(&file.reader, ASET_ERR_SYNTAX, empty ? "the file is empty" : "the file has no view",
                                    "v");
        }
        if (status == ASET_OK) {
            status = read_entity(&file);
        }
    }
    return status;
}
