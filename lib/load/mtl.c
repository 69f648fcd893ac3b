/*
 * mtl.c - the material libraries of OBJ files (Wavefront's "Advanced Visualizer Manual", appendix B1: "MTL material
 * format"), line by line.
 *
 * Materials are looked for from the first library's first line on, and the first of a name counts. A pass over the
 * libraries also fills the free entries with whatever comes by, so if all fit, one pass serves them all. An entry once
 * taken is never free again, and a pass adds nothing for a name that is there, so whether an entry went or stayed cannot
 * change what a name means.
 */
#include "mtl.h"

#include "reader.h"

#include <string.h>

#if ASET_WITH_POLYGONS

enum { FOUND = 1, ABSENT, REFUSED };

/* A pass for one name. */
typedef struct search {
    aset_mtl *mtl;
    uint64_t name;
    bool found;
    aset_reader reader;
    /* the material in hand */
    bool open, has_d, is_matt;
    uint64_t open_name;
    aset_material material;
    aset_real opacity, transmittance;
} search;

/* ---- entries ---- */

/* FNV-1a (Fowler, Noll and Vo). */
static uint64_t hash_of(const char *name) {
    uint64_t hash = UINT64_C(14695981039346656037);
    for (; *name != '\0'; name++) {
        hash = (hash ^ (unsigned char)*name) * UINT64_C(1099511628211);
    }
    return hash;
}

/* The entry of a name; else a free one if there is one, and with evict the one used least recently. NULL: neither. */
static aset_named_material *entry_for(aset_mtl *mtl, uint64_t name, bool evict) {
    aset_named_material *best = NULL;
    for (uint32_t i = 0; i < mtl->n_kept; i++) {
        aset_named_material *e = &mtl->kept[i];
        if (e->used != 0 && e->name == name) {
            return e;
        }
        if (best == NULL || e->used < best->used) {
            best = e;
        }
    }
    return evict || (best != NULL && best->used == 0) ? best : NULL;
}

static void keep(aset_mtl *mtl, aset_named_material *e, uint64_t name, uint32_t state, const aset_material *material) {
    e->name = name;
    e->used = ++mtl->clock;
    e->state = state;
    e->material = *material;
}

void aset_mtl_init(aset_mtl *mtl, const aset_load_options *options, const aset_material *fallback) {
    mtl->library = options != NULL ? options->library : NULL;
    mtl->fallback = *fallback;
    mtl->kept = mtl->own;
    mtl->n_kept = ASET_MTL_OWN;
    if (options != NULL && options->materials != NULL && options->n_materials > 0) {
        mtl->kept = options->materials;
        mtl->n_kept = options->n_materials;
    }
    mtl->clock = mtl->names_used = 0;
    for (uint32_t i = 0; i < mtl->n_kept; i++) {
        mtl->kept[i].used = mtl->kept[i].state = 0;
    }
}

bool aset_mtl_add_library(aset_mtl *mtl, const char *names) {
    const size_t size = strlen(names) + 1;
    for (uint32_t at = 0; at < mtl->names_used; at += (uint32_t)strlen(mtl->names + at) + 1) {
        if (strcmp(mtl->names + at, names) == 0) {
            return true;
        }
    }
    if (size > ASET_MTL_NAMES - mtl->names_used) {
        return false;
    }
    memcpy(mtl->names + mtl->names_used, names, size);
    mtl->names_used += (uint32_t)size;
    for (uint32_t i = 0; i < mtl->n_kept; i++) { /* what was in none may be in this one */
        if (mtl->kept[i].state == ABSENT) {
            mtl->kept[i].name = 0;
            mtl->kept[i].state = FOUND;
            mtl->kept[i].used = mtl->kept[i].used != 0 ? 1 : 0;
        }
    }
    return true;
}

/* ---- a library's lines ---- */

/* The material in hand is complete: it is kept if it is the one sought, or if there is room. */
static void close_material(search *s) {
    if (!s->open || (s->found && s->open_name == s->name)) {
        s->open = false;
        return;
    }
    s->open = false;
    s->material.specular = s->is_matt ? 0 : s->material.specular;
    uint32_t state = FOUND;
    const aset_real transmittance = s->has_d ? 1 - s->opacity : s->transmittance;
#if ASET_WITH_REFRACTION
    s->material.transmittance = transmittance;
#else
    state = transmittance > 0 ? REFUSED : FOUND;
#endif
    const bool sought = s->open_name == s->name;
    aset_named_material *e = entry_for(s->mtl, s->open_name, sought);
    if (e != NULL && (e->used == 0 || sought)) {
        keep(s->mtl, e, s->open_name, state, &s->material);
    }
    s->found = s->found || sought;
}

