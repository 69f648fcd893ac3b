/*
 * trade_plan.c - which settings a sweep measures: scenes loaded, spaces measured, the arenas' exact needs.
 *
 * Invariant: no two settings have the same key, and every group has an exact setting.
 */
#include "aset/procedural.h"

#include "trade.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const trade_approx approxes[TRADE_GIVEN] = {
    {"none", "exact", 0, 0},
    {"all", "all rays from depth 1", ASET_ALL_KINDS, 1},
    {"all", "all rays", ASET_ALL_KINDS, 0},
    {"shadow", "shadow rays", ASET_SHADOW, 0},
    {"primary", "eye rays", ASET_PRIMARY, 0},
};
/* Of these, those that a draft is tried with: everything, and shadows beside exact eye rays. */
#define DRAFT_APPROXES (1u << 2 | 1u << 3)

/* Of one space: the exact setting, flat ones with and without curtailment, drafts. */
#define SETTINGS_OF_SPACE (2u * TRADE_APPROXES + (SETTINGS_CELLS - 1u) * 2u)

/* --- scenes --- */

/* NAME or NAME:SIZE as NFF in a temporary file: the very text that `aset scene` writes. False after an error line. */
static bool open_procedural(tool_source *source, const char *name) {
    char word[32];
    size_t length = strcspn(name, ":");
    (void)snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : 0), name);
    const aset_procedural *scene = aset_procedural_find(word);
    uint32_t size = 0;
    if (scene == NULL) {
        tool_error(name, 0,
                   "neither an .nff, .obj, .stl or .ply file nor a procedural scene; aset scene --help lists those");
        return false;
    }
    if (name[length] == ':' && !tool_parse_count(name, name + length + 1, 1, scene->largest_size, &size)) {
        return false;
    }
    tool_nff nff;
    source->path = name;
    source->one_sided_opaque = false;
    source->stream = tmpfile();
    aset_sink sink = tool_nff_sink(&nff, source->stream, 0.01);
    if (source->stream == NULL || scene->emit(&sink, size) != ASET_OK || tool_nff_end(&nff) != ASET_OK ||
        fflush(source->stream) != 0) {
        tool_error(name, 0, "cannot be written to a temporary file: %s", strerror(errno));
        tool_source_close(source);
        return false;
    }
    return true;
}

/* FNV-1a (Fowler, Noll and Vo). */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *c = bytes;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ c[i]) * UINT64_C(1099511628211);
    }
    return hash;
}

/* Of what materials are drawn by: those of a model may come from other files. */
static uint64_t hash_materials(uint64_t hash, const aset_scene *scene) {
    for (uint32_t i = 0; i < scene->counts.materials; i++) {
        const aset_material *m = &scene->materials[i];
        hash = hash_bytes(hash, &m->fill, sizeof m->fill);
        hash = hash_bytes(hash, &m->diffuse, sizeof m->diffuse);
        hash = hash_bytes(hash, &m->specular, sizeof m->specular);
        hash = hash_bytes(hash, &m->shine, sizeof m->shine);
#if ASET_WITH_REFRACTION
        hash = hash_bytes(hash, &m->transmittance, sizeof m->transmittance);
        hash = hash_bytes(hash, &m->refraction_index, sizeof m->refraction_index);
#endif
    }
    return hash;
}

/* Of the scene's text and the program's version. */
static uint64_t hash_source(const tool_source *source) {
    uint64_t hash = hash_bytes(UINT64_C(14695981039346656037), ASET_VERSION, sizeof ASET_VERSION - 1);
    hash = (hash ^ ASET_REAL_BITS) * UINT64_C(1099511628211);
    rewind(source->stream);
    for (int c; (c = getc(source->stream)) != EOF;) {
        hash = (hash ^ (unsigned char)c) * UINT64_C(1099511628211);
    }
    return hash;
}

/* Whether it is a file's name rather than that of a procedural scene. */
static bool is_file(const char *name) {
    return tool_has_extension(name, ".nff") || tool_has_extension(name, ".obj") || tool_has_extension(name, ".stl") ||
           tool_has_extension(name, ".ply");
}

/* The last part of the name, without .nff or the like, in letters that every file system and page takes. */
static char *make_label(const char *name) {
    const char *slash = strrchr(name, '/');
    name = slash != NULL ? slash + 1 : name;
    size_t length = strlen(name) - (is_file(name) ? 4 : 0);
    char *label = calloc(length + 1, 1);
    for (size_t i = 0; label != NULL && i < length; i++) {
        static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
        label[i] = strchr(allowed, name[i]) != NULL ? name[i] : '-';
    }
    return label;
}

