/*
 * fuzz.h - what the fuzzers share: bytes as numbers, bytes as a source in pieces, bytes as entities.
 *
 * A fuzzer is one file with one LLVMFuzzerTestOneInput. It is the same for libFuzzer and for main.c, which runs files; what
 * is wrong aborts. Every block is malloc'ed at exactly its size, so that the address sanitizer guards its end.
 */
#ifndef ASET_TESTS_FUZZ_H
#define ASET_TESTS_FUZZ_H

#include "aset/aset.h"
#include "aset/load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define require(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                                    \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

/*
 * --- what of it all ---
 *
 * A fuzzer must run often, so of what is alike (rays, methods, sides, pictures) an input gets only a part, and only one in a few gets
 * the large sizes. Which, its check sum says, or a byte of it where its offspring is to stay with the same. A kept input gets
 * everything: fuzz.sh sets ASET_FUZZ_ALL for these.
 */

static inline bool fuzz_all(void) {
    static int all = -1;
    all = all < 0 ? getenv("ASET_FUZZ_ALL") != NULL : all;
    return all == 1;
}

static inline uint32_t fuzz_choice(const uint8_t *data, size_t size) {
    uint32_t sum = 2166136261u;
    for (size_t i = 0; i < size; i++) {
        sum = (sum ^ data[i]) * 16777619u;
    }
    return sum ^ sum >> 15;
}

/* Is it the turn of number `which` of so many? */
static inline bool chosen(uint32_t choice, uint32_t of, uint32_t which) {
    return fuzz_all() || choice % of == which;
}

/* --- blocks --- */

static inline aset_arena open_arena(size_t size) {
    aset_arena arena;
    void *block = malloc(size > 0 ? size : 1);
    require(block != NULL && aset_arena_init(&arena, block, size) == ASET_OK);
    return arena;
}

static inline void close_arena(aset_arena *arena) {
    require(arena->used <= arena->size && arena->peak <= arena->size);
    free(arena->block);
}

/* --- bytes as numbers; zeros behind the end --- */

typedef struct bytes {
    const uint8_t *at, *end;
} bytes;

static inline uint32_t take_byte(bytes *b) {
    return b->at < b->end ? *b->at++ : 0;
}

static inline uint32_t take_word(bytes *b) {
    uint32_t low = take_byte(b), middle = take_byte(b), high = take_byte(b);
    return low | middle << 8 | high << 16 | take_byte(b) << 24;
}

/* What numbers look like: eighths from -16 to 16, so that much coincides; a float's own bits; now this, now that. */
typedef enum number_style { NUMBERS_SMALL, NUMBERS_BITS, NUMBERS_MIXED } number_style;

static inline aset_real take_bits(bytes *b) {
    uint32_t word = take_word(b);
    float f;
    memcpy(&f, &word, sizeof f);
    return (aset_real)f;
}

static inline aset_real take_small(bytes *b) {
    return (aset_real)((int)take_byte(b) - 128) / 8;
}

static inline aset_real take_real(bytes *b, number_style style) {
    if (style == NUMBERS_MIXED) {
        uint32_t how = take_byte(b);
        if (how % 16 == 15) {
            return take_bits(b);
        }
        aset_real x = take_small(b) + (how % 4 == 1 ? take_small(b) / 4096 : 0);
        return how % 16 == 14 ? x * (aset_real)1e14 : how % 16 == 13 ? x / (aset_real)1e20 : x;
    }
    return style == NUMBERS_BITS ? take_bits(b) : take_small(b);
}

static inline aset_vec3 take_vec(bytes *b, number_style style) {
    aset_vec3 v;
    v.x = take_real(b, style);
    v.y = take_real(b, style);
    v.z = take_real(b, style);
    return v;
}

/* --- bytes as a source --- */

typedef struct source {
    bytes left;
    size_t piece; /* the most given at once */
    bool fails;   /* at the end, instead of ending */
} source;

static inline ptrdiff_t give(void *context, void *buffer, size_t size) {
    source *s = context;
    size_t n = (size_t)(s->left.end - s->left.at);
    n = n < size ? n : size;
    n = n < s->piece ? n : s->piece;
    if (n == 0 && s->fails) {
        return -1;
    }
    if (n > 0) {
        memcpy(buffer, s->left.at, n);
    }
    s->left.at += n;
    return (ptrdiff_t)n;
}

static inline source source_of(const uint8_t *data, size_t size, uint32_t choice) {
    static const size_t pieces[] = {SIZE_MAX, 1, 7, 511};
    source s = {{data, data + size}, pieces[choice & 3u], (choice & 4u) != 0};
    return s;
}

