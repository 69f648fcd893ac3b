/*
 * test_metrics.c - the figures of `aset compare` against an independent implementation.
 *
 * The pictures are made by integer formulas, so anyone can make them again. The expected figures were computed once by
 * scikit-image 0.26.0 (numpy 2.4.6, scipy 1.17.1) on the same pictures:
 *     peak_signal_noise_ratio(a, b, data_range=255) and mean_squared_error(a, b) on all of R, G and B;
 *     structural_similarity(luma_a, luma_b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
 *                           data_range=255), luma = 0.299 R + 0.587 G + 0.114 B in doubles.
 * It has no value for pictures smaller than its window; those are the same formula on numpy's mean, var and covariance.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "../tools/metrics.h"

#include <math.h>

#define CHANNELS 3u
#define LARGEST_BYTES (150u * 40u * CHANNELS)
/* Both sides sum doubles in other orders; the figures are printed with 15 digits. */
#define TOLERANCE 1e-10

/* How the second picture comes from the first. */
enum change { NOISE, BRIGHTER, ONE_STEP, SHIFTED, BLACK_WHITE, EQUAL };

/* Parabolic and linear ramps with a checkerboard of 5 x 7 pixels, wrapped at 256: edges, smooth parts and texture. */
static unsigned pattern(unsigned x, unsigned y, unsigned channel) {
    return (x * x / 9u + y * 3u + channel * 40u + (x / 5u + y / 7u) % 2u * 60u) & 255u;
}

static uint8_t clamp(int value) {
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

static uint8_t changed(enum change change, unsigned x, unsigned y, unsigned channel) {
    int value = (int)pattern(x, y, channel);
    switch (change) {
    case NOISE: return clamp(value + (int)((x * 31u + y * 17u + channel * 11u + x * y) % 23u) - 11);
    case BRIGHTER: return clamp(value + 20);
    case ONE_STEP: return (uint8_t)(x == 30 && y == 20 && channel == 1 ? value ^ 1 : value);
    case SHIFTED: return (uint8_t)pattern(x + 3u, y + 2u, channel);
    case BLACK_WHITE: return 255;
    case EQUAL: break;
    }
    return (uint8_t)value;
}

static void make_pictures(uint8_t *a, uint8_t *b, enum change change, unsigned width, unsigned height) {
    assert_true(width * height * CHANNELS <= LARGEST_BYTES);
    for (unsigned y = 0; y < height; y++) {
        for (unsigned x = 0; x < width; x++) {
            for (unsigned channel = 0; channel < CHANNELS; channel++) {
                *a++ = (uint8_t)(change == BLACK_WHITE ? 0 : pattern(x, y, channel));
                *b++ = changed(change, x, y, channel);
            }
        }
    }
}

static void assert_near(const char *what, unsigned row, double value, double expected) {
    if (!(fabs(value - expected) <= TOLERANCE * fmax(1.0, fabs(expected)))) {
        fail_msg("row %u: %s is %.15g, expected %.15g", row, what, value, expected);
    }
}

static const struct {
    enum change change;
    unsigned width, height;
    double psnr, mse, ssim;
    unsigned max_difference, n_differing;
} rows[] = {
    {NOISE, 48, 40, 31.6834780026352, 44.1298611111111, 0.992656830166038, 11, 1920},
    /* a single window; then as wide as a tile of 64 windows, one more, and more than two */
    {NOISE, 11, 11, 31.7364326721463, 43.5950413223141, 0.992366702552676, 11, 121},
    {NOISE, 74, 19, 31.6869500681101, 44.0945945945946, 0.9940795630153273, 11, 1406},
    {NOISE, 75, 19, 31.6882955648749, 44.0809356725146, 0.9941136530590363, 11, 1425},
    {NOISE, 150, 23, 31.7156026833839, 43.8046376811594, 0.9954144360327519, 11, 3450},
    {BRIGHTER, 48, 40, 22.2843273580375, 384.279861111111, 0.9884645318698758, 20, 1920},
    {ONE_STEP, 48, 40, 85.7350284429112, 0.000173611111111111, 0.9999998549808429, 1, 1},
    {SHIFTED, 150, 23, 8.22402793854106, 9787.63053140097, -0.043140180824208306, 252, 3438},
    {BLACK_WHITE, 20, 20, 0.0, 65025.0, 9.99900009999e-05, 255, 400},
    /* smaller than a window in one direction, in the other, in both */
    {NOISE, 10, 30, 31.5721657282092, 45.2755555555556, 0.996575247923564, 11, 300},
    {NOISE, 30, 10, 31.6894826010856, 44.0688888888889, 0.997215006469058, 11, 300},
    {NOISE, 7, 5, 31.7000385979017, 43.9619047619048, 0.993397139214346, 11, 35},
    {NOISE, 1, 1, 32.0741624527112, 40.3333333333333, 0.999290174522466, 11, 1},
};

static void test_metrics__independent_values(void **state) {
    static uint8_t a[LARGEST_BYTES], b[LARGEST_BYTES];
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        make_pictures(a, b, rows[i].change, rows[i].width, rows[i].height);
        metrics_difference difference = metrics_differ(a, b, rows[i].width, rows[i].height);
        double rmse = metrics_rmse(&difference);
        assert_near("psnr", i, metrics_psnr(&difference), rows[i].psnr);
        assert_near("rmse squared", i, rmse * rmse, rows[i].mse);
        assert_near("ssim", i, metrics_ssim(a, b, rows[i].width, rows[i].height), rows[i].ssim);
        assert_int_equal(difference.max_difference, rows[i].max_difference);
        assert_int_equal(difference.n_differing, rows[i].n_differing);
        assert_int_equal(difference.n_pixels, rows[i].width * rows[i].height);
    }
}

