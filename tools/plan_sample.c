/*
 * plan_sample.c - some pixels of a picture, drawn to see what the whole takes and how far off it is.
 *
 * A sample is a set of runs of neighbouring pixels, one at a pseudo-random place in each tile of the picture: neighbours, for
 * what the caches hold is part of the time.
 */
#include "plan_sample.h"

#include "metrics.h"

#include <math.h>
#include <string.h>
#include <time.h>

#define THIN 8u

/* A busy machine makes everything wait, but computes no more. */
double plan_cpu_seconds(void) {
    struct timespec t;
    return clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t) == 0 ? (double)t.tv_sec + 1e-9 * (double)t.tv_nsec : 0;
}

static aset_vec3 combine(aset_vec3 a, double s, aset_vec3 b, double t) {
    aset_vec3 c = {(aset_real)(s * a.x + t * b.x), (aset_real)(s * a.y + t * b.y), (aset_real)(s * a.z + t * b.z)};
    return c;
}

static aset_vec3 unit(aset_vec3 a) {
    double length = sqrt((double)a.x * a.x + (double)a.y * a.y + (double)a.z * a.z);
    return combine(a, 1 / length, a, 0);
}

static aset_vec3 cross(aset_vec3 a, aset_vec3 b) {
    aset_vec3 c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}

void plan_sample_aim(plan_sample *s, const aset_view *v, uint32_t width, uint32_t height) {
    s->view = v;
    s->width = width;
    s->height = height;
    double half = v->height > 0 ? 0.5 * v->height : tan(v->angle_deg * (3.14159265358979323846 / 360));
    double wide = half * s->width / s->height;
    s->forward = unit(combine(v->at, 1, v->from, -1));
    aset_vec3 right = unit(cross(s->forward, unit(v->up))), down = cross(s->forward, right);
    s->right = combine(right, wide, right, 0);
    s->down = combine(down, half, down, 0);
}

/* The ray through a pixel's centre. */
static aset_ray ray_of(const plan_sample *s, uint32_t x, uint32_t y) {
    const aset_view *v = s->view;
    aset_vec3 across = combine(s->right, (2 * x + 1.0) / s->width - 1, s->down, (2 * y + 1.0) / s->height - 1);
    aset_ray ray;
    ray.origin = v->height > 0 ? combine(v->from, 1, across, 1) : v->from;
    ray.direction = v->height > 0 ? s->forward : unit(combine(s->forward, 1, across, 1));
    ray.t_max = INFINITY;
    return ray;
}

/* A pseudo-random number below n: Lehmer's generator with Park and Miller's multiplier (1988), its upper bits. */
static uint32_t draw_number(uint32_t *state, uint32_t n) {
    *state = (uint32_t)((uint64_t)*state * 16807u % 2147483647u);
    return (uint32_t)((uint64_t)*state * n / 2147483647u);
}

void plan_sample_make(plan_sample *s, uint32_t n, uint32_t seed) {
    double width = s->width, height = s->height;
    s->run = s->width < PLAN_RUN ? s->width : PLAN_RUN;
    n = n < 1 ? 1 : n > PLAN_RUNS_MAX ? PLAN_RUNS_MAX : n;
    double side = sqrt(width * height / n); /* of a tile, as square as may be, and at least one run of pixels */
    uint32_t columns = (uint32_t)fmax(1, fmin(fmin(n, floor(width / s->run)), floor(width / side)));
    uint32_t rows = (uint32_t)fmax(1, fmin(height, n / columns));
    uint32_t state = 1 + seed * 7919u;
    s->n_runs = 0;
    for (uint32_t j = 0; j < rows; j++) {
        for (uint32_t i = 0; i < columns && s->n_runs < PLAN_RUNS_MAX; i++) {
            uint32_t x = (uint32_t)((uint64_t)i * s->width / columns);
            uint32_t y = (uint32_t)((uint64_t)j * s->height / rows);
            uint32_t x_end = (uint32_t)((uint64_t)(i + 1) * s->width / columns);
            uint32_t y_end = (uint32_t)((uint64_t)(j + 1) * s->height / rows);
            s->x[s->n_runs] = (uint16_t)(x + draw_number(&state, x_end - x - s->run + 1));
            s->y[s->n_runs++] = (uint16_t)(y + draw_number(&state, y_end - y));
        }
    }
}

static uint8_t to_byte(aset_real x) {
    return (uint8_t)((x > 0 ? (x < 1 ? x : 1) : 0) * 255 + (aset_real)0.5);
}

static void draw_run(const plan_sample *s, const aset_tracer *tracer, uint32_t i, uint8_t *rgb) {
    aset_statistics ignored;
    memset(&ignored, 0, sizeof ignored);
    rgb += (size_t)i * s->run * 3;
    for (uint32_t k = 0; k < s->run; k++, rgb += 3) {
        aset_colour c = {0, 0, 0};
        aset_scratch scratch = s->scratch;
        aset_ray ray = ray_of(s, s->x[i] + k, s->y[i]);
        (void)aset_ray_colour(&c, tracer, &ray, &scratch, &ignored); /* what it takes was checked by the loader */
        rgb[0] = to_byte(c.r);
        rgb[1] = to_byte(c.g);
        rgb[2] = to_byte(c.b);
    }
}

double plan_sample_draw(const plan_sample *s, const aset_tracer *tracer, double limit, uint8_t *rgb) {
    uint32_t n = s->n_runs;
    double start = plan_cpu_seconds();
    for (uint32_t i = 0; limit < INFINITY && i < n; i += THIN) {
        draw_run(s, tracer, i, rgb);
    }
    double all = (plan_cpu_seconds() - start) * n / ((n + THIN - 1) / THIN);
    if (limit < INFINITY && all > limit) {
        return all;
    }
    for (uint32_t i = 0; i < n; i++) {
        if (limit >= INFINITY || i % THIN != 0) {
            draw_run(s, tracer, i, rgb);
        }
    }
    return plan_cpu_seconds() - start;
}

void plan_errors_add(plan_errors *e, const plan_sample *s, const uint8_t *exact, const uint8_t *drawn) {
    uint32_t n = s->run * 3;
    for (uint32_t i = 0; i < s->n_runs; i++) {
        double run = 0;
        for (uint32_t k = i * n; k < (i + 1) * n; k++) {
            double d = (double)exact[k] - drawn[k];
            run += d * d;
        }
        e->squares += run;
        e->squares_of_runs += run * run;
        e->values += n;
    }
}

double plan_errors_psnr(const plan_errors *e) {
    double psnr = e->squares > 0 ? 10 * log10(255.0 * 255.0 * (double)e->values / e->squares) : METRICS_PSNR_MAX;
    return psnr < METRICS_PSNR_MAX ? psnr : METRICS_PSNR_MAX;
}

double plan_errors_doubt(const plan_errors *e) {
    return e->squares > 0 ? sqrt(e->squares_of_runs) / e->squares : INFINITY;
}

double plan_sample_pixels(const plan_sample *s) {
    return (double)s->n_runs * s->run;
}

uint32_t plan_sample_runs(double seconds, double rate, uint32_t fewest) {
    double n = seconds / (rate * PLAN_RUN + 1e-12);
    return n < fewest ? fewest : n > PLAN_RUNS_MAX ? PLAN_RUNS_MAX : (uint32_t)n;
}