static void open_material(search *s, const char *name) {
    s->open = true;
    s->open_name = hash_of(name);
    s->material = s->mtl->fallback;
    s->has_d = s->is_matt = false;
    s->opacity = 1;
#if ASET_WITH_REFRACTION
    s->transmittance = s->material.transmittance;
#else
    s->transmittance = 0;
#endif
}

/* The next number, 0 if it is below; false in *there if the line has ended. */
static aset_status read_amount(search *s, aset_real *value, bool *there) {
    aset_status status = aset_reader_keep(&s->reader);
    *there = status == ASET_OK && s->reader.length > 0 && !s->reader.starts_line;
    if (*there) {
        status = aset_reader_real(&s->reader, value, "a number");
        *value = status == ASET_OK && *value > 0 ? *value : 0;
    }
    return status;
}

/* Three numbers, or one that stands for three. */
static aset_status read_colour(search *s, aset_real to[3]) {
    bool there;
    aset_real values[3] = {0, 0, 0};
    uint32_t n = 0;
    aset_status status = read_amount(s, &values[n], &there);
    while (status == ASET_OK && there && ++n < 3) {
        status = read_amount(s, &values[n], &there);
    }
    if (status != ASET_OK) {
        return status;
    }
    if (n != 1 && n != 3) {
        return aset_reader_fail(&s->reader, ASET_ERR_SYNTAX, "a colour that is not complete before this", "r g b");
    }
    for (uint32_t i = 0; i < 3; i++) {
        to[i] = values[n == 1 ? 0 : i];
    }
    return ASET_OK;
}

static aset_status read_one(search *s, aset_real *to) {
    bool there;
    const aset_status status = read_amount(s, to, &there);
    return status == ASET_OK && !there
               ? aset_reader_fail(&s->reader, ASET_ERR_SYNTAX, "a word without its number before this", "a number")
               : status;
}

static aset_real at_most_one(aset_real x) {
    return x < 1 ? x : 1;
}

/* d may have a word before its number. */
static aset_status read_opacity(search *s) {
    aset_status status = aset_reader_keep(&s->reader);
    if (status == ASET_OK && aset_reader_is(&s->reader, "-halo")) {
        status = aset_reader_next(&s->reader);
    }
    if (status == ASET_OK) {
        status = read_one(s, &s->opacity);
        s->opacity = at_most_one(s->opacity);
        s->has_d = true;
    }
    return status;
}

/* The line whose first word is the current token, up to what is needed of it. */
static aset_status read_line(search *s) {
    aset_reader *reader = &s->reader;
    aset_material *m = &s->material;
    aset_real c[3] = {0, 0, 0};
    aset_status status;
    if (aset_reader_is(reader, "Kd")) {
        status = read_colour(s, c);
        m->fill = (aset_colour){c[0], c[1], c[2]};
        m->diffuse = 1;
    } else if (aset_reader_is(reader, "Ks")) {
        status = read_colour(s, c);
        m->specular = c[0] > c[1] ? c[0] : c[1];
        m->specular = c[2] > m->specular ? c[2] : m->specular;
    } else if (aset_reader_is(reader, "Ns")) {
        status = read_one(s, &m->shine);
    } else if (aset_reader_is(reader, "d")) {
        status = read_opacity(s);
    } else if (aset_reader_is(reader, "Tr")) {
        status = read_one(s, &s->transmittance);
        s->transmittance = at_most_one(s->transmittance);
    } else if (aset_reader_is(reader, "illum")) {
        status = read_one(s, &c[0]);
        s->is_matt = c[0] < 3; /* 3 and more reflect */
    } else if (aset_reader_is(reader, "Ni")) {
        status = read_one(s, &c[0]);
#if ASET_WITH_REFRACTION
        m->refraction_index = c[0];
#endif
    } else {
        status = aset_reader_skip_line(reader);
    }
    return status;
}

static bool is_full(const aset_mtl *mtl) {
    for (uint32_t i = 0; i < mtl->n_kept; i++) {
        if (mtl->kept[i].used == 0) {
            return false;
        }
    }
    return true;
}