/* Of what the words say of the camera, of models and of rays, but for what a setting's key says; nothing if they say nothing. */
static uint64_t hash_look(uint64_t hash, const settings *s) {
    const settings usual = settings_default();
    const struct {
        bool is_given;
        const void *value;
        size_t size;
    } parts[] = {{s->has_from, &s->from, sizeof s->from},       {s->has_at, &s->at, sizeof s->at},
                 {s->has_up, &s->up, sizeof s->up},             {s->has_angle, &s->angle_deg, sizeof s->angle_deg},
                 {s->has_up_axis, &s->up_axis, sizeof s->up_axis}, {s->has_ground, &s->ground, sizeof s->ground},
                 {s->smooth, &s->smooth, sizeof s->smooth},     {s->depth != usual.depth, &s->depth, sizeof s->depth},
                 {s->samples != usual.samples, &s->samples, sizeof s->samples},
                 {s->leaf != usual.leaf, &s->leaf, sizeof s->leaf},
                 {s->curtail_more, &s->curtail_more, sizeof s->curtail_more},
                 {s->spd_rules, &s->spd_rules, sizeof s->spd_rules}};
    for (uint32_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (parts[i].is_given) {
            hash = hash_bytes(hash_bytes(hash, &i, sizeof i), parts[i].value, parts[i].size);
        }
    }
    return hash;
}

static bool open_scene(trade_scene *scene, const char *name, const settings *s) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    scene->name = name;
    scene->label = make_label(name);
    if (scene->label == NULL) {
        tool_error(name, 0, "no memory for its name");
        return false;
    }
    if (!(is_file(name) ? tool_source_open(&scene->source, name) : open_procedural(&scene->source, name))) {
        return false;
    }
    tool_source_set(&scene->source, s);
    scene->hash = hash_look(hash_source(&scene->source), s);
    if (!tool_source_read(&scene->source, &sink)) {
        return false;
    }
    if (counter.counts.objects == 0) {
        tool_error(name, 0, "there is no object in it, expected one at least");
        return false;
    }
    tool_source_rules(&scene->source, s, &counter.counts);
    if (!measured_open(&scene->loaded, &scene->source, &counter.counts)) {
        scene->loaded.block = NULL; /* given back already */
        return false;
    }
    scene->hash = hash_materials(scene->hash, &scene->loaded.scene);
    return true;
}

/* --- views --- */

static aset_status keep_view(void *context, const aset_view *view) {
    *(aset_view *)context = *view;
    return ASET_OK;
}

static aset_status pass_background(void *context, const aset_colour *colour) {
    (void)context;
    (void)colour;
    return ASET_OK;
}

static aset_status pass_light(void *context, const aset_light *light) {
    (void)context;
    (void)light;
    return ASET_OK;
}

/* A scene file says where it is seen from; a model is seen from so far that it fits into a picture of this shape. */
static bool find_view(trade_group *group, const settings *s) {
    const tool_source *source = &group->scene->source;
    aset_stage_options options = source->stage;
    aset_sink sink;
    group->view = group->scene->loaded.scene.view;
    if (source->format == TOOL_NFF) {
        return settings_view(&group->view, s, source->path);
    }
    memset(&sink, 0, sizeof sink);
    sink.context = &group->view;
    sink.view = keep_view;
    sink.background = pass_background;
    sink.light = pass_light;
    options.no_ground = true; /* the sink takes none */
    options.aspect = (aset_real)group->width / (aset_real)group->height;
    aset_status status = aset_stage_emit(&sink, &source->low, &source->high, &options);
    if (status != ASET_OK) {
        tool_error(source->path, 0, "its view: %s", aset_status_text(status));
    }
    return status == ASET_OK && settings_view(&group->view, s, source->path);
}

/* --- the plan --- */

/* Whether this space is planned already: "auto" may be what another word says. */
static bool is_planned(const trade *t, const trade_group *group, const aset_method *method, const uint32_t grid[3],
                       uint32_t depth) {
    for (uint32_t i = 0; i < t->n_settings; i++) {
        const trade_setting *s = &t->settings[i];
        if (s->group == group && s->method == method && s->tree_depth == depth &&
            memcmp(s->grid, grid, sizeof s->grid) == 0) {
            return true;
        }
    }
    return false;
}

static trade_setting *add_setting(trade *t, trade_group *group, const aset_method *method, const aset_space_options *options,
                                  unsigned approx) {
    trade_setting *s = &t->settings[t->n_settings++];
    s->group = group;
    s->method = method;
    memcpy(s->grid, options->divisions, sizeof s->grid);
    s->tree_depth = options->depth;
    s->approx = approx;
    s->rays = &t->approxes[approx];
    return s;
}

