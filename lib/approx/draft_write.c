/*
 * draft_write.c - from bins to raw facets, and from these to the words of a draft.
 *
 * Surfaces and footprints are numbers that repeat: each is listed once, in ascending order, so that a facet takes the bits that
 * their counts need, and the lists do not depend on where the facets stand. The words are made behind what they are made from,
 * and then moved to the region's start.
 */
#include "approx/baker.h"
#include "base/whole.h"

#if ASET_WITH_DRAFTS

#include "scene/entity.h"
#include "scene/shape.h"

static uint32_t clamp_code(aset_real x, uint32_t most) {
    return !(x > 0) ? 0 : x >= (aset_real)most ? most : (uint32_t)x;
}

static uint32_t slope_code(aset_real slope) {
    return clamp_code(slope * SLOPE_STEPS + SLOPE_STEPS + R(0.5), 2 * SLOPE_STEPS);
}

/*
 * A mean of different materials, in coarser steps, so that there are not as many as cells: shares of 1/4, the exponent and the
 * index of refraction to 4 bits.
 */
static uint64_t coarsen(uint64_t part, int number) {
    unsigned bits = 14; /* of a step */
    if (number == 5 || number == 7) {
        for (bits = 0; part >> bits >= 16; bits++) {
        }
    }
    return (part + (UINT64_C(1) << bits) / 2) >> bits << bits;
}

/* The number of a texture in the baker's list: its own, a new one, or the nearest if the list is full. */
static uint32_t texture_number(aset_baker *b, const bin *it) {
    texture_sum sum;
    aset_summary list; /* what the list's functions know */
    uint32_t number;
    if (b->single) {
        return 0;
    }
    bool is_mixed = false; /* a single material's sums divide without a rest */
    sum.n = 1;
    for (int p = 0; p < TEXTURE_PARTS; p++) {
        uint64_t rest;
        (void)aset_whole_divide(it->parts[p], it->n, &rest);
        sum.parts[p] = whole_quotient(it->parts[p] + it->n / 2, it->n);
        is_mixed = is_mixed || rest != 0;
    }
    for (int p = 0; p < TEXTURE_PARTS && is_mixed; p++) {
        sum.parts[p] = coarsen(sum.parts[p], p);
    }
    aset_material texture = aset_texture_average(&sum);
    memset(&list, 0, sizeof list);
    list.textures = b->textures;
    list.n_textures = b->n_textures;
    if (aset_texture_find(&list, &texture, &number)) {
        return number;
    }
    if (b->n_textures == b->texture_capacity) {
        b->report.merged++;
        return aset_texture_nearest(&list, &texture);
    }
    b->textures[b->n_textures] = texture;
    return b->n_textures++;
}

static uint64_t raw_facet(aset_baker *b, const bin *it, uint32_t side, bool is_first) {
    aset_real n = (aset_real)it->n;
    aset_real slope_u = real_of_whole(it->slope_u) / n / BIN_UNIT, slope_v = real_of_whole(it->slope_v) / n / BIN_UNIT;
    aset_real u = (aset_real)it->columns_u / n + R(0.5), v = (aset_real)it->columns_v / n + R(0.5);
    aset_real height = (real_of_whole(it->height) / n + R(0.5)) / BIN_UNIT - slope_u * (u - 2) - slope_v * (v - 2);
    return (uint64_t)it->footprint | (uint64_t)clamp_code((height - HEIGHT_LOW) / HEIGHT_STEP, (1u << HEIGHT_BITS) - 1) << RAW_HEIGHT |
           (uint64_t)slope_code(slope_u) << RAW_SLOPE_U | (uint64_t)slope_code(slope_v) << RAW_SLOPE_V |
           (uint64_t)side << RAW_SIDE | (uint64_t)is_first << RAW_FIRST |
           (uint64_t)texture_number(b, it) << RAW_TEXTURE;
}

static void harvest_voxel(aset_baker *b, uint32_t voxel) {
    bool is_first = true;
    b->report.voxels++;
    for (uint32_t side = 0; side < 6; side++) {
        uint32_t key = voxel * 6 + side, slot = baker_slot(b, key);
        if (b->keys[slot] == BIN_EMPTY) {
            continue;
        }
        b->n_counted++;
        if (!b->counting) {
            b->n_raw++;
            *(b->raw - b->n_raw) = raw_facet(b, baker_bin(b, slot), side, is_first);
        }
        is_first = false;
    }
}

