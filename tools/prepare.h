/*
 * prepare.h - from the words of a command line to a scene, a space and a summary in one arena of the size asked for: what
 * render and info share.
 */
#ifndef ASET_TOOLS_PREPARE_H
#define ASET_TOOLS_PREPARE_H

#include "aset/aset.h"
#include "aset/stage.h"

#include "tool.h"

/* What an approximate cell remembers. */
typedef enum settings_cells { CELLS_FLAT, CELLS_NORMAL, CELLS_PLANE } settings_cells;
enum { SETTINGS_CELLS = 3 };
extern const char *const settings_cells_names[SETTINGS_CELLS];

/* The options of `aset render`; settings_default gives the defaults. */
typedef struct settings {
    const aset_method *method;
    bool has_approx, has_approx_depth, has_curtail; /* said, not by default */
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
    /* of models */
    bool has_up_axis, has_ground, ground, smooth;
    aset_up up_axis;
    bool transparent; /* pixels that show nothing stay so; no ground unless has_ground */
} settings;

/* Halvings in octree, arts and excell unless said otherwise: fewer are never taken in silence. */
#define SETTINGS_TREE_DEPTH 6u

/* --- settings.c --- */

settings settings_default(void);

/* Options that several commands have, for their tables of long ones: of how it is drawn, of models, of a scene's camera. */
enum {
    SETTINGS_FROM = 1024, SETTINGS_AT, SETTINGS_UP, SETTINGS_ANGLE, SETTINGS_UP_AXIS, SETTINGS_GROUND, SETTINGS_SMOOTH,
    SETTINGS_APPROX, SETTINGS_APPROX_DEPTH, SETTINGS_LEAF, SETTINGS_CURTAIL, SETTINGS_CURTAIL_WHEN, SETTINGS_SAMPLES, SETTINGS_DEPTH,
    SETTINGS_RULES
};
#define SETTINGS_DRAWING_OPTIONS                                                                                       \
    {"approx", required_argument, NULL, SETTINGS_APPROX}, {"approx-depth", required_argument, NULL, SETTINGS_APPROX_DEPTH}, \
        {"leaf", required_argument, NULL, SETTINGS_LEAF}, {"curtail", required_argument, NULL, SETTINGS_CURTAIL},      \
        {"curtail-when", required_argument, NULL, SETTINGS_CURTAIL_WHEN},                                              \
        {"samples", required_argument, NULL, SETTINGS_SAMPLES}, {"depth", required_argument, NULL, SETTINGS_DEPTH},       \
        {"rules", required_argument, NULL, SETTINGS_RULES}
#define SETTINGS_MODEL_OPTIONS                                                                                         \
    {"up-axis", required_argument, NULL, SETTINGS_UP_AXIS}, {"ground", required_argument, NULL, SETTINGS_GROUND}
#define SETTINGS_SMOOTH_OPTION {"smooth", no_argument, NULL, SETTINGS_SMOOTH}
#define SETTINGS_CAMERA_OPTIONS                                                                                        \
    {"from", required_argument, NULL, SETTINGS_FROM}, {"at", required_argument, NULL, SETTINGS_AT},                    \
        {"up", required_argument, NULL, SETTINGS_UP}, {"angle", required_argument, NULL, SETTINGS_ANGLE}
/* Takes one of them, its value being in optarg. False: after an error line, or it is none of them. */
bool settings_option(settings *s, int option);
/* The words flat, normal and plane. False after an error line. */
bool settings_parse_cells(settings *s, const char *text);
/* Do they go together? False after an error line. */
bool settings_check(const settings *s);

/* Kinds of rays as --approx takes them. */
#define SETTINGS_KINDS_BYTES 48u
void settings_kinds(char text[SETTINGS_KINDS_BYTES], uint32_t kinds);

/* A scene's view with the camera's words laid over it. False after an error line. */
bool settings_view(aset_view *view, const settings *s, const char *path);

/* Everything that a picture is drawn from. */
typedef struct prepared {
    const char *path;
    void *block; /* the arena's, malloc'ed */
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_draft draft;
    uint32_t n_threads; /* that draw: those asked for, or of these as many as the room is for */
    bool is_drafted, is_streamed; /* there is a draft; no object is held but those that a draft keeps */
    aset_counts counts;           /* of the source */
    aset_scratch *scratches; /* one for each thread, */
    aset_beams *beams;       /* and these, if there is room for them */
    aset_reach reach;
    aset_mark mark; /* before beams and reach, which are needed while drawing only */
    aset_tracer tracer;
    aset_view view;
    double load_s, build_s;
} prepared;

/* In the order of tool_kind. */
typedef enum tool_format { TOOL_NFF, TOOL_OBJ, TOOL_STL, TOOL_PLY } tool_format;

/*
 * A source of entities that can be read again: a file, or standard input, which is kept in a temporary file. A model gets
 * its stage behind its own entities (then even the very first reading, which finds the box, can give it). All zero but path
 * and stream is an NFF scene.
 */
