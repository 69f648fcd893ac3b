/*
 * prepare.c - a scene, a space over it, its summary and the threads' scratches, all in one arena of the size asked for.
 *
 * The file is read once to count, then to build in exactly the bytes counted; what streams is read as often as is asked for.
 */
#include "prepare.h"

#include "need.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const aset_method *const tool_methods[] = {&aset_mset, &aset_set,    &aset_grid,  &aset_octree,
                                            &aset_arts, &aset_excell, &aset_brute, NULL};

const aset_method *tool_method_find(const char *name, bool *is_aset) {
    *is_aset = strcmp(name, "aset") == 0;
    if (*is_aset) {
        return &aset_mset;
    }
    for (size_t i = 0; tool_methods[i] != NULL; i++) {
        if (strcmp(aset_method_name(tool_methods[i]), name) == 0) {
            return tool_methods[i];
        }
    }
    return NULL;
}

static bool approximates(const settings *s) {
    return s->approx_kinds != 0;
}

static size_t scratch_bytes(const settings *s) {
    return s->threads * ASET_BYTES_SCRATCH(s->depth);
}

static aset_space_options space_options(const settings *s, const aset_scene *scene) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    options.depth = s->tree_depth;
    options.leaf = s->leaf;
    options.textures = approximates(s) ? aset_summary_capacity(scene) : 0;
    return options;
}

static aset_space_options flat_options(const settings *s) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    return options;
}

/* The error of a budget that is too small: how much would do; for what is automatic, at its coarsest. */
static void tell_need(tool_source *source, const settings *s, const aset_counts *counts) {
    measured m;
    aset_space_size size;
    size_t summary = 0;
    if (!measured_open(&m, source, counts)) {
        return;
    }
    aset_space_options options = space_options(s, &m.scene);
    if (options.divisions[0] == 0) {
        options.divisions[0] = options.divisions[1] = options.divisions[2] = 1;
    }
    if (measured_space(&m, source->path, s->method, &options, &size, approximates(s) ? &summary : NULL)) {
        size_t before = m.scene_bytes + scratch_bytes(s), kept = size.cells + size.references + size.voxels + summary;
        tool_error(source->path, 0, "the picture needs %zu bytes, has %" PRIu64,
                   before + (kept > size.total ? kept : size.total), s->memory);
    }
    free(m.block);
}

/* Where background, view and lights are: with a streamed draft, its own. */
static const aset_scene *stage_of(const prepared *p) {
    return p->is_drafted && p->is_streamed ? &p->draft.stage : &p->scene;
}

/* A view for a scene: the file's, with the command line's changes. */
static bool choose_view(prepared *p, const settings *s) {
    aset_view *view = &p->view;
    *view = stage_of(p)->view;
    view->width_px = s->width > 0 ? s->width : view->width_px > 0 ? view->width_px : 512;
    view->height_px = s->height > 0 ? s->height : view->height_px > 0 ? view->height_px : 512;
    return settings_view(view, s, p->path);
}

#define REACH_TILES 64u
/* A band of a draft of 64 divisions rarely has more voxels, one of 128 hardly ever. */
#define BEAM_VOXELS_LEAST 3072u
#define BEAM_VOXELS_MOST 12288u
#define BEAM_THREADS 8u

/* Voxels of a band for which the arena has room besides a reach; 0: it has none. */
static uint32_t beam_voxels(const prepared *p, const settings *s) {
    uint32_t voxels = BEAM_VOXELS_MOST;
    size_t left = p->arena.size - p->arena.used + scratch_bytes(s);
    size_t fixed = BEAM_THREADS * ASET_BYTES_SCRATCH(s->depth) + ASET_BYTES_REACH(REACH_TILES, p->draft.stage.counts.lights);
    while (voxels > BEAM_VOXELS_LEAST && (voxels > p->draft.n_facets / 4 || left < fixed + BEAM_THREADS * ASET_BYTES_BEAMS(voxels))) {
        voxels /= 2;
    }
    return left < fixed + BEAM_THREADS * ASET_BYTES_BEAMS(voxels) ? 0 : voxels;
}

/*
 * What lets a draft be drawn in less time, if the arena has room for it besides, and with how many threads. How much room it has is
 * asked for eight of them, and none draws without what the others have: counts of cells are the same for every number.
 */
static void take_aids(prepared *p, const settings *s) {
    p->mark = aset_arena_mark(&p->arena);
    p->n_threads = s->threads;
    if (!p->is_drafted || s->cells != CELLS_PLANE) {
        return;
    }
    uint32_t voxels = beam_voxels(p, s);
    if (voxels == 0 || aset_reach_init(&p->reach, &p->draft, REACH_TILES, &p->arena) != ASET_OK) {
        return;
    }
    p->tracer.reach = &p->reach;
    uint32_t i = 0;
    for (; i < s->threads && aset_beams_init(&p->beams[i], voxels, &p->arena) == ASET_OK; i++) {
        p->scratches[i].beams = &p->beams[i];
    }
    p->n_threads = i > 0 ? i : p->n_threads;
}