void aset_baker_harvest(aset_baker *b) {
    uint32_t in_layer = b->blocks[0] * b->blocks[1];
    if (b->single && b->n_materials > 0) {
        texture_sum sum; /* in the same units, and within the same bounds, as those of several materials */
        memset(&sum, 0, sizeof sum);
        aset_texture_sum_add(&sum, &b->only);
        b->textures[0] = aset_texture_average(&sum);
        b->n_textures = 1;
    }
    for (uint32_t block = b->floor_block; block < b->ceiling_block; block++) {
        uint32_t x = block % b->blocks[0] * 4, y = block / b->blocks[0] % b->blocks[1] * 4, z = block / in_layer * 4;
        for (uint64_t left = b->marks[block]; left != 0; left &= left - 1) {
            uint32_t bit = bits_lowest(left);
            harvest_voxel(b, ((z + bit / 16) * b->n[1] + y + bit / 4 % 4) * b->n[0] + x + bit % 4);
        }
    }
}

/* ---- lists of numbers, each once, in order ---- */

static void sift(uint32_t *numbers, size_t at, size_t n) {
    uint32_t moved = numbers[at];
    for (size_t child = 2 * at + 1; child < n; child = 2 * at + 1) {
        child += child + 1 < n && numbers[child + 1] > numbers[child];
        if (numbers[child] <= moved) {
            break;
        }
        numbers[at] = numbers[child];
        at = child;
    }
    numbers[at] = moved;
}

/* Sorts (Williams' heapsort 1964: in place, no recursion) and drops repeats. How many are left. */
static size_t sort_unique(uint32_t *numbers, size_t n) {
    for (size_t i = n / 2; i > 0; i--) {
        sift(numbers, i - 1, n);
    }
    for (size_t end = n; end > 1; end--) {
        uint32_t largest = numbers[0];
        numbers[0] = numbers[end - 1];
        numbers[end - 1] = largest;
        sift(numbers, 0, end - 1);
    }
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (kept == 0 || numbers[i] != numbers[kept - 1]) {
            numbers[kept++] = numbers[i];
        }
    }
    return kept;
}

/* Programs that are compiled for size only sort: it takes longer, and gives the same lists. */
#if defined(__OPTIMIZE_SIZE__)
#define MAPS 0
#else
#define MAPS 1
#endif

/*
 * Numbers listed once each. Where the largest possible number lets a bitmap be afforded there is one, with ranks; else a sorted
 * list is searched.
 */
typedef struct number_set {
    const uint32_t *bits, *rank, *list;
    uint32_t n;
} number_set;

