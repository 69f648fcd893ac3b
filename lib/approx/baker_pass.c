/*
 * baker_pass.c - what happens between the passes of a bake: which objects are kept, where the cells are, how the region is cut up, and
 * what to do when it is too small.
 */
#include "approx/baker.h"

#include "base/whole.h"

#if ASET_WITH_DRAFTS

/* An object is kept exact if its box's diagonal is at least this part of the scene's. */
#define KEPT_DIAGONAL R(0.25)
/* So that the inverse of a column's size is a number in float, and of a ray's, too. */
#define LEAST_SLACK R(1e-30)
#define AUTO_LONGEST_MAX 128u
#define AUTO_LONGEST_MIN 8u
/* Automatic divisions: bytes of bake for each square of the longest axis' divisions. */
#define AUTO_BYTES_PER_SQUARE 112u
/* Textures of a draft: what does not fit shares the nearest. */
#define TEXTURES_MAX 2048u

/* What is for the stage is only counted, from here on. */
static void count_stage(aset_baker *b) {
    b->stage_sink = aset_counter_sink(&b->counter);
}

/*
 * Which objects are kept: the largest, no more than ASET_KEPT_MAX, and of equally large ones all or none, so that their order
 * does not matter.
 */
static void choose_kept(aset_baker *b) {
    aset_vec3 d = vec_sub(b->high, b->low);
    aset_real least = KEPT_DIAGONAL * KEPT_DIAGONAL * vec_dot(d, d);
    uint32_t n = 0;
    for (uint32_t i = 1; i <= b->n_largest && i <= ASET_KEPT_MAX && b->largest[i - 1] >= least; i++) {
        if (i == b->n_largest || b->largest[i] < b->largest[i - 1]) {
            n = i;
        }
    }
    b->n_kept = b->options.keep_none ? 0 : n;
    b->kept_from = n > 0 ? b->largest[n - 1] : 0;
}

static void choose_divisions(aset_baker *b, size_t bytes, uint32_t longest_max) {
    aset_vec3 extent = vec_sub(b->high, b->low);
    uint32_t longest = AUTO_LONGEST_MIN;
    if (b->options.divisions[0] > 0) {
        memcpy(b->n, b->options.divisions, sizeof b->n);
        return;
    }
    while (longest + 4 <= longest_max && (uint64_t)(longest + 4) * (longest + 4) * AUTO_BYTES_PER_SQUARE <= bytes) {
        longest += 4;
    }
    for (int a = 0; a < 3; a++) {
        aset_real share = vec_largest(extent) > 0 ? vec_at(&extent, a) / vec_largest(extent) : 1;
        b->n[a] = (uint32_t)(share * (aset_real)longest + R(0.999));
        b->n[a] = b->n[a] > 0 ? b->n[a] : 1;
    }
}

/* Rounding of the words' floats, whatever a real is here. */
#define WORD_UNIT R(5.9604644775390625e-8)

/* The box of what the cells hold, a little larger, in numbers that the words can say. False: they can't. */
static bool place_cells(aset_baker *b) {
    aset_vec3 low = b->low, high = b->high;
    if (b->n_materials == 0) { /* all objects are kept */
        low = high = vec(0, 0, 0);
    }
    aset_vec3 extent = vec_sub(high, low);
    aset_real size = vec_largest(extent), largest = real_max(vec_largest(low), vec_largest(high));
    if (size >= STEPS_LEAST * 2 * REAL_UNIT * largest && size < STEPS_LEAST * 2 * WORD_UNIT * largest) {
        return false;
    }
    aset_real slack = R(1e-3) * size + 16 * WORD_UNIT * largest;
    slack = slack > LEAST_SLACK ? slack : size > 0 ? LEAST_SLACK : 1;
    for (int a = 0; a < 3; a++) {
        aset_real grown = vec_at(&extent, a) + 2 * slack / 16;
        b->origin[a] = float_of_word(word_of_float(vec_at(&low, a) - slack / 16));
        b->size[a] = float_of_word(word_of_float(grown / (aset_real)(4 * b->n[a])));
        b->scale[a] = 1 / b->size[a];
        b->blocks[a] = (b->n[a] + 3) / 4;
    }
    return true;
}

static size_t texture_bytes(const aset_baker *b) {
    return ASET_ROUND(b->texture_capacity * sizeof *b->textures);
}

static size_t point_bytes(const aset_baker *b) {
    return ASET_ROUND((size_t)b->max_points * 3 * sizeof *b->points) + ASET_ROUND((size_t)b->max_points * sizeof *b->crossings);
}

static size_t fixed_bytes(const aset_baker *b) {
    return point_bytes(b) + (size_t)baker_blocks(b) * sizeof *b->marks + texture_bytes(b);
}