/* The order of the two pictures does not matter. */
static void test_metrics__symmetric(void **state) {
    static uint8_t a[LARGEST_BYTES], b[LARGEST_BYTES];
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        make_pictures(a, b, rows[i].change, rows[i].width, rows[i].height);
        metrics_difference there = metrics_differ(a, b, rows[i].width, rows[i].height);
        metrics_difference back = metrics_differ(b, a, rows[i].width, rows[i].height);
        assert_true(there.squares == back.squares && there.n_differing == back.n_differing);
        assert_int_equal(there.max_difference, back.max_difference);
        assert_near("ssim", i, metrics_ssim(a, b, rows[i].width, rows[i].height),
                    metrics_ssim(b, a, rows[i].width, rows[i].height));
    }
}

static void test_metrics__equal_pictures(void **state) {
    static const unsigned sizes[][2] = {{48, 40}, {11, 11}, {150, 23}, {10, 30}, {1, 1}};
    static uint8_t a[LARGEST_BYTES], b[LARGEST_BYTES];
    (void)state;
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        make_pictures(a, b, EQUAL, sizes[i][0], sizes[i][1]);
        metrics_difference difference = metrics_differ(a, b, sizes[i][0], sizes[i][1]);
        assert_true(metrics_psnr(&difference) == METRICS_PSNR_MAX);
        assert_true(metrics_rmse(&difference) == 0.0);
        assert_near("ssim", i, metrics_ssim(a, b, sizes[i][0], sizes[i][1]), 1.0);
        assert_int_equal(difference.max_difference, 0);
        assert_int_equal(difference.n_differing, 0);
    }
}

/* One step in one channel of a large picture would be 107 dB; no unequal picture is to look better than an equal one. */
static void test_metrics__psnr_at_most_that_of_equal_pictures(void **state) {
    const metrics_difference difference = {1, 512u * 512u, 1, 1};
    (void)state;
    assert_true(10.0 * log10(65025.0 * 3.0 * 512.0 * 512.0) > METRICS_PSNR_MAX);
    assert_true(metrics_psnr(&difference) == METRICS_PSNR_MAX);
    assert_true(metrics_rmse(&difference) > 0.0);
}

static void test_metrics__where_no_window_fits(void **state) {
    (void)state;
    assert_false(metrics_ssim_is_global(11, 11));
    assert_true(metrics_ssim_is_global(10, 11));
    assert_true(metrics_ssim_is_global(11, 10));
    assert_true(metrics_ssim_is_global(1, 1000));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_metrics__independent_values),
        cmocka_unit_test(test_metrics__symmetric),
        cmocka_unit_test(test_metrics__equal_pictures),
        cmocka_unit_test(test_metrics__psnr_at_most_that_of_equal_pictures),
        cmocka_unit_test(test_metrics__where_no_window_fits),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