static uint32_t number_of(const number_set *set, uint32_t wanted) {
#if MAPS
    if (set->bits != NULL) {
        uint32_t word = set->bits[wanted / 32];
        return set->rank[wanted / 32] + bits_count(word & ((UINT32_C(1) << wanted % 32) - 1));
    }
#endif
    uint32_t low = 0, high = set->n - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (set->list[middle] < wanted) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static uint32_t surface_of(uint64_t raw) {
    return (uint32_t)(raw >> RAW_SIDE & 7u) | (uint32_t)(raw >> RAW_SLOPE_U & SLOPE_MASK) << 3 |
           (uint32_t)(raw >> RAW_SLOPE_V & SLOPE_MASK) << (3 + SLOPE_BITS) | (uint32_t)(raw >> RAW_TEXTURE) << SURFACE_TEXTURE_SHIFT;
}

/* A raw facet's footprint or surface. */
static uint32_t number_in(uint64_t raw, bool prints) {
    return prints ? (uint32_t)(raw & 0xffffu) : surface_of(raw);
}

/* ---- the words ---- */

static uint32_t words_of_kept(const aset_scene *stage, uint32_t object) {
    shape s = shape_of(stage, object);
    uint32_t n = s.n;
    if (s.kind == KIND_POLYGON) { /* without what the scene keeps before the points; a patch is kept as a polygon */
        n -= s.n > 9 ? 3 : 0;
    }
    return KEPT_HEAD_WORDS + n;
}

static uint64_t count_blocks(const aset_baker *b) {
    uint64_t n = 0;
    for (uint32_t i = 0; i < b->blocks[0] * b->blocks[1] * b->blocks[2]; i++) {
        n += b->marks[i] != 0;
    }
    return n;
}

static uint64_t count_words(const aset_baker *b, uint64_t n_facets, uint64_t n_surfaces, uint64_t n_footprints) {
    uint64_t n_all = (uint64_t)b->blocks[0] * b->blocks[1] * b->blocks[2], kept = 0;
    unsigned width = HEIGHT_BITS + (n_surfaces > 1 ? bits_width((uint32_t)n_surfaces - 1) : 1) +
                     (n_footprints > 1 ? bits_width((uint32_t)n_footprints - 1) : 1);
    for (uint32_t i = 0; i < b->stage.counts.objects; i++) {
        kept += words_of_kept(&b->stage, i);
    }
    return WORDS_HEADER + 2 * ((n_all + 31) / 32) + 3 * count_blocks(b) + n_facets / 32 + 1 + (n_facets * width + 31) / 32 + 2 +
           n_surfaces + (n_footprints + 1) / 2 + (uint64_t)b->n_textures * TEXTURE_WORDS +
           (uint64_t)b->stage.counts.lights * LIGHT_WORDS + kept;
}

size_t aset_baker_words_bound(const aset_baker *b, uint64_t n_facets) {
    uint64_t words = count_words(b, n_facets, n_facets, n_facets < 65535 ? n_facets : 65535);
    uint64_t lists = n_facets * sizeof(uint32_t) + (n_facets < 65536 ? n_facets : 65536) * sizeof(uint32_t);
    return whole_bytes((uint64_t)(b->after - b->region) + words * sizeof(uint32_t) + lists + n_facets * sizeof(uint64_t) + 65536);
}

static void write_vec(uint32_t *w, aset_vec3 x) {
    w[0] = word_of_float(x.x);
    w[1] = word_of_float(x.y);
    w[2] = word_of_float(x.z);
}

static void write_material(uint32_t *w, const aset_material *m) {
    aset_real amounts[TEXTURE_WORDS] = {0};
    memcpy(amounts, m, MATERIAL_AMOUNTS * sizeof *amounts);
    for (int i = 0; i < TEXTURE_WORDS; i++) {
        w[i] = word_of_float(amounts[i]);
    }
}

static void write_header(uint32_t *words, const aset_baker *b, uint64_t n_words, uint32_t n_surfaces, uint32_t n_footprints) {
    const aset_view *view = &b->stage.view;
    memset(words, 0, (size_t)n_words * sizeof *words);
    words[WORD_MAGIC] = FACET_MAGIC;
    words[WORD_VERSION] = FACET_VERSION;
    words[WORD_N_WORDS] = (uint32_t)n_words;
    for (int a = 0; a < 3; a++) {
        words[WORD_N + a] = b->n[a];
        words[WORD_LOW + a] = word_of_float(b->origin[a]);
        words[WORD_SIZE + a] = word_of_float(b->size[a]);
    }
    words[WORD_BLOCKS] = (uint32_t)count_blocks(b);
    words[WORD_FACETS] = b->n_raw;
    words[WORD_SURFACES] = n_surfaces;
    words[WORD_FOOTPRINTS] = n_footprints;
    words[WORD_TEXTURES] = b->n_textures;
    words[WORD_LIGHTS] = b->stage.counts.lights;
    words[WORD_KEPT] = b->stage.counts.objects;
    for (uint32_t i = 0; i < b->stage.counts.objects; i++) {
        words[WORD_KEPT_WORDS] += words_of_kept(&b->stage, i);
    }
    words[WORD_HAS_VIEW] = b->stage.has_view;
    write_vec(words + WORD_BACKGROUND, vec(b->stage.background.r, b->stage.background.g, b->stage.background.b));
    if (b->stage.has_view) {
        write_vec(words + WORD_VIEW, view->from);
        write_vec(words + WORD_VIEW + 3, view->at);
        write_vec(words + WORD_VIEW + 6, view->up);
        words[WORD_VIEW + 9] = word_of_float(view->angle_deg);
        words[WORD_VIEW + 10] = word_of_float(view->height);
        words[WORD_VIEW + 11] = view->width_px;
        words[WORD_VIEW + 12] = view->height_px;
    }
}

/* The sections are written through the places that aset_draft_bind has found for them. */
static uint32_t *section(const uint32_t *at, uint32_t *words, const aset_draft *draft) {
    return words + (at - draft->words);
}

static void write_blocks(uint32_t *words, const aset_draft *d, const aset_baker *b) {
    uint32_t *map = section(d->map, words, d), *rank = section(d->rank, words, d), *marks = section(d->marks, words, d);
    uint32_t *first = section(d->first, words, d), n = 0, facet_number = 0;
    for (uint32_t i = 0; i < b->blocks[0] * b->blocks[1] * b->blocks[2]; i++) {
        if (i % 32 == 0) {
            rank[i / 32] = n;
        }
        if (b->marks[i] == 0) {
            continue;
        }
        map[i / 32] |= 1u << i % 32;
        marks[2 * n] = (uint32_t)b->marks[i];
        marks[2 * n + 1] = (uint32_t)(b->marks[i] >> 32);
        first[n++] = facet_number;
        for (unsigned voxels = bits_count(b->marks[i]); voxels > 0; voxels--) {
            do {
                facet_number++;
            } while (facet_number < b->n_raw && (*(b->raw - 1 - facet_number) >> RAW_FIRST & 1u) == 0);
        }
    }
}

static void write_facets(uint32_t *words, const aset_draft *d, const aset_baker *b, const number_set *surfaces,
                         const number_set *prints) {
    uint32_t *starts = section(d->starts, words, d), *facets = section(d->facets, words, d);
    uint32_t *footprints = section(d->footprints, words, d);
    memcpy(section(d->surfaces, words, d), surfaces->list, surfaces->n * sizeof *surfaces->list);
    for (uint32_t i = 0; i < d->n_footprints; i++) {
        footprints[i / 2] |= prints->list[i] << i % 2 * 16;
    }
    for (uint32_t i = 0; i < b->n_raw; i++) {
        uint64_t raw = *(b->raw - 1 - i), record = raw >> RAW_HEIGHT & ((1u << HEIGHT_BITS) - 1);
        record = record << d->footprint_width | number_of(prints, number_in(raw, true));
        record = record << d->surface_width | number_of(surfaces, number_in(raw, false));
        words_put(facets, d->width, i, record);
        starts[i / 32] |= (uint32_t)(raw >> RAW_FIRST & 1u) << i % 32;
    }
    starts[b->n_raw / 32] |= 1u << b->n_raw % 32;
}

/* One object; how many words. */
static uint32_t write_object(uint32_t *w, const aset_scene *stage, uint32_t object) {
    shape s = shape_of(stage, object);
    uint32_t n = words_of_kept(stage, object) - KEPT_HEAD_WORDS;
    w[0] = s.kind | (s.kind == KIND_POLYGON ? n / 3 : 0) << 8 | (s.material->one_sided ? 1u : 0u) << 31;
    write_material(w + 1, s.material);
    for (uint32_t k = 0; k < n; k++) {
        w[KEPT_HEAD_WORDS + k] = word_of_float(s.at[s.n - n + k] / stage->scale);
    }
    return KEPT_HEAD_WORDS + n;
}

/* Does the object a come after b? By their words: so the order in which they came does not matter. */
static bool comes_after(const aset_scene *stage, uint32_t a, uint32_t b) {
    uint32_t at_a[KEPT_WORDS_MAX], at_b[KEPT_WORDS_MAX];
    uint32_t n_a = write_object(at_a, stage, a), n_b = write_object(at_b, stage, b);
    for (uint32_t i = 0; i < n_a && i < n_b; i++) {
        if (at_a[i] != at_b[i]) {
            return at_a[i] > at_b[i];
        }
    }
    return n_a > n_b;
}

static void write_kept(uint32_t *w, const aset_scene *stage) {
    uint32_t order[ASET_KEPT_MAX], n = stage->counts.objects; /* no more: start_stage sees to it */
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = i;
        for (; k > 0 && comes_after(stage, order[k - 1], i); k--) {
            order[k] = order[k - 1];
        }
        order[k] = i;
    }
    for (uint32_t i = 0; i < n; i++) {
        w += write_object(w, stage, order[i]);
    }
}