/* Cuts the region up; the bins of a pass take what the raw facets leave. */
static void cut_region(aset_baker *b) {
    unsigned char *at = b->region;
    b->points = (aset_real *)(void *)at;
    at += ASET_ROUND((size_t)b->max_points * 3 * sizeof *b->points);
    b->crossings = (aset_real *)(void *)at;
    at += ASET_ROUND((size_t)b->max_points * sizeof *b->crossings);
    b->marks = (uint64_t *)(void *)at;
    at += (size_t)baker_blocks(b) * sizeof *b->marks;
    b->textures = (aset_material *)(void *)at;
    at += texture_bytes(b);
    b->after = at;
    b->raw = (uint64_t *)(void *)(b->region + b->region_bytes);
    memset(b->marks, 0, (size_t)baker_blocks(b) * sizeof *b->marks);
}

/* A key, a bin, and the raw facet that it may become. */
#define BYTES_PER_BIN(b) (sizeof *(b)->keys + (b)->bin_bytes + sizeof *(b)->raw)
/* The fewest bins worth a pass. */
#define BINS_MIN 64u

static bool start_pass(aset_baker *b) {
    size_t left = (size_t)((unsigned char *)(b->raw - b->n_raw) - b->after);
    size_t capacity = left / BYTES_PER_BIN(b);
    b->capacity = capacity < UINT32_MAX / 2 ? (uint32_t)capacity : UINT32_MAX / 2;
    b->ceiling_block = baker_blocks(b);
    if (b->capacity <= BINS_MIN) {
        return false;
    }
    b->capacity--; /* for the rounding of the keys */
    b->keys = (uint32_t *)(void *)b->after;
    b->bins = b->after + ASET_ROUND(b->capacity * sizeof *b->keys);
    aset_bins_clear(b);
    if (b->floor_block == 0) {
        b->report.unseen = 0;
    }
    return true;
}

/* The most bytes that the region may take. */
static size_t room_for_region(const aset_baker *b) {
    size_t left = b->arena->size - b->arena->used, taken = b->arena->used - b->mark.used, most = b->options.bytes;
    most = most > taken ? most - taken : 0;
    return (b->options.bytes > 0 && most < left ? most : left) / ASET_ALIGN * ASET_ALIGN;
}

/* Does what is taken before the region go beyond what the caller has granted? What the arena has is told by its taking. */
static bool is_beyond_grant(const aset_baker *b, uint64_t bytes) {
    return b->options.bytes > 0 && bytes > room_for_region(b);
}

/* A region of need bytes would have done; there is none now. */
static aset_status give_up(aset_baker *b, size_t need) {
    size_t left = room_for_region(b);
    b->arena->missing = need > left ? need - left : 1;
    b->phase = PHASE_FAILED;
    aset_arena_release(b->arena, &b->mark);
    return ASET_ERR_NOMEM;
}

/* Memory for one block in which every side is marked. */
static size_t need_at_most(const aset_baker *b) {
    size_t sides = 64 * 6;
    return whole_bytes(fixed_bytes(b) + (sides + sides / 4 + 2 * BINS_MIN) * BYTES_PER_BIN(b) +
                       (uint64_t)b->n_counted * sizeof *b->raw);
}

static uint32_t longest_divisions(const aset_baker *b) {
    uint32_t longest = b->n[0] > b->n[1] ? b->n[0] : b->n[1];
    return longest > b->n[2] ? longest : b->n[2];
}

/* Are the divisions ours to choose, and not the coarsest? */
static bool can_coarsen(const aset_baker *b) {
    return b->options.divisions[0] == 0 && longest_divisions(b) > AUTO_LONGEST_MIN;
}

/* Divisions to try after these. */
static uint32_t coarser(const aset_baker *b) {
    uint32_t longest = longest_divisions(b) * 3 / 4;
    return longest > AUTO_LONGEST_MIN ? longest : AUTO_LONGEST_MIN;
}

/* A region with room for the fewest bins. */
static size_t need_at_least(const aset_baker *b) {
    return fixed_bytes(b) + 2 * BINS_MIN * BYTES_PER_BIN(b);
}

/* ASET_BYTES_BAKE has room for polygons of so few points. */
#define POINT_BYTES_FEW 8192u

/* What marks and points leave is shared out: so that the whole list of textures has its part of 512 kB (of 1 MB in double). */
#define TEXTURE_SHARE 7u