/* Takes the last one away again. */
static void remove_setting(trade *t) {
    memset(&t->settings[--t->n_settings], 0, sizeof *t->settings);
}

/* Leaves the last one out if it needs more than the memory. Exact ones stay: all is measured by them. */
static void leave_out(trade *t) {
    const trade_setting *s = &t->settings[t->n_settings - 1];
    if (s->approx != TRADE_EXACT && trade_peak(s) > t->memory) {
        remove_setting(t);
        t->n_left_out++;
    }
}

/* Another picture of the same draft: of another size, or with the cells' sides for their planes. */
static const trade_setting *find_same_draft(const trade *t, const trade_setting *s) {
    for (const trade_setting *other = t->settings; other != s; other++) {
        if (other->group->scene == s->group->scene && other->method == s->method && other->approx == s->approx &&
            other->cells != CELLS_FLAT && memcmp(other->grid, s->grid, sizeof s->grid) == 0) {
            return other;
        }
    }
    return NULL;
}

/* With everything approximate, drafts of mset and of grid are the same: one of them is enough. */
static bool plan_drafts(trade *t, const trade_words *w, trade_group *group, const aset_method *method,
                        const aset_space_options *options, const aset_space_size *size) {
    bool is_second = method == &aset_grid && (w->methods & 1u) != 0; /* tool_methods[0] is mset */
    bool done = true;
    for (unsigned cells = CELLS_NORMAL; cells < SETTINGS_CELLS; cells++) {
        for (unsigned approx = TRADE_EXACT + 1; done && (w->cells >> cells & 1) != 0 && approx < TRADE_APPROXES; approx++) {
            bool is_tried = w->settings.has_approx || w->settings.has_approx_depth || (DRAFT_APPROXES >> approx & 1) != 0;
            if (!is_tried || (t->wanted >> approx & 1) == 0) {
                continue;
            }
            trade_setting *s = add_setting(t, group, method, options, approx);
            s->cells = (settings_cells)cells;
            bool is_streamed = trade_is_streamed(s);
            if (is_streamed && is_second) {
                remove_setting(t);
                continue;
            }
            const trade_setting *same = find_same_draft(t, s);
            s->need = same != NULL ? same->need : ASET_BYTES_SCRATCH(t->drawn.depth) + (is_streamed ? 0 : size->total);
            done = same != NULL || trade_find_need(t, s);
            leave_out(t);
        }
    }
    return done;
}

/* All ways to draw over one space. The need is render's: the scratch, and the space while built or with its summary. */
static bool plan_space(trade *t, const trade_words *w, trade_group *group, const aset_method *method, const uint32_t grid[3],
                       uint32_t depth) {
    trade_scene *scene = group->scene;
    aset_space_size size;
    size_t summary;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, grid, sizeof options.divisions);
    options.depth = depth;
    options.leaf = t->drawn.leaf;
    if (depth == 0 && grid[0] == 0 && method != &aset_brute) {
        aset_auto_divisions(&scene->loaded.scene, 0, options.divisions);
    }
    if (is_planned(t, group, method, options.divisions, depth)) {
        return true;
    }
    if (!measured_space(&scene->loaded, scene->name, method, &options, &size, &summary)) {
        return false;
    }
    size_t flat = 0;
    if (tool_streams(method, ASET_ALL_KINDS, 0) && (w->cells >> CELLS_FLAT & 1) != 0 &&
        !measured_flat(&scene->loaded, scene->name, method, &options, &flat)) {
        return false;
    }
    size_t built = size.cells + size.references + size.voxels + summary, scratch = ASET_BYTES_SCRATCH(t->drawn.depth);
    unsigned n_approxes = (w->cells >> CELLS_FLAT & 1) != 0 ? TRADE_APPROXES : 1;
    for (unsigned approx = 0; approx < n_approxes; approx++) {
        for (uint32_t c = 0; (t->wanted >> approx & 1) != 0 && c < (approx == TRADE_EXACT ? 1 : t->n_curtails); c++) {
            trade_setting *s = add_setting(t, group, method, &options, approx);
            s->curtail = t->curtails[c];
            size_t held = approx != TRADE_EXACT && built > size.total ? built : size.total;
            s->need = scratch + (trade_is_streamed(s) ? flat : held);
            leave_out(t);
        }
    }
    return (method != &aset_mset && method != &aset_grid) || plan_drafts(t, w, group, method, &options, &size);
}