static void write_stage(uint32_t *words, const aset_draft *d, const aset_baker *b) {
    uint32_t *w = section(d->textures, words, d);
    for (uint32_t i = 0; i < b->n_textures; i++, w += TEXTURE_WORDS) {
        write_material(w, b->textures + i);
    }
    for (uint32_t i = 0; i < b->stage.counts.lights; i++, w += LIGHT_WORDS) {
        const aset_light *light = b->stage.lights + i;
        write_vec(w, light->position);
        if (light->has_colour) {
            write_vec(w + 3, vec(light->colour.r, light->colour.g, light->colour.b));
        }
        w[6] = (light->has_colour ? LIGHT_HAS_COLOUR : 0) | (light->directional ? LIGHT_DIRECTIONAL : 0);
    }
    write_kept(w, &b->stage);
}

#if MAPS
/* All surfaces, or all footprints, below most: in words from *at on. False: no room. */
static bool collect_by_map(number_set *set, const aset_baker *b, bool prints, uint64_t most, uint32_t **at, const uint32_t *end) {
    uint64_t n_words = (most + 31) / 32;
    if (2 * n_words > (uint64_t)(end - *at) / 2) {
        return false;
    }
    uint32_t *bits = *at, *rank = bits + n_words, *list = rank + n_words;
    memset(bits, 0, (size_t)n_words * sizeof *bits);
    for (uint32_t i = 0; i < b->n_raw; i++) {
        uint32_t number = number_in(*(b->raw - 1 - i), prints);
        bits[number / 32] |= UINT32_C(1) << number % 32;
    }
    set->n = 0;
    for (uint32_t w = 0; w < n_words; w++) {
        rank[w] = set->n;
        if (bits_count(bits[w]) > (size_t)(end - list) - set->n) {
            return false;
        }
        for (uint32_t left = bits[w]; left != 0; left &= left - 1) {
            list[set->n++] = w * 32 + bits_lowest(left);
        }
    }
    set->bits = bits;
    set->rank = rank;
    set->list = list;
    *at = list + set->n;
    return true;
}