/* The region's bytes for the divisions, of so many; wanted: 0 for as many as usual. */
static void size_region(aset_baker *b, size_t room, size_t wanted) {
    if (wanted == 0 && b->options.bytes > 0) {
        wanted = room;
    } else if (wanted == 0) {
        size_t points = point_bytes(b), usual = ASET_BYTES_BAKE(b->n[0], b->n[1], b->n[2]);
        wanted = points > POINT_BYTES_FEW ? whole_bytes_sum(usual, points) : usual;
    }
    b->region_bytes = wanted < room ? wanted / ASET_ALIGN * ASET_ALIGN : room;
    b->texture_capacity = b->single ? 1 : TEXTURES_MAX;
    while (b->texture_capacity > 64 &&
           (fixed_bytes(b) > b->region_bytes || texture_bytes(b) > (b->region_bytes + texture_bytes(b) - fixed_bytes(b)) / TEXTURE_SHARE)) {
        b->texture_capacity /= 2;
    }
}

/* The region, and in it everything for the divisions; wanted: its bytes, 0 for as many as usual. */
static aset_status start_baking(aset_baker *b, size_t wanted, uint32_t longest_max) {
    size_t room = room_for_region(b);
    b->single = b->n_materials <= 1;
    b->bin_bytes = ASET_ROUND(b->single ? BIN_BYTES_SINGLE : sizeof(bin));
    choose_divisions(b, room, longest_max);
    size_region(b, room, wanted);
    while (b->region_bytes < need_at_least(b) && can_coarsen(b)) {
        choose_divisions(b, room, coarser(b));
        size_region(b, room, 0);
    }
    if (!place_cells(b)) {
        return ASET_ERR_PRECISION;
    }
    b->n_raw = 0;
    b->n_counted = 0;
    b->n_textures = 0;
    b->n_listed = b->n_surfaces = b->n_footprints = 0;
    b->floor_block = 0;
    b->counting = false;
    b->failure = ASET_OK;
    b->report.voxels = b->report.merged = 0;
    if (b->region_bytes < need_at_least(b)) {
        b->region_bytes = 0;
        return give_up(b, need_at_most(b));
    }
    b->region = aset_arena_alloc(b->arena, b->region_bytes, ASET_CATEGORY_SCRATCH);
    cut_region(b);
    (void)start_pass(b);
    b->phase = PHASE_BAKE;
    return ASET_OK;
}

static void free_region(aset_baker *b) {
    b->arena->used -= b->region_bytes; /* it was taken last */
    b->arena->used_by[ASET_CATEGORY_SCRATCH] -= b->region_bytes;
}

/* The region was too small: once more with a larger one, or coarser if the divisions are ours to choose. */
static aset_status bake_again(aset_baker *b, size_t need) {
    uint32_t longest = longest_divisions(b);
    size_t had = b->region_bytes;
    free_region(b);
    size_t room = room_for_region(b);
    count_stage(b);
    if (had < room) {
        return start_baking(b, had / 4 * 5 < room ? had / 4 * 5 : room, longest);
    }
    if (can_coarsen(b)) {
        return start_baking(b, 0, coarser(b));
    }
    return give_up(b, need);
}

/* The stage takes its memory when all its counts are known; its entities come with the next pass. */
static aset_status start_stage(aset_baker *b) {
    b->report.kept = b->counter.counts.objects;
    if (b->report.kept != b->n_kept || b->counter.counts.lights != b->n_lights) {
        return ASET_ERR_GEOMETRY; /* not the same source as in the first pass */
    }
#if ASET_RECENT < ASET_KEPT_MAX
    /* A hostile build: in the words' order materials may repeat that were remembered in the source's. */
    b->counter.counts.materials = b->counter.counts.objects;
#endif
    const aset_counts *counts = &b->counter.counts;
    uint64_t bytes = ASET_BYTES_SCENE(counts->objects, counts->coordinates, counts->materials, counts->lights);
    if (is_beyond_grant(b, bytes)) {
        return give_up(b, whole_bytes(bytes));
    }
    aset_status status = aset_scene_init(&b->stage, b->arena, counts);
    if (status == ASET_OK) {
        b->stage_sink = aset_scene_sink(&b->stage);
        status = start_baking(b, 0, AUTO_LONGEST_MAX);
    }
    return status;
}

/* After the first pass. */
static aset_status end_measuring(aset_baker *b) {
    if (b->report.objects == 0) {
        b->phase = PHASE_FAILED;
        return ASET_ERR_GEOMETRY;
    }
    size_t most = whole_bytes((uint64_t)b->max_points * 64);
    if (most / 64 < b->max_points) { /* a polygon that this machine's addresses do not hold */
        b->arena->missing = most;
        return ASET_ERR_NOMEM;
    }
    b->n_lights = b->counter.counts.lights;
    choose_kept(b);
    if (b->n_kept == 0) {
        return start_stage(b);
    }
    size_t bytes = ASET_KEPT_POINTS_MAX * 3 * sizeof *b->points; /* while fitting, kept polygons are counted only */
    bytes = bytes > (size_t)b->max_points * 3 * sizeof *b->points ? bytes : (size_t)b->max_points * 3 * sizeof *b->points;
    if (is_beyond_grant(b, bytes)) {
        return give_up(b, bytes);
    }
    b->points = aset_arena_alloc(b->arena, bytes, ASET_CATEGORY_SCRATCH);
    if (b->points == NULL) {
        b->phase = PHASE_FAILED;
        return ASET_ERR_NOMEM;
    }
    b->phase = PHASE_FIT;
    b->n_materials = 0;
    b->is_other = true;
    count_stage(b);
    return ASET_OK;
}

