/*
 * draft.c - opening a draft where it lies. Everything is checked once, before anything is believed, so that rays need not
 * check at all: every number that serves as an index afterwards has been seen to be in range.
 */
#include "approx/facet.h"

#if ASET_WITH_DRAFTS

#include "scene/entity.h"
#include "scene/shape.h"

static const uint32_t *take(const uint32_t **at, uint64_t n, const uint32_t *end, bool *fits) {
    const uint32_t *section = *at;
    if (!*fits || n > (uint64_t)(end - *at)) {
        *fits = false;
        return section;
    }
    *at += n;
    return section;
}

static unsigned index_width(uint32_t n) {
    return n > 1 ? bits_width(n - 1) : 1;
}

bool aset_draft_bind(aset_draft *draft, const uint32_t *words, size_t n_words) {
    const uint32_t *at = words + WORDS_HEADER, *end = words + n_words;
    uint64_t all = 1;
    bool fits = true;
    draft->words = words;
    draft->answers = &aset_draft_answers;
    draft->n_words = n_words;
    draft->column = 0;
    for (int a = 0; a < 3; a++) {
        draft->n[a] = words[WORD_N + a];
        draft->blocks[a] = (draft->n[a] + 3) / 4;
        draft->low[a] = float_of_word(words[WORD_LOW + a]);
        draft->size[a] = float_of_word(words[WORD_SIZE + a]);
        draft->per_size[a] = 1 / draft->size[a];
        draft->column += draft->size[a] / 3;
        all *= draft->blocks[a];
    }
    draft->n_blocks = words[WORD_BLOCKS];
    draft->n_facets = words[WORD_FACETS];
    draft->n_surfaces = words[WORD_SURFACES];
    draft->n_footprints = words[WORD_FOOTPRINTS];
    draft->n_textures = words[WORD_TEXTURES];
    draft->surface_width = index_width(draft->n_surfaces);
    draft->footprint_width = index_width(draft->n_footprints);
    draft->width = draft->surface_width + draft->footprint_width + HEIGHT_BITS;
    draft->map = take(&at, (all + 31) / 32, end, &fits);
    draft->rank = take(&at, (all + 31) / 32, end, &fits);
    draft->marks = take(&at, 2 * (uint64_t)draft->n_blocks, end, &fits);
    draft->first = take(&at, draft->n_blocks, end, &fits);
    draft->starts = take(&at, (uint64_t)draft->n_facets / 32 + 1, end, &fits);
    draft->facets = take(&at, ((uint64_t)draft->n_facets * draft->width + 31) / 32 + 2, end, &fits);
    draft->surfaces = take(&at, draft->n_surfaces, end, &fits);
    draft->footprints = take(&at, ((uint64_t)draft->n_footprints + 1) / 2, end, &fits);
    draft->textures = take(&at, (uint64_t)draft->n_textures * TEXTURE_WORDS, end, &fits);
    (void)take(&at, (uint64_t)words[WORD_LIGHTS] * LIGHT_WORDS, end, &fits);
    (void)take(&at, words[WORD_KEPT_WORDS], end, &fits);
    return fits && at == end;
}

/* Facets a voxel, on average: of single surfaces there are 1.0 to 2.8, where several small things share voxels 3.3 to 4.6. */
#define SEAM_FACETS 3u

void aset_draft_bind_marks(aset_draft *draft) {
    uint32_t voxels = 0; /* ASET_BAKE_DIVISIONS_MAX to the third at most */
    for (uint32_t b = 0; b < draft->n_blocks; b++) {
        voxels += bits_count(draft_marks(draft, b));
    }
    draft->closes_seams = draft->n_facets <= SEAM_FACETS * voxels;
}

uint32_t aset_draft_checksum(const uint32_t *words, size_t n_words) {
    uint32_t sum = 2166136261u; /* Fowler, Noll and Vo's, over words, with a shift so that high bits come down */
    for (size_t i = WORD_CHECK + 1; i < n_words; i++) {
        sum = (sum ^ words[i]) * 16777619u;
        sum ^= sum >> 15;
    }
    return sum;
}

/* ---- the checks, each a sentence or NULL ---- */