static void choose_tracer(prepared *p, const settings *s) {
    aset_tracer *t = &p->tracer;
    memset(t, 0, sizeof *t);
    t->scene = stage_of(p);
    t->space = p->is_drafted && p->is_streamed ? NULL : &p->space;
    t->summary = approximates(s) && !p->is_drafted ? &p->summary : NULL;
    t->draft = p->is_drafted ? &p->draft : NULL;
    t->draft_sides = s->cells == CELLS_NORMAL;
    t->approx_kinds = s->approx_kinds;
    t->approx_depth = s->approx_depth;
    t->curtail = (aset_real)s->curtail;
    t->curtail_more = s->curtail_more;
    t->depth = s->depth;
    t->samples = s->samples;
    t->spd_rules = s->spd_rules;
}

/* A draft of what the source holds, in the arena's free bytes. */
static aset_status bake(prepared *p, const settings *s, tool_source *source, bool *told) {
    tool_baking baking;
    aset_bake_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    aset_status status = tool_bake(&baking, source, &options, &p->arena);
    *told = baking.told || tool_bake_tell(source, status);
    p->draft = baking.draft;
    p->load_s += baking.load_s;
    p->build_s += baking.build_s;
    return status;
}

/* Space and summary straight from the source. */
static aset_status flatten(prepared *p, const settings *s, tool_source *source, const aset_counter *counter, bool *told) {
    tool_flat flat;
    aset_space_options options = flat_options(s);
    flat.stage = &p->scene;
    flat.space = &p->space;
    flat.summary = &p->summary;
    aset_status status = tool_flatten(&flat, source, counter, s->method, &options, &p->arena);
    *told = flat.told;
    p->load_s += flat.load_s;
    p->build_s += flat.build_s;
    return status;
}

/* No object is held: scratches, and the draft or the cells. */
static aset_status fill_streamed(prepared *p, const settings *s, tool_source *source, const aset_counter *counter,
                                 bool *told) {
    aset_status status = ASET_OK;
    for (uint32_t i = 0; i < s->threads && status == ASET_OK; i++) {
        status = aset_scratch_init(&p->scratches[i], s->depth, &p->arena);
    }
    if (status != ASET_OK) {
        return status;
    }
    return p->is_drafted ? bake(p, s, source, told) : flatten(p, s, source, counter, told);
}

/* Scene, scratches, space and summary in the arena. */
static aset_status fill_arena(prepared *p, const settings *s, tool_source *source, const aset_counts *counts, bool *told) {
    aset_status status = aset_scene_init(&p->scene, &p->arena, counts);
    if (status != ASET_OK) {
        return status;
    }
    double start = tool_seconds();
    aset_sink sink = aset_scene_sink(&p->scene);
    if (!tool_source_read(source, &sink)) {
        *told = true;
        return ASET_ERR_SYNTAX;
    }
    p->load_s += tool_seconds() - start;
    start = tool_seconds();
    for (uint32_t i = 0; i < s->threads && status == ASET_OK; i++) {
        status = aset_scratch_init(&p->scratches[i], s->depth, &p->arena);
    }
    aset_space_options options = space_options(s, &p->scene);
    if (status == ASET_OK) {
        status = aset_space_build(&p->space, &p->scene, s->method, &options, &p->arena);
    }
    if (status == ASET_OK && approximates(s) && !p->is_drafted) {
        status = aset_summary_build(&p->summary, &p->space, options.textures, &p->arena);
    }
    p->build_s += tool_seconds() - start;
    return status == ASET_OK && p->is_drafted ? bake(p, s, source, told) : status;
}

static aset_status fill(prepared *p, const settings *s, tool_source *source, const aset_counter *counter, bool *told) {
    p->counts = counter->counts;
    p->is_drafted = approximates(s) && s->cells != CELLS_FLAT;
    p->is_streamed = tool_streams(s->method, s->approx_kinds, s->approx_depth);
    return p->is_streamed ? fill_streamed(p, s, source, counter, told) : fill_arena(p, s, source, &counter->counts, told);
}

/* The arena's block, and room for the threads' scratches. False after an error line. */
static bool take_block(prepared *p, const settings *s) {
    p->block = malloc(s->memory > 0 ? (size_t)s->memory : 1);
    p->scratches = calloc(s->threads, sizeof *p->scratches);
    p->beams = calloc(s->threads, sizeof *p->beams);
    if (p->block == NULL || p->scratches == NULL || p->beams == NULL || aset_arena_init(&p->arena, p->block, (size_t)s->memory) != ASET_OK) {
        tool_error(p->path, 0, "the machine has no block of %" PRIu64 " bytes", s->memory);
        return false;
    }
    return true;
}