#endif

static bool collect_by_sorting(number_set *set, const aset_baker *b, bool prints, uint32_t **at, const uint32_t *end) {
    uint32_t *list = *at;
    size_t filled = 0, room = (size_t)(end - list);
    for (uint32_t i = 0; i < b->n_raw; i++) {
        if (filled == room) {
            filled = sort_unique(list, filled);
            if (filled >= room - room / 4) { /* with no room at all, too */
                return false;
            }
        }
        list[filled++] = number_in(*(b->raw - 1 - i), prints);
    }
    set->bits = set->rank = NULL;
    set->list = list;
    set->n = (uint32_t)sort_unique(list, filled);
    *at = list + set->n;
    return true;
}

static bool collect(number_set *set, const aset_baker *b, bool prints, bool maps, uint32_t **at, const uint32_t *end) {
#if MAPS
    uint64_t most = prints ? 65536 : (uint64_t)b->n_textures << SURFACE_TEXTURE_SHIFT;
    if (maps && collect_by_map(set, b, prints, most, at, end)) {
        return true;
    }
#endif
    (void)maps;
    return collect_by_sorting(set, b, prints, at, end);
}

/* The lists for the words of the raw facets, and the room behind them. */
typedef struct word_room {
    number_set surfaces, prints;
    uint32_t *words;
    uint64_t n_words;
} word_room;

/* Where the room ends that the raw facets leave. */
static const uint32_t *room_end(const aset_baker *b) {
    return (const uint32_t *)(const void *)(b->raw - b->n_raw);
}

static bool find_room_with(word_room *r, const aset_baker *b, bool maps) {
    const uint32_t *end = room_end(b);
    r->words = (uint32_t *)(void *)b->after;
    if (!collect(&r->surfaces, b, false, maps, &r->words, end) || !collect(&r->prints, b, true, maps, &r->words, end)) {
        return false;
    }
    r->n_words = count_words(b, b->n_raw, r->surfaces.n, r->prints.n);
    return r->n_words <= (uint64_t)(end - r->words);
}