static const char *check_header(const uint32_t *words, size_t n_words) {
    if (n_words < WORDS_HEADER) {
        return "shorter than a draft's header";
    }
    if (words[WORD_MAGIC] == 0x54445341u) {
        return "a draft in the other byte order";
    }
    if (words[WORD_MAGIC] != FACET_MAGIC) {
        return "not a draft";
    }
    if (words[WORD_VERSION] != FACET_VERSION) {
        return "a draft of another version";
    }
    if (words[WORD_N_WORDS] != n_words) {
        return "a draft of another length than it says";
    }
    if (words[WORD_CHECK] != aset_draft_checksum(words, n_words)) {
        return "a damaged draft: its check sum is wrong";
    }
    for (int a = 0; a < 3; a++) {
        aset_real low = float_of_word(words[WORD_LOW + a]), size = float_of_word(words[WORD_SIZE + a]);
        bool fine = words[WORD_N + a] >= 1 && words[WORD_N + a] <= ASET_BAKE_DIVISIONS_MAX && real_finite(low) &&
                    real_finite(1 / size) && real_finite(size) && size > 0 && real_abs(low) <= R(1e30) && size <= R(1e30);
        if (!fine) {
            return "a draft with divisions or a box that cannot be";
        }
    }
    if (words[WORD_SURFACES] > words[WORD_FACETS]) {
        return "a draft with more surfaces than facets";
    }
    if (words[WORD_FOOTPRINTS] > 65536 || words[WORD_KEPT] > ASET_KEPT_MAX || words[WORD_LIGHTS] > n_words || words[WORD_KEPT_WORDS] > n_words) {
        return "a draft with more lights, footprints or exact objects than it can have";
    }
    return NULL;
}

static const char *check_blocks(const aset_draft *d) {
    uint32_t n_all = d->blocks[0] * d->blocks[1] * d->blocks[2], n = 0, next = 0, in_voxel = 0;
    for (uint32_t i = 0; i < (n_all + 31) / 32; i++) {
        uint32_t beyond = i * 32 + 32 > n_all ? 0xffffffffu << (n_all & 31u) : 0;
        if (d->rank[i] != n || (d->map[i] & beyond) != 0) {
            return "a draft whose map of blocks contradicts itself";
        }
        n += bits_count(d->map[i]);
    }
    if (n != d->n_blocks) {
        return "a draft whose map of blocks contradicts itself";
    }
    for (uint32_t b = 0; b < d->n_blocks; b++) {
        uint32_t voxels = bits_count(draft_marks(d, b));
        uint32_t end = b + 1 < d->n_blocks ? d->first[b + 1] : d->n_facets;
        if (d->first[b] != next || end <= next || end > d->n_facets || !starts_bit(d->starts, next)) {
            return "a draft whose blocks have no facets";
        }
        for (; next < end; next++) {
            bool starts = starts_bit(d->starts, next);
            voxels -= starts;
            in_voxel = starts ? 1 : in_voxel + 1;
            if (in_voxel > 6) { /* rays have room for one on each side */
                return "a draft with a voxel of more than six facets";
            }
        }
        if (voxels != 0) {
            return "a draft whose voxels have no facets";
        }
    }
    return next == d->n_facets && starts_bit(d->starts, d->n_facets) ? NULL : "a draft with facets of no block";
}

/* No voxel lies beyond the divisions, where the walk of single rays would not begin. */
static const char *check_marks(const aset_draft *d) {
    const uint32_t *n = d->blocks;
    uint32_t dense = 0;
    for (uint32_t i = 0; i < n[0] * n[1] * n[2]; i++) {
        const uint32_t at[3] = {i % n[0] * 4, i / n[0] % n[1] * 4, i / n[0] / n[1] * 4};
        if (!draft_has_block(d, i)) {
            continue;
        }
        for (uint64_t marks = draft_marks(d, dense++); marks != 0; marks &= marks - 1) {
            unsigned k = bits_lowest(marks);
            for (int a = 0; a < 3; a++, k >>= 2) {
                if (at[a] + (k & 3u) >= d->n[a]) {
                    return "a draft with voxels beyond its divisions";
                }
            }
        }
    }
    return NULL;
}

static const char *check_facets(const aset_draft *d) {
    for (uint32_t i = 0; i < d->n_surfaces; i++) {
        uint32_t s = d->surfaces[i];
        if ((s & 7u) > 5 || (s >> 3 & SLOPE_MASK) > 2 * SLOPE_STEPS || (s >> (3 + SLOPE_BITS) & SLOPE_MASK) > 2 * SLOPE_STEPS ||
            s >> SURFACE_TEXTURE_SHIFT >= d->n_textures) {
            return "a draft with a surface that cannot be";
        }
    }
    for (uint32_t i = 0; i < d->n_facets; i++) {
        uint64_t record = words_get(d->facets, d->width, i);
        if ((record & ((1u << d->surface_width) - 1)) >= d->n_surfaces ||
            (record >> d->surface_width & ((1u << d->footprint_width) - 1)) >= d->n_footprints) {
            return "a draft with a facet that cannot be";
        }
    }
    for (uint32_t i = 0; i < d->n_textures * TEXTURE_WORDS; i++) {
        aset_real x = float_of_word(d->textures[i]);
        if (!(x >= 0 && x <= R(16777216))) {
            return "a draft with a texture that cannot be";
        }
    }
    return NULL;
}