/* Reads one library; stops early when it has the material and there is no room for others. */
static aset_status read_library(search *s) {
    aset_reader *reader = &s->reader;
    char name[ASET_MTL_NAME];
    size_t length;
    s->open = false;
    reader->joiner = '\\';
    reader->cut = "the library ends too early";
    for (;;) {
        aset_status status = aset_reader_next(reader);
        if (status != ASET_OK) {
            return status;
        }
        const bool begins = reader->starts_line && aset_reader_is(reader, "newmtl");
        if (begins || reader->length == 0) {
            close_material(s);
            if (reader->length == 0 || (s->found && is_full(s->mtl))) {
                return ASET_OK;
            }
        }
        if (begins) {
            status = aset_reader_rest(reader, name, sizeof name, &length);
            if (status == ASET_OK) {
                open_material(s, name);
            }
        } else if (reader->starts_line) {
            status = read_line(s);
        } else {
            status = aset_reader_skip_line(reader); /* a fourth number, say */
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

/* ---- libraries ---- */

static void report_library(aset_load_report *to, const aset_load_report *from, const char *name) {
    size_t i = 0;
    for (; name[i] != '\0' && i + 1 < sizeof to->library; i++) {
        to->library[i] = name[i] >= ' ' && name[i] <= '~' ? name[i] : '?';
    }
    to->library[i] = '\0';
    to->offset = from->offset;
    to->line = from->line;
    to->what = from->what;
    to->expected = from->expected;
    memcpy(to->token, from->token, sizeof to->token);
}

/* False in *there if there is no library of that name. */
static aset_status search_one(search *s, const char *name, bool *there, aset_load_report *report) {
    const aset_library *library = s->mtl->library;
    aset_load_report own;
    aset_read read = NULL;
    void *stream = NULL;
    *there = library->open(library->context, name, &read, &stream);
    if (!*there) {
        return ASET_OK;
    }
    aset_reader_init(&s->reader, read, stream, &own);
    aset_status status = aset_reader_skip_mark(&s->reader);
    status = status == ASET_OK ? read_library(s) : status;
    if (status != ASET_OK) {
        report_library(report, &own, name);
    }
    if (library->close != NULL) {
        library->close(library->context, stream);
    }
    return status;
}

/* What stands behind one "mtllib": a name with blanks in it, or in quotes, or several names. */
static aset_status search_line(search *s, const char *names, aset_load_report *report) {
    char name[ASET_MTL_NAME];
    bool there;
    aset_status status = search_one(s, names, &there, report);
    const size_t whole = strlen(names);
    if (status == ASET_OK && !there && whole > 2 && names[0] == '"' && names[whole - 1] == '"') { /* as some write it */
        memcpy(name, names + 1, whole - 2);
        name[whole - 2] = '\0';
        status = search_one(s, name, &there, report);
    }
    if (there || strpbrk(names, " \t") == NULL) {
        return status;
    }
    while (status == ASET_OK && !s->found) {
        names += strspn(names, " \t");
        const size_t length = strcspn(names, " \t");
        if (length == 0) {
            break;
        }
        memcpy(name, names, length); /* names was not longer than name */
        name[length] = '\0';
        names += length;
        status = search_one(s, name, &there, report);
    }
    return status;
}

aset_status aset_mtl_find(aset_mtl *mtl, const char *name, aset_material *material, bool *found, aset_load_report *report) {
    search s;
    memset(&s, 0, sizeof s); /* a library may set what belongs to no material */
    s.mtl = mtl;
    s.name = hash_of(name);
    aset_named_material *e = entry_for(mtl, s.name, false);
    if (e == NULL || e->used == 0) {
        aset_status status = ASET_OK;
        for (uint32_t at = 0; mtl->library != NULL && at < mtl->names_used && !s.found && status == ASET_OK;) {
            status = search_line(&s, mtl->names + at, report);
            at += (uint32_t)strlen(mtl->names + at) + 1;
        }
        if (status != ASET_OK) {
            return status;
        }
        e = entry_for(mtl, s.name, true);
        if (!s.found) {
            keep(mtl, e, s.name, ABSENT, &mtl->fallback);
        }
    }
    e->used = ++mtl->clock;
    *found = e->state != ABSENT;
    *material = e->material;
    return e->state == REFUSED ? ASET_ERR_UNSUPPORTED : ASET_OK;
}

#endif