/* What a draft is tried with, in more memory than it had. */
typedef struct prepare_trial {
    const settings *settings;
    tool_source *source;
    const aset_counter *counter;
} prepare_trial;

static draft_trial try_draft(void *context, uint64_t memory) {
    const prepare_trial *of = context;
    draft_trial t = {ASET_ERR_ARGUMENT, false, 0, 0};
    prepared more;
    settings rich = *of->settings;
    memset(&more, 0, sizeof more);
    more.path = of->source->path;
    rich.memory = memory;
    t.told = !take_block(&more, &rich);
    if (!t.told) {
        t.status = fill(&more, &rich, of->source, of->counter, &t.told);
    }
    t.missing = more.arena.missing;
    t.peak = more.arena.peak;
    prepare_free(&more);
    return t;
}

uint64_t prepare_draft_need(const settings *s, tool_source *source, const aset_counter *counter) {
    prepare_trial of = {s, source, counter};
    return tool_narrow_draft_need(try_draft, &of, 0, s->memory);
}

/* Memory in which the need of a streamed flat picture is looked for, if that is enough. */
#define FLAT_BYTES ((size_t)16 << 20)

/*
 * The error of a budget too small for a streamed flat picture, with automatic divisions at their coarsest: found by making
 * it in more.
 */
static void tell_flat_need(const settings *s, tool_source *source, const aset_counter *counter) {
    aset_scene stage;
    aset_space space;
    aset_summary summary;
    aset_arena arena;
    tool_flat flat = {&stage, &space, &summary, 0, 0, 0, false};
    aset_space_options options = flat_options(s);
    aset_status status = ASET_ERR_NOMEM;
    if (options.divisions[0] == 0) {
        options.divisions[0] = options.divisions[1] = options.divisions[2] = 1;
    }
    for (size_t size = FLAT_BYTES; status == ASET_ERR_NOMEM; size += arena.missing) {
        void *block = malloc(size);
        status = block != NULL ? aset_arena_init(&arena, block, size) : ASET_ERR_LIMIT;
        status = status == ASET_OK ? tool_flatten(&flat, source, counter, s->method, &options, &arena) : status;
        free(block);
    }
    if (status == ASET_OK) {
        tool_error(source->path, 0, "the picture needs %zu bytes, has %" PRIu64, scratch_bytes(s) + flat.least, s->memory);
    } else if (!flat.told) {
        tool_error(source->path, 0, "%s",
                   status == ASET_ERR_LIMIT ? "the machine has no memory for so many cells" : aset_status_text(status));
    }
}

static bool prepare_from(prepared *p, const settings *s, tool_source *source) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    double start = tool_seconds();
    if (!tool_source_read(source, &sink)) {
        return false;
    }
    p->load_s = tool_seconds() - start;
    tool_source_rules(source, s, &counter.counts);
    if (!take_block(p, s)) {
        return false;
    }
    bool told = false;
    aset_status status = fill(p, s, source, &counter, &told);
    if (status == ASET_ERR_NOMEM && p->is_drafted) {
        prepare_trial of = {s, source, &counter};
        tool_tell_draft_need(try_draft, &of, source->path, s->memory, p->arena.missing,
                             tool_need_is_quick(counter.counts.objects, s->grid));
    } else if (status == ASET_ERR_NOMEM && p->is_streamed) {
        tell_flat_need(s, source, &counter);
    } else if (status == ASET_ERR_NOMEM) {
        tell_need(source, s, &counter.counts);
    } else if (status != ASET_OK && !told) {
        tool_error(source->path, 0, "%s", aset_status_text(status));
    }
    return status == ASET_OK && choose_view(p, s);
}

/* ---- a baked draft, instead of a source ---- */

/* The bytes of a file; 0 after an error line, as an empty one is none. */
static uint64_t file_bytes(const char *path, FILE *file) {
    struct stat status;
    if (fstat(fileno(file), &status) != 0) {
        tool_error(path, 0, "cannot be read: %s", strerror(errno));
        return 0;
    }
    if (!S_ISREG(status.st_mode) || status.st_size == 0 || status.st_size % 4 != 0) {
        tool_error(path, 0, "not a draft, expected a file whose bytes are a multiple of 4");
        return 0;
    }
    return (uint64_t)status.st_size;
}

/* The file has the lowest byte of each word first, whatever the machine's order is. */
static bool read_words(const char *path, FILE *file, uint32_t *words, size_t n_words) {
    unsigned char *bytes = (unsigned char *)words;
    if (fread(words, sizeof *words, n_words, file) != n_words) {
        tool_error(path, 0, "cannot be read: %s", ferror(file) != 0 ? strerror(errno) : "it has become shorter");
        return false;
    }
    for (size_t i = 0; i < n_words; i++, bytes += 4) {
        words[i] = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    }
    return true;
}