static inline void require_same_counts(const aset_counts *a, const aset_counts *b) {
    require(a->objects == b->objects && a->polygons == b->polygons && a->patches == b->patches && a->spheres == b->spheres);
    require(a->cones == b->cones && a->materials == b->materials && a->lights == b->lights);
    require(a->coordinates == b->coordinates);
}

/* --- a reader twice: to count, and into a scene of exactly what was counted --- */

typedef aset_status (*reader)(const aset_sink *, aset_read, void *, const aset_load_options *, aset_load_report *);

static inline void check_report(aset_status status, const aset_load_report *report, size_t size) {
    require(memchr(report->token, 0, sizeof report->token) != NULL);
    require(memchr(report->library, 0, sizeof report->library) != NULL);
    require(status == ASET_OK ? report->what == NULL : report->what != NULL);
    require(report->library[0] != 0 || report->offset <= size);
}

static inline void check_same_report(const aset_load_report *a, const aset_load_report *b) {
    require(a->offset == b->offset && a->line == b->line && a->triangles == b->triangles && a->skipped == b->skipped);
    require(a->vertices == b->vertices && a->unknown_materials == b->unknown_materials && strcmp(a->token, b->token) == 0);
}

static inline void read_twice(reader load, const uint8_t *data, size_t size, uint32_t choice,
                              const aset_load_options *options, size_t room) {
    aset_counter counter;
    aset_scene scene;
    aset_load_report first, second;
    aset_arena arena = open_arena(room);
    aset_sink sink = aset_counter_sink(&counter);
    source from = source_of(data, size, choice);
    aset_status status = load(&sink, give, &from, options, &first);
    check_report(status, &first, size);
    aset_status ready = aset_scene_init(&scene, &arena, &counter.counts);
    require(ready == ASET_OK || ready == ASET_ERR_NOMEM || ready == ASET_ERR_LIMIT);
    require(ready != ASET_ERR_NOMEM || (arena.missing > 0 && arena.used == 0));
    if (ready == ASET_OK) {
        sink = aset_scene_sink(&scene);
        from = source_of(data, size, choice >> 3); /* in other pieces, perhaps */
        from.fails = (choice & 4u) != 0;
        aset_status again = load(&sink, give, &from, options, &second);
        check_report(again, &second, size);
        if (status == ASET_OK || again != ASET_ERR_NOMEM) { /* what broke off in a polygon counted no place for it */
            require(again == status);
            check_same_report(&first, &second);
        }
        require_same_counts(&scene.counts, &counter.counts);
    }
    close_arena(&arena);
}

/* --- a spill file in memory --- */

#define SPILL_MAX ((size_t)1 << 20)

typedef struct spill {
    uint8_t *bytes;
    size_t size; /* written up to here */
    uint32_t fails_in; /* calls until one fails; 0: none does */
} spill;

static inline bool spill_goes_on(spill *s) {
    return s->fails_in == 0 || --s->fails_in > 0;
}

static inline bool spill_write(void *context, uint64_t offset, const void *from, size_t size) {
    spill *s = context;
    if (!spill_goes_on(s) || offset > SPILL_MAX || size > SPILL_MAX - offset) {
        return false;
    }
    if (offset + size > s->size) {
        s->bytes = realloc(s->bytes, (size_t)offset + size);
        require(s->bytes != NULL);
        memset(s->bytes + s->size, 0xff, (size_t)offset + size - s->size);
        s->size = (size_t)offset + size;
    }
    memcpy(s->bytes + offset, from, size);
    return true;
}

static inline bool spill_read(void *context, uint64_t offset, void *to, size_t size) {
    spill *s = context;
    require(offset <= s->size && size <= s->size - offset);
    if (!spill_goes_on(s)) {
        return false;
    }
    if (size > 0) {
        memcpy(to, s->bytes + offset, size);
    }
    return true;
}

/* --- bytes as entities --- */

#define FUZZ_POINTS_MAX 20u

typedef struct entities {
    bytes from;
    number_style style;
    bool tame; /* no amount of a material or a light is above 255 */
    uint32_t spheres; /* so many at the most are given to the sink */
} entities;

static inline aset_real take_amount(entities *e) {
    return e->tame ? (aset_real)take_byte(&e->from) / 16 : take_real(&e->from, e->style);
}

static inline aset_colour take_colour(entities *e) {
    aset_colour c;
    c.r = take_amount(e);
    c.g = take_amount(e);
    c.b = take_amount(e);
    return c;
}

static inline aset_status put_material(entities *e, const aset_sink *sink) {
    aset_material m;
    memset(&m, 0, sizeof m);
    m.fill = take_colour(e);
    m.diffuse = take_amount(e);
    m.specular = take_amount(e);
    m.shine = take_amount(e);
#if ASET_WITH_REFRACTION
    m.transmittance = take_amount(e);
    m.refraction_index = take_amount(e);
#endif
    m.one_sided = (take_byte(&e->from) & 1u) != 0;
    return sink->material(sink->context, &m);
}

