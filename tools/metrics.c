/*
 * metrics.c - differences of pictures: squared error and structural similarity.
 *
 * The Gaussian window is the product of two rows of weights, so the weighted moments of a window are first summed
 * along each of its rows, then down its rows:
 *
 * rows y-10 .. y of the pictures --weights across--> ring of 11 rows of moments --weights down--> one row of SSIMs
 *
 * Invariant: ring[y % 11] holds the moments of picture row y for the columns of the tile. Tiles of fixed width keep
 * the ring on the stack, whatever the picture's width. Source: Wang, Bovik, Sheikh, Simoncelli, IEEE Trans. Image
 * Processing 13(4), 2004, equations 13 to 17.
 */
#include "metrics.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define CHANNELS 3u
#define WINDOW METRICS_SSIM_WINDOW
#define SIGMA 1.5
#define PEAK 255.0
#define C1 ((0.01 * PEAK) * (0.01 * PEAK))
#define C2 ((0.03 * PEAK) * (0.03 * PEAK))
/* Windows side by side in a tile. */
#define TILE 64u

/* Means of a, b, a^2, b^2 and a b. */
enum { MEAN_A, MEAN_B, MEAN_AA, MEAN_BB, MEAN_AB, N_MOMENTS };

typedef double moments_row[N_MOMENTS][TILE];

metrics_difference metrics_differ(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height) {
    metrics_difference difference = {0, (uint64_t)width * height, 0, 0};
    for (uint64_t i = 0; i < difference.n_pixels; i++) {
        bool differs = false;
        for (unsigned channel = 0; channel < CHANNELS; channel++, a++, b++) {
            unsigned step = *a > *b ? (unsigned)(*a - *b) : (unsigned)(*b - *a);
            /* below 2^46 in all: 255^2 for three channels of 2^28 pixels */
            difference.squares += (uint64_t)step * step;
            difference.max_difference = step > difference.max_difference ? step : difference.max_difference;
            differs = differs || step > 0;
        }
        difference.n_differing += differs ? 1u : 0u;
    }
    return difference;
}

static double mean_square(const metrics_difference *difference) {
    return (double)difference->squares / ((double)difference->n_pixels * CHANNELS);
}

double metrics_rmse(const metrics_difference *difference) {
    return sqrt(mean_square(difference));
}

double metrics_psnr(const metrics_difference *difference) {
    if (difference->squares == 0) {
        return METRICS_PSNR_MAX;
    }
    return fmin(METRICS_PSNR_MAX, 10.0 * log10(PEAK * PEAK / mean_square(difference)));
}

static double luma(const uint8_t *pixel) {
    return 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
}

static void fill_weights(double weights[WINDOW]) {
    double sum = 0.0;
    for (unsigned i = 0; i < WINDOW; i++) {
        double offset = (double)i - (WINDOW - 1u) / 2u;
        weights[i] = exp(-offset * offset / (2.0 * SIGMA * SIGMA));
        sum += weights[i];
    }
    for (unsigned i = 0; i < WINDOW; i++) {
        weights[i] /= sum;
    }
}

/* The similarity of two windows by their moments (the article's equation 13). */
static double similarity(const double mean[N_MOMENTS]) {
    double product = mean[MEAN_A] * mean[MEAN_B];
    double square_a = mean[MEAN_A] * mean[MEAN_A], square_b = mean[MEAN_B] * mean[MEAN_B];
    double covariance = mean[MEAN_AB] - product;
    double variance_a = mean[MEAN_AA] - square_a, variance_b = mean[MEAN_BB] - square_b;
    return (2.0 * product + C1) * (2.0 * covariance + C2) /
           ((square_a + square_b + C1) * (variance_a + variance_b + C2));
}