/* Scratches, the words and their stage in the arena. *told: it has failed and said so. */
static aset_status fill_baked(prepared *p, const settings *s, FILE *file, size_t n_words, bool *told) {
    aset_status status = ASET_OK;
    const char *why = NULL;
    for (uint32_t i = 0; i < s->threads && status == ASET_OK; i++) {
        status = aset_scratch_init(&p->scratches[i], s->depth, &p->arena);
    }
    uint32_t *words = status == ASET_OK ? aset_arena_alloc(&p->arena, n_words * sizeof *words, ASET_CATEGORY_CELLS) : NULL;
    if (words == NULL) {
        return status == ASET_OK ? ASET_ERR_NOMEM : status;
    }
    *told = !read_words(p->path, file, words, n_words);
    status = *told ? ASET_ERR_READ : aset_draft_open(&p->draft, words, n_words, &p->arena, &why);
    if (why != NULL) {
        tool_error(p->path, 0, "%s", why);
        *told = true;
    }
    return status;
}

/* What would do is seen by opening it with more than that: a stage takes less than six times its words. */
static void tell_baked_need(const prepared *p, const settings *s, FILE *file, size_t n_words) {
    prepared more;
    settings rich = *s;
    bool told = false;
    memset(&more, 0, sizeof more);
    more.path = p->path;
    rich.memory += (uint64_t)n_words * 24 + (uint64_t)s->threads * ASET_BYTES_SCRATCH(s->depth);
    rewind(file);
    if (take_block(&more, &rich)) {
        aset_status status = fill_baked(&more, &rich, file, n_words, &told);
        if (status == ASET_OK) {
            tool_error(p->path, 0, "the draft needs %zu bytes, has %" PRIu64, more.arena.peak, s->memory);
        } else if (!told) {
            tool_error(p->path, 0, "%s", aset_status_text(status));
        }
    }
    prepare_free(&more);
}

static bool open_baked(prepared *p, const settings *s, FILE *file) {
    uint64_t size = file_bytes(p->path, file);
    bool told = false;
    if (size == 0 || !take_block(p, s)) {
        return false;
    }
    if (size > SIZE_MAX / 32) {
        tool_error(p->path, 0, "%" PRIu64 " bytes are too many for this machine", size);
        return false;
    }
    aset_status status = fill_baked(p, s, file, (size_t)size / 4, &told);
    if (status == ASET_ERR_NOMEM) {
        tell_baked_need(p, s, file, (size_t)size / 4);
    } else if (status != ASET_OK && !told) {
        tool_error(p->path, 0, "%s", aset_status_text(status));
    }
    p->is_drafted = p->is_streamed = true;
    p->counts = p->draft.stage.counts;
    return status == ASET_OK && choose_view(p, s);
}

static bool prepare_baked(prepared *p, const settings *s) {
    FILE *file = tool_input_open(p->path);
    double start = tool_seconds();
    bool done = file != NULL && open_baked(p, s, file);
    tool_input_close(file);
    p->load_s = tool_seconds() - start;
    return done;
}

static bool prepare_source(prepared *p, const settings *s) {
    tool_source source;
    if (!tool_source_open(&source, p->path)) {
        return false;
    }
    tool_source_set(&source, s);
    bool done = prepare_from(p, s, &source);
    tool_source_close(&source);
    return done;
}

/* What comes behind all else. */
static void make_ready(prepared *p, const settings *s) {
    choose_tracer(p, s);
    double start = tool_seconds();
    take_aids(p, s);
    p->build_s += tool_seconds() - start;
}

bool prepare(prepared *p, const settings *s, const char *path) {
    memset(p, 0, sizeof *p);
    p->path = path;
    if (!(tool_is_draft(path) ? prepare_baked(p, s) : prepare_source(p, s))) {
        prepare_free(p);
        return false;
    }
    make_ready(p, s);
    return true;
}

aset_status prepare_again(prepared *p, const settings *s, tool_source *source, const aset_counter *counter, bool *told) {
    memset(p, 0, sizeof *p);
    p->path = source->path;
    *told = !take_block(p, s);
    aset_status status = *told ? ASET_ERR_NOMEM : fill(p, s, source, counter, told);
    if (status == ASET_OK) {
        *told = !choose_view(p, s);
        status = *told ? ASET_ERR_GEOMETRY : ASET_OK;
    }
    if (status == ASET_OK) {
        make_ready(p, s);
    }
    return status;
}

void prepare_free(prepared *p) {
    free(p->block);
    free(p->scratches);
    free(p->beams);
    p->block = NULL;
    p->scratches = NULL;
    p->beams = NULL;
}