/* ---- the stage ---- */

static aset_vec3 read_vec(const uint32_t *w) {
    return vec(float_of_word(w[0]), float_of_word(w[1]), float_of_word(w[2]));
}

static aset_material read_material(const uint32_t *w) {
    aset_material m;
    aset_real amounts[MATERIAL_AMOUNTS];
    for (int i = 0; i < MATERIAL_AMOUNTS; i++) {
        amounts[i] = float_of_word(w[i]);
    }
    memcpy(&m, amounts, sizeof amounts);
    m.one_sided = false;
    return m;
}

/* Does a material, by its words, need what is switched off? */
static bool is_beyond_switches(const uint32_t *w) {
#if ASET_WITH_REFRACTION
    (void)w;
    return false;
#else
    return float_of_word(w[6]) > 0; /* its transmittance */
#endif
}

aset_material aset_draft_material(const aset_draft *draft, uint32_t texture) {
    return read_material(draft->textures + (size_t)texture * TEXTURE_WORDS);
}

aset_material aset_draft_texture(const aset_draft *draft, uint32_t number) {
    facet f = facet_read(draft, number);
    return aset_draft_material(draft, f.texture);
}

static aset_status read_view(const uint32_t *words, const aset_sink *sink) {
    const uint32_t *w = words + WORD_VIEW;
    aset_vec3 background = read_vec(words + WORD_BACKGROUND);
    aset_colour colour = {background.x, background.y, background.z};
    aset_status status = sink->background(sink->context, &colour);
    if (status == ASET_OK && words[WORD_HAS_VIEW] != 0) {
        aset_view view = {read_vec(w),           read_vec(w + 3),       read_vec(w + 6), float_of_word(w[9]),
                          float_of_word(w[10]), w[11], w[12]};
        status = sink->view(sink->context, &view);
    }
    return status;
}

static aset_status read_lights(const uint32_t *w, uint32_t n, const aset_sink *sink) {
    aset_status status = ASET_OK;
    for (uint32_t i = 0; i < n && status == ASET_OK; i++, w += LIGHT_WORDS) {
        aset_vec3 c = read_vec(w + 3);
        aset_light light = {read_vec(w), {c.x, c.y, c.z}, (w[6] & LIGHT_HAS_COLOUR) != 0, (w[6] & LIGHT_DIRECTIONAL) != 0};
        status = sink->light(sink->context, &light);
    }
    return status;
}

#if ASET_WITH_OBJECTS