static bool plan_group(trade *t, const trade_words *w, trade_group *group) {
    static const uint32_t none[3] = {0, 0, 0};
    bool done = true;
    for (unsigned m = 0; done && tool_methods[m] != NULL; m++) {
        const aset_method *method = tool_methods[m];
        bool slices = method == &aset_mset || method == &aset_set || method == &aset_grid;
        uint32_t n = method == &aset_brute ? 1 : slices ? w->n_grids : w->n_depths;
        for (uint32_t i = 0; done && (w->methods >> m & 1) != 0 && i < n; i++) {
            done = plan_space(t, w, group, method, slices ? w->grids[i] : none,
                              slices || method == &aset_brute ? 0 : w->depths[i]);
        }
    }
    return done;
}

/* Memory for the rounds of all settings, and the block of the greediest. */
static bool plan_memory(trade *t) {
    size_t most = 1;
    for (uint32_t i = 0; i < t->n_settings; i++) {
        trade_setting *s = &t->settings[i];
        s->build = calloc(2 * (size_t)t->rounds, sizeof *s->build);
        if (s->build == NULL) {
            return false;
        }
        s->render = s->build + t->rounds;
        most = s->need > most ? s->need : most;
    }
    t->block = malloc(most);
    if (t->block != NULL) {
        memset(t->block, 0xA5, most);
    }
    return t->block != NULL;
}

/* What is swept of approximations: all that are known, or the one that the words say. */
static void plan_approxes(trade *t, const settings *s) {
    memcpy(t->approxes, approxes, sizeof approxes);
    t->wanted = (1u << TRADE_GIVEN) - 1;
    if (!s->has_approx && !s->has_approx_depth) {
        return;
    }
    uint32_t mask = s->has_approx ? s->approx_kinds : ASET_ALL_KINDS;
    unsigned place = mask == 0 ? TRADE_EXACT : TRADE_GIVEN;
    for (unsigned i = TRADE_EXACT + 1; i < TRADE_GIVEN; i++) {
        place = approxes[i].mask == mask && approxes[i].level == s->approx_depth ? i : place;
    }
    t->wanted = 1u << TRADE_EXACT | 1u << place;
    settings_kinds(t->given_kinds, mask);
    (void)snprintf(t->given_text, sizeof t->given_text, "%s rays from depth %" PRIu32, t->given_kinds, s->approx_depth);
    t->approxes[TRADE_GIVEN] = (trade_approx){t->given_kinds, t->given_text, mask, s->approx_depth};
}

bool trade_plan(trade *t, const trade_words *w, char **names, uint32_t n_names) {
    size_t per_group = (size_t)SETTINGS_OF_SPACE * 8 * TRADE_LIST_MAX; /* 8 methods at the most, each with a full list */
    t->directory = w->directory;
    t->rounds = w->rounds;
    t->quiet = w->quiet;
    t->drawn = w->settings;
    t->memory = w->has_memory ? w->settings.memory : UINT64_MAX;
    t->curtails[0] = w->settings.curtail;
    t->n_curtails = w->settings.has_curtail ? 1 : 2; /* that and none at all */
    plan_approxes(t, &w->settings);
    t->scenes = calloc(n_names, sizeof *t->scenes);
    t->groups = calloc((size_t)n_names * w->n_sizes, sizeof *t->groups);
    t->settings = calloc(n_names * w->n_sizes * per_group, sizeof *t->settings);
    bool memory = t->scenes != NULL && t->groups != NULL && t->settings != NULL;
    for (uint32_t i = 0; memory && i < n_names; i++) {
        trade_scene *scene = &t->scenes[t->n_scenes++];
        if (!open_scene(scene, names[i], &w->settings)) {
            return false;
        }
        for (uint32_t k = 0; k < w->n_sizes; k++) {
            trade_group *group = &t->groups[t->n_groups++];
            group->scene = scene;
            group->width = w->sizes[k][0];
            group->height = w->sizes[k][1];
            group->columns = group->width + w->settings.spd_rules;
            group->rows = group->height + w->settings.spd_rules;
            if (!find_view(group, &w->settings) || !plan_group(t, w, group)) {
                return false;
            }
        }
    }
    if (!memory || !plan_memory(t)) {
        tool_error(NULL, 0, "trade: the machine has no memory for these settings");
        return false;
    }
    return trade_keys(t);
}

void trade_free(trade *t) {
    for (uint32_t i = 0; i < t->n_settings; i++) {
        free(t->settings[i].build);
        free(t->settings[i].key);
    }
    for (uint32_t i = 0; i < t->n_groups; i++) {
        free(t->groups[i].exact);
    }
    for (uint32_t i = 0; i < t->n_scenes; i++) {
        free(t->scenes[i].label);
        free(t->scenes[i].loaded.block);
        tool_source_close(&t->scenes[i].source);
    }
    if (t->partial != NULL) {
        (void)fclose(t->partial);
    }
    free(t->scenes);
    free(t->groups);
    free(t->settings);
    free(t->block);
}