/* Maps take less time, and more room. */
static bool find_room(word_room *r, const aset_baker *b) {
    return (MAPS && find_room_with(r, b, true)) || find_room_with(r, b, false);
}

/* Words for so many surfaces and footprints, with the lists that they are made from; no maps. */
static uint64_t words_and_lists(const aset_baker *b, uint64_t n_surfaces, uint64_t n_footprints) {
    return count_words(b, b->n_raw, n_surfaces, n_footprints) + n_surfaces + n_footprints;
}

/* Listing all takes as long as a pass with few objects: so only where it is needed, and of half as many facets again as the last time. */
bool aset_baker_may_have_room(aset_baker *b) {
    uint64_t room = (uint64_t)(room_end(b) - (const uint32_t *)(const void *)b->after), n = b->n_raw;
    word_room r;
    if (words_and_lists(b, n, n < 65536 ? n : 65536) <= room) {
        return true;
    }
    if (words_and_lists(b, b->n_surfaces, b->n_footprints) > room) {
        return false;
    }
    if (b->n_raw / 3 < b->n_listed / 2) {
        return true;
    }
    if (!find_room(&r, b)) {
        return false;
    }
    b->n_listed = b->n_raw;
    b->n_surfaces = r.surfaces.n;
    b->n_footprints = r.prints.n;
    return true;
}

aset_status aset_baker_write(aset_baker *b) {
    aset_draft draft;
    word_room r;
    if (!find_room(&r, b)) {
        return ASET_ERR_NOMEM;
    }
    b->n_words = (size_t)r.n_words;
    write_header(r.words, b, r.n_words, r.surfaces.n, r.prints.n);
    (void)aset_draft_bind(&draft, r.words, b->n_words);
    write_blocks(r.words, &draft, b);
    write_facets(r.words, &draft, b, &r.surfaces, &r.prints);
    write_stage(r.words, &draft, b);
    r.words[WORD_CHECK] = aset_draft_checksum(r.words, b->n_words);
    memmove(b->region, r.words, b->n_words * sizeof *r.words);
    return ASET_OK;
}

/* The region goes back, and its first bytes, where the words are, are taken again. */
static uint32_t *take_words(aset_baker *b, size_t n_words) {
    aset_arena *arena = b->arena;
    arena->used -= b->region_bytes;
    arena->used_by[ASET_CATEGORY_SCRATCH] -= b->region_bytes;
    return aset_arena_alloc(arena, n_words * sizeof(uint32_t), ASET_CATEGORY_CELLS);
}

/*
 * The stage once more, in the memory that it has, as aset_draft_open will read it: in the words' order, and in double rounded
 * as they are.
 */
static aset_status read_again(aset_scene *stage, const aset_draft *draft, const aset_scene *given) {
    memset(stage, 0, sizeof *stage);
    stage->scale = 1;
    stage->limits = given->limits;
    stage->objects = given->objects;
    stage->coordinates = given->coordinates;
    stage->materials = given->materials;
    stage->lights = given->lights;
    aset_sink sink = aset_scene_sink(stage);
    return aset_draft_read_stage(draft, &sink);
}

aset_status aset_baker_finish(aset_draft *draft, aset_baker *baker) {
    if (draft == NULL || baker == NULL || baker->phase != PHASE_DONE) {
        return ASET_ERR_ARGUMENT;
    }
    memset(draft, 0, sizeof *draft);
    (void)aset_draft_bind(draft, take_words(baker, baker->n_words), baker->n_words);
    aset_draft_bind_marks(draft);
    baker->phase = PHASE_FAILED;
    aset_status status = read_again(&draft->stage, draft, &baker->stage);
    if (status != ASET_OK) {
        aset_arena_release(baker->arena, &baker->mark);
        return ASET_ERR_PRECISION; /* what the sink has taken: only rounding can have spoilt it */
    }
    baker->report.facets = draft->n_facets;
    baker->report.textures = draft->n_textures;
    return ASET_OK;
}

#endif