static aset_status end_baking(aset_baker *b) {
    const aset_counts *given = b->stage_sink.context == &b->stage ? &b->stage.counts : &b->counter.counts;
    if (given->lights != b->n_lights || given->objects != b->n_kept) {
        return ASET_ERR_GEOMETRY;
    }
    if (b->failure == ASET_ERR_NOMEM) {
        return bake_again(b, need_at_most(b));
    }
    if (b->failure != ASET_OK) {
        return b->failure;
    }
    aset_baker_harvest(b);
    b->floor_block = b->ceiling_block;
    count_stage(b); /* the stage has its entities: further ones go nowhere */
    if (b->floor_block == baker_blocks(b)) {
        size_t work = aset_baker_words_bound(b, b->n_counted), bins = need_at_most(b);
        if (b->counting) {
            return bake_again(b, work > bins ? work : bins);
        }
        if (aset_baker_write(b) != ASET_OK) {
            return bake_again(b, work);
        }
        b->phase = PHASE_DONE;
        return ASET_OK;
    }
    bool can_begin_again = can_coarsen(b) || room_for_region(b) > 0;
    bool goes_on = (!can_begin_again || aset_baker_may_have_room(b)) && start_pass(b);
    if (!goes_on && can_begin_again) {
        return bake_again(b, 0); /* now, and not after all the passes that are to come */
    }
    if (!goes_on) {
        b->counting = true; /* no room for more facets: they are counted, to tell the need */
        b->n_raw = 0;
        (void)start_pass(b);
    }
    return ASET_OK;
}

aset_status aset_baker_init(aset_baker *baker, aset_arena *arena, const aset_bake_options *options) {
    if (baker == NULL || arena == NULL) {
        return ASET_ERR_ARGUMENT;
    }
    memset(baker, 0, sizeof *baker);
    if (options != NULL) {
        baker->options = *options;
        bool is_auto = options->divisions[0] == 0 && options->divisions[1] == 0 && options->divisions[2] == 0;
        for (int a = 0; a < 3 && !is_auto; a++) {
            if (options->divisions[a] < 1 || options->divisions[a] > ASET_BAKE_DIVISIONS_MAX) {
                return ASET_ERR_ARGUMENT;
            }
        }
    }
    baker->arena = arena;
    baker->mark = aset_arena_mark(arena);
    baker->phase = PHASE_MEASURE;
    count_stage(baker);
    return ASET_OK;
}

/* Objects that still come are refused, and nothing is kept of what else does. */
static void end_taking(aset_baker *b) {
    b->failure = ASET_ERR_ARGUMENT;
    count_stage(b);
}

aset_status aset_baker_pass(aset_baker *baker, bool *again) {
    aset_status status = ASET_ERR_ARGUMENT;
    if (baker == NULL || again == NULL) {
        return status;
    }
    baker->counter.outline.open = false;
    bool is_same = baker->phase == PHASE_MEASURE || baker->taken == baker->report.objects;
    baker->taken = 0;
    switch (baker->phase) {
    case PHASE_MEASURE: status = end_measuring(baker); break;
    case PHASE_FIT:
        aset_arena_release(baker->arena, &baker->mark);
        baker->points = NULL;
        status = start_stage(baker);
        break;
    case PHASE_BAKE: status = end_baking(baker); break;
    default: *again = false; return status; /* whatever it had is no longer ours to release */
    }
    baker->report.passes++;
    if (status == ASET_OK && !is_same) {
        status = ASET_ERR_GEOMETRY; /* nor is the first pass's box theirs */
    }
    if (status != ASET_OK) {
        aset_arena_release(baker->arena, &baker->mark);
        baker->phase = PHASE_FAILED;
    }
    if (baker->phase == PHASE_FAILED || baker->phase == PHASE_DONE) {
        end_taking(baker);
    }
    *again = status == ASET_OK && baker->phase != PHASE_DONE;
    return status;
}

void aset_baker_abandon(aset_baker *baker) {
    if (baker == NULL || baker->arena == NULL || baker->phase == PHASE_FAILED) {
        return; /* nothing was taken, or it is no longer ours */
    }
    aset_arena_release(baker->arena, &baker->mark);
    baker->phase = PHASE_FAILED;
    end_taking(baker);
}

#endif