typedef struct tool_source {
    const char *path;
    FILE *stream;
    tool_format format;
    uint64_t size;         /* bytes, 0: not known */
    bool one_sided_opaque; /* NFF */
    /* models; to be changed before the first reading */
    bool smooth;
    aset_stage_options stage;
    /* known after the first reading of a model: of its own, without the stage */
    bool is_measured;
    aset_vec3 low, high;
    uint64_t n_vertices, n_skipped;
} tool_source;

/* By the name's ending or the first bytes. False after an error line. */
bool tool_source_open(tool_source *source, const char *path);
/* What the settings say of models. */
void tool_source_set(tool_source *source, const settings *s);
/* What they say of sides, which depends on what was counted at the first reading. */
void tool_source_rules(tool_source *source, const settings *s, const aset_counts *counts);
/*
 * Reads it from the start into the sink. False after an error line that names the place. What is left out of a model is told
 * on standard error at the first reading.
 */
bool tool_source_read(tool_source *source, const aset_sink *sink);
void tool_source_close(tool_source *source);

/* --- batch.c --- */

#define TOOL_BATCH_BYTES 65536u

/*
 * A sink that collects entities and hands them to another one when it is full, so that reading and what the other does can
 * be timed apart. Triangles of one material go to a baker, if that is the other one, as an array.
 */
typedef struct tool_batch {
    aset_sink target;
    aset_baker *baker;  /* NULL: the target is none */
    double seconds;     /* that the target took */
    aset_status status; /* the first error of the target, which gets nothing more then */
    size_t used, run;   /* bytes; where the record of the last entity begins, if that is triangles, else SIZE_MAX */
    unsigned n_points;  /* of the triangle in hand; 3 or more: of another polygon */
    bool is_triangle;
    aset_real triangle[9];
    union {
        unsigned char bytes[TOOL_BATCH_BYTES];
        double alignment;
    } records;
} tool_batch;

/* Of the two one is NULL. Its functions do not fail: see tool_batch_end. */
aset_sink tool_batch_sink(tool_batch *batch, const aset_sink *target, aset_baker *baker);
/* Hands over the rest. The target's first error, or ASET_OK. */
aset_status tool_batch_end(tool_batch *batch);

/* Why a bake was refused with this status, if a reading more tells which object it was: true after an error line. */
bool tool_bake_tell(tool_source *source, aset_status status);

/* What a bake made and took. */
typedef struct tool_baking {
    aset_draft draft;
    aset_bake_report report;
    double load_s, build_s; /* reading and parsing; baking */
    bool told;              /* the source has failed and said so */
} tool_baking;

/* Bakes what the source holds, in the arena's free bytes, with as many readings as that takes. */
aset_status tool_bake(tool_baking *baking, tool_source *source, const aset_bake_options *options, aset_arena *arena);

/* A flat picture's stage, space and summary, made without holding an object. */
typedef struct tool_flat {
    aset_scene *stage;
    aset_space *space;
    aset_summary *summary;
    double load_s, build_s;
    size_t least; /* bytes of the arena that would have been enough */
    bool told;    /* the source has failed and said so */
} tool_flat;

/* Makes them of what the source holds and counter has counted, with as many readings as that takes. */
aset_status tool_flatten(tool_flat *flat, tool_source *source, const aset_counter *counter, const aset_method *method,
                         const aset_space_options *options, aset_arena *arena);

/* Every method the tool knows; ends with NULL. */
extern const aset_method *const tool_methods[];
/* The method of that name, NULL if there is none. is_aset: it was "aset", which is MSET with all rays from depth 1 on approximate. */
const aset_method *tool_method_find(const char *name, bool *is_aset);

/*
 * What a method takes, measured outside any budget: the scene is loaded into an arena of its own. block is to be freed.
 * False after an error line.
 */
typedef struct measured {
    void *block;
    aset_arena arena;
    aset_scene scene;
    aset_counter counter; /* of what is in it */
    size_t scene_bytes;
} measured;

bool measured_open(measured *m, tool_source *source, const aset_counts *counts);
/* The space's size and, unless summary_bytes is NULL, the summary's; false after an error line. */
bool measured_space(measured *m, const char *path, const aset_method *method, const aset_space_options *options,
                    aset_space_size *size, size_t *summary_bytes);

/* Can a flat picture of these settings be made without holding an object? */
bool tool_streams(const aset_method *method, uint32_t approx_kinds, uint32_t approx_depth);
/*
 * The least bytes that stage, space and summary then take, found by making them, in *bytes if that is not 0; false after an
 * error line.
 */
bool measured_flat(const measured *m, const char *path, const aset_method *method, const aset_space_options *options,
                   size_t *bytes);

/* Loads, builds and sets up everything within settings->memory bytes. False after an error line; then nothing is held. */
bool prepare(prepared *p, const settings *s, const char *path);
/*
 * The same of a source that was read before and counted. Not without words, told, but where memory is too little: ASET_ERR_NOMEM, or
 * another status that was not told. p is to be freed whatever comes.
 */
aset_status prepare_again(prepared *p, const settings *s, tool_source *source, const aset_counter *counter, bool *told);
/* Memory that is enough for a draft for which s->memory is, the least to an eighth. */
uint64_t prepare_draft_need(const settings *s, tool_source *source, const aset_counter *counter);
void prepare_free(prepared *p);

#endif
