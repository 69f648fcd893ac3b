/*
 * model.c - what the readers of STL, PLY and OBJ share.
 *
 * The sink hears of a material only when a triangle needs another one than the last, so a file that names materials and uses
 * none emits none.
 */
#include "model.h"

#include <string.h>

#if ASET_WITH_POLYGONS

/* ---- materials ---- */

static void set_default(aset_material *material) {
    memset(material, 0, sizeof *material);
    material->fill.r = material->fill.g = material->fill.b = (aset_real)0.8;
    material->diffuse = 1;
}

void aset_model_fill(aset_model *model, const aset_colour *fill) {
    model->wanted = model->fallback;
    model->wanted.fill = *fill;
}

aset_status aset_model_init(aset_model *model, const aset_sink *sink, aset_read read, void *context,
                            const aset_load_options *options, aset_load_report *report) {
    if (sink == NULL || read == NULL || report == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_reader_init(&model->reader, read, context, report);
    model->sink = sink;
    set_default(&model->fallback);
    if (options != NULL && options->material != NULL) {
        model->fallback = *options->material;
    }
    model->wanted = model->given = model->fallback;
    model->has_material = false;
    model->smooth = options != NULL && options->smooth;
    model->size = options != NULL ? options->size : 0;
#if !ASET_WITH_PATCHES
    if (model->smooth) {
        report->what = "patches were switched off when the library was compiled";
        return ASET_ERR_UNSUPPORTED;
    }
#endif
    return ASET_OK;
}

/* ---- errors ---- */

void aset_model_count_text(char text[32], uint64_t number, const char *words) {
    char digits[20];
    size_t n = 0, length = 0;
    do {
        digits[n++] = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0);
    while (n > 0) {
        text[length++] = digits[--n];
    }
    for (; *words != '\0' && length < 31; words++) {
        text[length++] = *words;
    }
    text[length] = '\0';
}

aset_status aset_model_answer(aset_model *model, aset_status status) {
    const char *what = "the sink refused it";
    switch (status) {
    case ASET_OK: return ASET_OK;
    case ASET_ERR_NOMEM: what = "it does not fit in the arena's limits"; break;
    case ASET_ERR_LIMIT: what = "more than the library can count"; break;
    case ASET_ERR_STOPPED: what = "the sink asked to stop"; break;
    default: break;
    }
    return aset_reader_fail(&model->reader, status, what, NULL);
}

aset_status aset_model_store_answer(aset_model *model, aset_status status, uint64_t capacity) {
    aset_place place = aset_reader_place(&model->reader);
    switch (status) {
    case ASET_OK: return ASET_OK;
    case ASET_ERR_NOMEM:
        aset_model_count_text(place.token, capacity, " vertices");
        return aset_reader_fail_at(&model->reader, &place, status, "the memory for vertices holds no more than",
                                   "fewer, more memory, or a spill file");
    case ASET_ERR_LIMIT:
        return aset_reader_fail_at(&model->reader, &place, status, "more vertices than the library can count", NULL);
    default: return aset_reader_fail_at(&model->reader, &place, status, "the spill file of the vertices failed", NULL);
    }
}

void aset_model_binary(aset_model *model) {
    model->reader.line = model->reader.token_line = 0;
    model->reader.token[0] = '\0';
    model->reader.length = 0;
}

aset_status aset_model_fail_binary(aset_model *model, uint64_t offset, const char *what, uint64_t part, uint64_t whole) {
    aset_place place;
    char of[32], whole_text[32];
    aset_model_count_text(whole_text, whole, "");
    memcpy(of, " of ", 4);
    memcpy(of + 4, whole_text, sizeof of - 4);
    of[31] = '\0';
    aset_model_count_text(place.token, part, of);
    place.offset = offset;
    place.line = 0;
    return aset_reader_fail_at(&model->reader, &place, ASET_ERR_SYNTAX, what, NULL);
}

aset_status aset_model_end(aset_model *model) {
    const aset_load_report *report = model->reader.report;
    if (report->triangles > 0) {
        return ASET_OK;
    }
    aset_place place = aset_reader_place(&model->reader);
    place.token[0] = '\0';
    place.offset = model->reader.offset;
    place.line = model->reader.line;
    return aset_reader_fail_at(&model->reader, &place, ASET_ERR_SYNTAX,
                               report->skipped > 0 ? "no facet in it that can be drawn" : "no facet in it",
                               "at least one triangle");
}

aset_real aset_model_single(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return (aset_real)value;
}

aset_real aset_model_coordinate(double value) {
    const double most = (double)ASET_NUMBER_LARGEST;
    return value >= -most && value <= most ? (aset_real)value : ASET_NUMBER_OUTSIDE;
}

/* ---- triangles ---- */

static inline bool in_range(aset_real x) {
    return x >= -ASET_NUMBER_LARGEST && x <= ASET_NUMBER_LARGEST;
}

static inline bool point_in_range(const aset_vec3 *p) {
    return in_range(p->x) && in_range(p->y) && in_range(p->z);
}

static bool same_material(const aset_material *a, const aset_material *b) {
#if ASET_WITH_REFRACTION
    if (a->transmittance != b->transmittance || a->refraction_index != b->refraction_index) {
        return false;
    }
#endif
    return a->fill.r == b->fill.r && a->fill.g == b->fill.g && a->fill.b == b->fill.b && a->diffuse == b->diffuse &&
           a->specular == b->specular && a->shine == b->shine && a->one_sided == b->one_sided;
}

static aset_status emit_material(aset_model *model) {
    const aset_status status = model->sink->material(model->sink->context, &model->wanted);
    if (status != ASET_OK) {
        const char *what = status == ASET_ERR_GEOMETRY ? "a material that is not finite" : NULL;
        return what != NULL ? aset_reader_fail(&model->reader, status, what, NULL) : aset_model_answer(model, status);
    }
    model->given = model->wanted;
    model->has_material = true;
    return ASET_OK;
}

static aset_status emit(const aset_sink *sink, const aset_corner *a, const aset_corner *b, const aset_corner *c,
                        bool patch) {
    void *context = sink->context;
    aset_status status = sink->polygon_begin(context, 3, patch);
    if (status == ASET_OK) {
        status = sink->polygon_point(context, &a->point, patch ? &a->normal : NULL);
    }
    if (status == ASET_OK) {
        status = sink->polygon_point(context, &b->point, patch ? &b->normal : NULL);
    }
    if (status == ASET_OK) {
        status = sink->polygon_point(context, &c->point, patch ? &c->normal : NULL);
    }
    return status == ASET_OK ? sink->polygon_end(context) : status;
}

aset_status aset_model_triangle(aset_model *model, const aset_corner *a, const aset_corner *b, const aset_corner *c) {
    aset_load_report *report = model->reader.report;
    if (!point_in_range(&a->point) || !point_in_range(&b->point) || !point_in_range(&c->point)) {
        report->skipped++;
        return ASET_OK;
    }
    if (!model->has_material || !same_material(&model->given, &model->wanted)) {
        const aset_status status = emit_material(model);
        if (status != ASET_OK) {
            return status;
        }
    }
    const bool patch = model->smooth && a->has_normal && b->has_normal && c->has_normal && point_in_range(&a->normal) &&
                       point_in_range(&b->normal) && point_in_range(&c->normal);
    const aset_status status = emit(model->sink, a, b, c, patch);
    if (status == ASET_OK) {
        report->triangles++;
        return ASET_OK;
    }
    if (status == ASET_ERR_GEOMETRY) {
        report->skipped++;
        return ASET_OK;
    }
    return aset_model_answer(model, status);
}

#else

aset_status aset_model_switched_off(const aset_sink *sink, aset_read read, void *context, aset_load_report *report) {
    aset_reader reader;
    if (sink == NULL || read == NULL || report == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    aset_reader_init(&reader, read, context, report);
    return aset_reader_fail(&reader, ASET_ERR_UNSUPPORTED, "polygons were switched off when the library was compiled", NULL);
}

#endif