static aset_status read_polygon(const uint32_t *w, unsigned kind, uint32_t n_points, const aset_sink *sink) {
#if ASET_WITH_POLYGONS
    uint32_t stride = kind == KIND_PATCH ? 6 : 3;
    aset_status status = sink->polygon_begin(sink->context, n_points, kind == KIND_PATCH);
    for (uint32_t i = 0; i < n_points && status == ASET_OK; i++, w += stride) {
        aset_vec3 point = read_vec(w), normal = kind == KIND_PATCH ? read_vec(w + 3) : point;
        status = sink->polygon_point(sink->context, &point, kind == KIND_PATCH ? &normal : NULL);
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
#else
    (void)w, (void)kind, (void)n_points, (void)sink;
    return ASET_ERR_UNSUPPORTED;
#endif
}

/* One kept object; *n: its words. */
static aset_status read_kept(const uint32_t *w, uint32_t left, uint32_t *n, const aset_sink *sink) {
    if (left < KEPT_HEAD_WORDS) {
        return ASET_ERR_SYNTAX;
    }
    unsigned kind = w[0] & 0xffu;
    uint32_t n_points = w[0] >> 8 & 0xffffu, coordinates = 0;
    aset_material material = read_material(w + 1);
    material.one_sided = w[0] >> 31 != 0;
    if (is_beyond_switches(w + 1)) {
        return ASET_ERR_UNSUPPORTED;
    }
    switch (kind) {
    case KIND_POLYGON: coordinates = 3 * n_points; break;
    case KIND_PATCH: coordinates = 6 * n_points; break;
    case KIND_SPHERE: coordinates = ASET_COORDINATES_SPHERE; break;
    case KIND_CONE: coordinates = ASET_COORDINATES_CONE; break;
    default: return ASET_ERR_SYNTAX;
    }
    if (n_points > ASET_KEPT_POINTS_MAX || left - KEPT_HEAD_WORDS < coordinates) {
        return ASET_ERR_SYNTAX;
    }
    *n = KEPT_HEAD_WORDS + coordinates;
    w += KEPT_HEAD_WORDS;
    aset_status status = sink->material(sink->context, &material);
    if (status != ASET_OK) {
        return status;
    }
    if (kind == KIND_POLYGON || kind == KIND_PATCH) {
        return read_polygon(w, kind, n_points, sink);
    }
#if ASET_WITH_SPHERES
    if (kind == KIND_SPHERE) {
        aset_vec3 centre = read_vec(w);
        return sink->sphere(sink->context, &centre, float_of_word(w[3]));
    }
#endif
#if ASET_WITH_CONES
    if (kind == KIND_CONE) {
        aset_vec3 base = read_vec(w), apex = read_vec(w + 4);
        return sink->cone(sink->context, &base, float_of_word(w[3]), &apex, float_of_word(w[7]));
    }
#endif
    return ASET_ERR_UNSUPPORTED;
}

#else

static aset_status read_kept(const uint32_t *w, uint32_t left, uint32_t *n, const aset_sink *sink) {
    (void)w, (void)left, (void)n, (void)sink;
    return ASET_ERR_UNSUPPORTED;
}

#endif

aset_status aset_draft_read_stage(const aset_draft *draft, const aset_sink *sink) {
    const uint32_t *words = draft->words, *w = draft->textures + (size_t)draft->n_textures * TEXTURE_WORDS;
    uint32_t left = words[WORD_KEPT_WORDS];
    aset_status status = read_view(words, sink);
    if (status == ASET_OK) {
        status = read_lights(w, words[WORD_LIGHTS], sink);
    }
    w += (size_t)words[WORD_LIGHTS] * LIGHT_WORDS;
    for (uint32_t i = 0; i < words[WORD_KEPT] && status == ASET_OK; i++) {
        uint32_t n = 0;
        status = read_kept(w, left, &n, sink);
        w += n;
        left -= n;
    }
    return status == ASET_OK && left > 0 ? ASET_ERR_SYNTAX : status;
}

static aset_status count_stage(aset_counts *counts, const aset_draft *draft) {
#if ASET_WITH_OBJECTS
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    aset_status status = aset_draft_read_stage(draft, &sink);
    *counts = counter.counts;
    return status;
#else /* lights are all there is: the counter need not be linked */
    memset(counts, 0, sizeof *counts);
    counts->lights = draft->words[WORD_LIGHTS];
    return ASET_OK;
#endif
}

/* Twice: to count what the stage takes, and to build it. */
static aset_status make_stage(aset_draft *draft, aset_arena *arena) {
    aset_counts counts;
    aset_status status = count_stage(&counts, draft);
    if (status == ASET_OK) {
        status = aset_scene_init(&draft->stage, arena, &counts);
    }
    if (status == ASET_OK) {
        aset_sink sink = aset_scene_sink(&draft->stage);
        status = aset_draft_read_stage(draft, &sink);
    }
    return status;
}

static aset_status refuse(const char *sentence, const char **why) {
    if (why != NULL) {
        *why = sentence;
    }
    return ASET_ERR_SYNTAX;
}

aset_status aset_draft_open(aset_draft *draft, const uint32_t *words, size_t n_words, aset_arena *arena, const char **why) {
    aset_draft opened;
    if (draft == NULL || words == NULL || arena == NULL || (uintptr_t)words % sizeof *words != 0) {
        return ASET_ERR_ARGUMENT;
    }
    const char *wrong = check_header(words, n_words);
    if (wrong == NULL && !aset_draft_bind(&opened, words, n_words)) {
        wrong = "a draft whose parts do not fill its length";
    }
    wrong = wrong != NULL ? wrong : check_blocks(&opened);
    wrong = wrong != NULL ? wrong : check_marks(&opened);
    wrong = wrong != NULL ? wrong : check_facets(&opened);
    if (wrong != NULL) {
        return refuse(wrong, why);
    }
    for (uint32_t i = 0; i < opened.n_textures; i++) {
        if (is_beyond_switches(opened.textures + (size_t)i * TEXTURE_WORDS)) {
            return ASET_ERR_UNSUPPORTED;
        }
    }
    aset_draft_bind_marks(&opened);
    aset_mark mark = aset_arena_mark(arena);
    aset_status status = make_stage(&opened, arena);
    if (status != ASET_OK) {
        aset_arena_release(arena, &mark);
        bool is_ours = status == ASET_ERR_NOMEM || status == ASET_ERR_UNSUPPORTED;
        return is_ours ? status : refuse("a draft with a light, a view or an exact object that cannot be", why);
    }
    *draft = opened;
    return ASET_OK;
}

#endif
