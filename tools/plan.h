/* plan.h - settings for a scene within a budget, and what is expected of them. */
#ifndef ASET_TOOLS_PLAN_H
#define ASET_TOOLS_PLAN_H

#include "prepare.h"

/* One way of drawing that was probed. */
typedef struct plan_setting {
    const aset_method *method; /* MSET, grid, SET or brute force */
    uint32_t grid[3];          /* divisions; SET: at the most */
    uint32_t approx_kinds, approx_depth;
    settings_cells cells; /* other than flat: a draft */
    uint32_t textures; /* in the summary's list; 0: exact */
    aset_space_size size;
    size_t bytes;      /* of the arena, all told; with everything approximate of what `aset render` streams; for a draft that
                          is not chosen the plan's memory */
    double seconds;    /* expected for the whole picture, build included */
    double psnr;       /* expected, dB; METRICS_PSNR_MAX for exact */
    bool fits;
} plan_setting;

/* What is asked for; error_db and time_ms 0: not asked. What is given of a setting is not chosen. */
typedef struct plan_wish {
    uint64_t memory;
    double error_db, time_ms;
    uint32_t width, height, depth, samples; /* samples: along one side of a pixel */
    double curtail;
    bool curtail_more, spd_rules;
    const aset_method *method;           /* NULL: any */
    uint32_t grid[3];                    /* 0: any */
    bool has_approx;                     /* these rays are approximate, and no others */
    uint32_t approx_kinds, approx_depth;
    settings_cells cells; /* of what is approximate; other than flat: drafts */
    const settings *given; /* of drafts: the rest that was said, */
    tool_source *source;   /* and what they are made from */
    bool holds_scene; /* the bytes are those of a program that holds the scene, whatever is approximate */
} plan_wish;

enum { PLAN_SETTINGS_MAX = 256 }; /* three methods, four levels, a dozen steps, and brute force */

typedef struct plan {
    plan_setting settings[PLAN_SETTINGS_MAX];
    int n, chosen;        /* chosen: -1 if nothing fits */
    double exact_seconds; /* the exact picture's at automatic divisions, the unit of relative times */
    size_t exact_bytes;   /* the smallest need of an exact picture */
    size_t least_bytes;   /* and of any that was measured */
} plan;

/* Probes the loaded scene and chooses. False after an error line. */
bool plan_make(plan *p, measured *m, const char *path, const plan_wish *wish);

/* Writes the header for the setting. False after an error line. */
bool plan_write_header(const char *path, const measured *m, const char *scene_path, const plan_setting *s,
                       const plan_wish *wish);

#endif