static inline aset_status put_view(entities *e, const aset_sink *sink) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.from = take_vec(&e->from, e->style);
    view.at = take_vec(&e->from, e->style);
    view.up = take_vec(&e->from, e->style);
    view.angle_deg = take_real(&e->from, e->style);
    view.height = take_byte(&e->from) % 2 == 0 ? 0 : take_real(&e->from, e->style);
    return sink->view(sink->context, &view);
}

static inline aset_status put_light(entities *e, const aset_sink *sink) {
    aset_light light;
    uint32_t how = take_byte(&e->from);
    memset(&light, 0, sizeof light);
    light.position = take_vec(&e->from, e->style);
    light.has_colour = (how & 1u) != 0;
    light.directional = (how & 2u) != 0;
    if (light.has_colour) {
        light.colour = take_colour(e);
    }
    return sink->light(sink->context, &light);
}

#if ASET_WITH_POLYGONS
/* Often as announced; now and then one point too many or too few, or normals where none were announced. */
static inline aset_status put_polygon(entities *e, const aset_sink *sink, bool patch) {
    uint32_t how = take_byte(&e->from), n = how % FUZZ_POINTS_MAX, given = how == 250 ? n + 1 : how == 251 ? n / 2 : n;
    n = how >= 252 ? take_word(&e->from) : n;
    aset_status status = sink->polygon_begin(sink->context, n, patch);
    for (uint32_t i = 0; i < given; i++) { /* takes the same bytes whatever the sink says */
        aset_vec3 point = take_vec(&e->from, e->style), normal = point;
        if (patch) {
            normal = take_vec(&e->from, e->style);
        }
        if (status == ASET_OK) {
            status = sink->polygon_point(sink->context, &point, patch && how != 249 ? &normal : NULL);
        }
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
}
#endif

static inline aset_status put_object(entities *e, const aset_sink *sink, uint32_t what) {
    switch (what % 4) {
#if ASET_WITH_POLYGONS
    case 0: return put_polygon(e, sink, false);
    case 1: return put_polygon(e, sink, true);
#endif
#if ASET_WITH_SPHERES
    case 2: {
        aset_vec3 centre = take_vec(&e->from, e->style);
        aset_real radius = take_real(&e->from, e->style);
        if (e->spheres == 0) {
            return ASET_ERR_LIMIT;
        }
        e->spheres--;
        return sink->sphere(sink->context, &centre, radius);
    }
#endif
#if ASET_WITH_CONES
    case 3: {
        aset_vec3 base = take_vec(&e->from, e->style);
        aset_real base_radius = take_real(&e->from, e->style);
        aset_vec3 apex = take_vec(&e->from, e->style);
        return sink->cone(sink->context, &base, base_radius, &apex, take_real(&e->from, e->style));
    }
#endif
    default: return ASET_ERR_UNSUPPORTED;
    }
}

static inline aset_status put_entity(entities *e, const aset_sink *sink, uint32_t what) {
    if (what % 16 == 12) {
        return put_material(e, sink);
    }
    if (what % 16 == 13) {
        return put_view(e, sink);
    }
    if (what % 16 == 14) {
        return put_light(e, sink);
    }
    if (what % 16 == 15) {
        aset_colour colour = take_colour(e);
        return sink->background(sink->context, &colour);
    }
    return put_object(e, sink, what);
}

/*
 * Up to most entities, whatever the sink answers; a hash of which it took, the same for every sink that checks alike.
 * (Not of why it refused: a polygon that announces more points than a scene can hold is NOMEM there.) The
 * first byte says how numbers look; a plain material comes before the rest unless it says otherwise.
 */
static inline uint32_t put_entities_with(bytes from, const aset_sink *sink, uint32_t most, uint32_t spheres, bool *tame) {
    uint32_t how = take_byte(&from), taken = 1;
    entities e = {from, (number_style)(how % 3), (how & 64u) == 0, spheres};
    *tame = e.tame;
    if ((how & 128u) == 0) {
        aset_material m;
        memset(&m, 0, sizeof m);
        m.fill.r = m.fill.g = m.fill.b = m.diffuse = 1;
        require(sink->material(sink->context, &m) == ASET_OK);
    }
    for (uint32_t i = 0; i < most && e.from.at < e.from.end; i++) {
        uint32_t what = take_byte(&e.from);
        taken = taken * 31 + (put_entity(&e, sink, what) == ASET_OK);
    }
    return taken;
}

static inline uint32_t put_entities(bytes from, const aset_sink *sink, uint32_t most, bool *tame) {
    return put_entities_with(from, sink, most, UINT32_MAX, tame);
}

#endif