/* One picture row's moments for n windows side by side; a and b are at the first window's left pixel. */
static void sum_across(moments_row out, const uint8_t *a, const uint8_t *b, unsigned n, const double weights[WINDOW]) {
    double luma_a[TILE + WINDOW - 1u], luma_b[TILE + WINDOW - 1u];
    for (unsigned x = 0; x < n + WINDOW - 1u; x++) {
        luma_a[x] = luma(a + (size_t)x * CHANNELS);
        luma_b[x] = luma(b + (size_t)x * CHANNELS);
    }
    for (unsigned x = 0; x < n; x++) {
        double sum[N_MOMENTS] = {0.0, 0.0, 0.0, 0.0, 0.0};
        for (unsigned i = 0; i < WINDOW; i++) {
            double value_a = luma_a[x + i], value_b = luma_b[x + i], weight = weights[i];
            sum[MEAN_A] += weight * value_a;
            sum[MEAN_B] += weight * value_b;
            sum[MEAN_AA] += weight * value_a * value_a;
            sum[MEAN_BB] += weight * value_b * value_b;
            sum[MEAN_AB] += weight * value_a * value_b;
        }
        for (unsigned moment = 0; moment < N_MOMENTS; moment++) {
            out[moment][x] = sum[moment];
        }
    }
}

/* The sum of the similarities of the n windows whose lowest picture row is y. */
static double sum_down(const moments_row ring[WINDOW], uint32_t y, unsigned n, const double weights[WINDOW]) {
    double sum = 0.0;
    for (unsigned x = 0; x < n; x++) {
        double mean[N_MOMENTS] = {0.0, 0.0, 0.0, 0.0, 0.0};
        for (unsigned i = 0; i < WINDOW; i++) {
            uint32_t row = (y - (WINDOW - 1u) + i) % WINDOW;
            for (unsigned moment = 0; moment < N_MOMENTS; moment++) {
                mean[moment] += weights[i] * ring[row][moment][x];
            }
        }
        sum += similarity(mean);
    }
    return sum;
}

/* The sum of the similarities of all windows whose left columns are the n from column first on. */
static double sum_tile(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height, uint32_t first, unsigned n,
                       const double weights[WINDOW]) {
    moments_row ring[WINDOW];
    double sum = 0.0;
    memset(ring, 0, sizeof ring);
    for (uint32_t y = 0; y < height; y++) {
        size_t offset = ((size_t)y * width + first) * CHANNELS;
        sum_across(ring[y % WINDOW], a + offset, b + offset, n, weights);
        if (y >= WINDOW - 1u) {
            sum += sum_down((const moments_row *)ring, y, n, weights);
        }
    }
    return sum;
}

static double global_similarity(const uint8_t *a, const uint8_t *b, uint64_t n_pixels) {
    double mean[N_MOMENTS] = {0.0, 0.0, 0.0, 0.0, 0.0};
    for (uint64_t i = 0; i < n_pixels; i++) {
        double value_a = luma(a + i * CHANNELS), value_b = luma(b + i * CHANNELS);
        mean[MEAN_A] += value_a;
        mean[MEAN_B] += value_b;
        mean[MEAN_AA] += value_a * value_a;
        mean[MEAN_BB] += value_b * value_b;
        mean[MEAN_AB] += value_a * value_b;
    }
    for (unsigned moment = 0; moment < N_MOMENTS; moment++) {
        mean[moment] /= (double)n_pixels;
    }
    return similarity(mean);
}

bool metrics_ssim_is_global(uint32_t width, uint32_t height) {
    return width < WINDOW || height < WINDOW;
}

double metrics_ssim(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height) {
    if (metrics_ssim_is_global(width, height)) {
        return global_similarity(a, b, (uint64_t)width * height);
    }
    double weights[WINDOW], sum = 0.0;
    uint32_t n_across = width - (WINDOW - 1u), n_down = height - (WINDOW - 1u);
    fill_weights(weights);
    for (uint32_t first = 0; first < n_across; first += TILE) {
        uint32_t n = n_across - first < TILE ? n_across - first : TILE;
        sum += sum_tile(a, b, width, height, first, n, weights);
    }
    return sum / ((double)n_across * (double)n_down);
}
