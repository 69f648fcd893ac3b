/*
 * prepare.h - from the words of a command line to a scene, a space and a summary in one arena of the size asked for: what
 * render and info share.
 */
#ifndef ASET_TOOLS_PREPARE_H
#define ASET_TOOLS_PREPARE_H

#include "aset/aset.h"

#include "tool.h"

/* What an approximate cell remembers. */
typedef enum settings_cells { CELLS_FLAT, CELLS_NORMAL, CELLS_PLANE } settings_cells;

/* The options of `aset render`; settings_default gives the defaults. */
typedef struct settings {
    const aset_method *method;
    uint32_t approx_kinds, approx_depth;
    settings_cells cells;
    uint32_t grid[3], tree_depth, leaf; /* 0: automatic */
    double curtail;
    bool curtail_more;
    uint64_t memory;
    uint32_t width, height; /* 0: the scene's */
    uint32_t samples;       /* along one side of a pixel */
    uint32_t depth;
    bool spd_rules;
    uint32_t threads;
    bool has_from, has_at, has_up, has_angle;
    aset_vec3 from, at, up;
    double angle_deg;
} settings;

settings settings_default(void);

/* Everything that a picture is drawn from. */
typedef struct prepared {
    const char *path;
    void *block; /* the arena's, malloc'ed */
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_draft draft;
    bool is_drafted, is_streamed; /* there is a draft; and there is nothing else */
    aset_counts counts;           /* of the source */
    aset_scratch *scratches; /* one for each thread */
    aset_tracer tracer;
    aset_view view;
    double load_s, build_s;
} prepared;

/*
 * A source of entities that can be read again: a file, or standard input, which is kept in a temporary file. False after an
 * error line.
 */
typedef struct tool_source {
    const char *path;
    FILE *stream;
    bool one_sided_opaque;
} tool_source;

bool tool_source_open(tool_source *source, const char *path);
/* Reads it from the start into the sink. False after an error line that names the place. */
bool tool_source_read(tool_source *source, const aset_sink *sink);
void tool_source_close(tool_source *source);

/* Every method the tool knows; ends with NULL. */
extern const aset_method *const tool_methods[];
const aset_method *tool_method_find(const char *name);

/*
 * What a method takes, measured outside any budget: the scene is loaded into an arena of its own. block is to be freed.
 * False after an error line.
 */
typedef struct measured {
    void *block;
    aset_arena arena;
    aset_scene scene;
    size_t scene_bytes;
} measured;

bool measured_open(measured *m, tool_source *source, const aset_counts *counts);
/* The space's size and, unless summary_bytes is NULL, the summary's; false after an error line. */
bool measured_space(measured *m, const char *path, const aset_method *method, const aset_space_options *options,
                    aset_space_size *size, size_t *summary_bytes);

/* Loads, builds and sets up everything within settings->memory bytes. False after an error line; then nothing is held. */
bool prepare(prepared *p, const settings *s, const char *path);
void prepare_free(prepared *p);

#endif
