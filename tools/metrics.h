/*
 * metrics.h - how different two pictures are. Pure functions on pixels in memory; nothing else of the tool is needed.
 */
#ifndef ASET_METRICS_H
#define ASET_METRICS_H

#include <stdbool.h>
#include <stdint.h>

/* What metrics_psnr gives for equal pictures, and at most: an error of one step in a single pixel would go beyond. */
#define METRICS_PSNR_MAX 99.0

/* Side of the window of metrics_ssim in pixels. */
#define METRICS_SSIM_WINDOW 11u

typedef struct metrics_difference {
    uint64_t squares;        /* sum of the squared differences of all R, G and B */
    uint64_t n_pixels;       /* of one picture */
    uint64_t n_differing;    /* pixels that differ at all */
    unsigned max_difference; /* of any one channel, 0 to 255 */
} metrics_difference;

/*
 * All functions take two pictures a and b of width * height pixels (1 to 2^28) of three bytes R, G, B, without gaps.
 */
metrics_difference metrics_differ(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height);

/* Root of the mean squared difference over all pixels and channels, 0 to 255. */
double metrics_rmse(const metrics_difference *difference);

/* Peak signal to noise ratio in dB against 255, of the same mean squared difference. */
double metrics_psnr(const metrics_difference *difference);

/*
 * The mean structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment: from error
 * visibility to structural similarity", 2004): luma by ITU-R BT.601 (0.299 R + 0.587 G + 0.114 B, not rounded),
 * Gaussian window of 11 x 11 pixels and sigma 1.5, K1 = 0.01, K2 = 0.03, L = 255, the mean over all windows that lie
 * within the picture. 1 for equal pictures. Where no window fits (metrics_ssim_is_global), the same formula once, on
 * the plain means, variances and covariance of the whole pictures. About 250 multiplications a pixel; a fixed 30 kB
 * of stack.
 */
double metrics_ssim(const uint8_t *a, const uint8_t *b, uint32_t width, uint32_t height);
bool metrics_ssim_is_global(uint32_t width, uint32_t height);

#endif
