/* plan_sample.h - some pixels of a picture, drawn to see what the whole takes and how far off it is. */
#ifndef ASET_TOOLS_PLAN_SAMPLE_H
#define ASET_TOOLS_PLAN_SAMPLE_H

#include "aset/aset.h"

#define PLAN_RUN 4u         /* neighbouring pixels */
#define PLAN_RUNS_MAX 2048u /* in a sample */
#define PLAN_SAMPLE_BYTES (PLAN_RUNS_MAX * PLAN_RUN * 3)

typedef struct plan_sample {
    const aset_view *view;
    uint32_t width, height; /* of the whole picture */
    aset_scratch scratch;
    aset_vec3 forward, right, down; /* of the camera */
    uint32_t n_runs, run;           /* runs, and pixels in each */
    uint16_t x[PLAN_RUNS_MAX], y[PLAN_RUNS_MAX]; /* of each run's first pixel */
} plan_sample;

/* Sums over the runs of one or more samples: what the mean squared error is, and how sure. */
typedef struct plan_errors {
    double squares, squares_of_runs;
    uint64_t values;
} plan_errors;

/* The processor's time. */
double plan_cpu_seconds(void);

/* For pictures of a view, which is kept; the scratch is the caller's affair. */
void plan_sample_aim(plan_sample *s, const aset_view *view, uint32_t width, uint32_t height);
/* About n runs (one at least), one in each tile. */
void plan_sample_make(plan_sample *s, uint32_t n, uint32_t seed);
double plan_sample_pixels(const plan_sample *s);
/* Runs that take about so long at so many seconds a pixel; a few at least. */
uint32_t plan_sample_runs(double seconds, double rate, uint32_t fewest);
/* Draws the sample into PLAN_SAMPLE_BYTES. Seconds; if one run of eight says that it would take longer than limit, what all would take. */
double plan_sample_draw(const plan_sample *s, const aset_tracer *tracer, double limit, uint8_t *rgb);

void plan_errors_add(plan_errors *e, const plan_sample *s, const uint8_t *exact, const uint8_t *drawn);
/* METRICS_PSNR_MAX at the most, as where nothing differs. */
double plan_errors_psnr(const plan_errors *e);
/* Relative standard error of the mean square; no bound where nothing differs. */
double plan_errors_doubt(const plan_errors *e);

#endif
