/*
 * compare.c - the command `aset compare`: how far apart two pictures are, in figures and as a picture.
 */
#include "metrics.h"
#include "tool.h"

#include <stdlib.h>
#include <string.h>

#define CHANNELS 3u
/* Factor of the difference picture; the help text says it too. */
#define AMPLIFICATION 8u

static const char help[] =
    "aset compare A B [-o DIFF.png] [--json]: tells how different two pictures of one size are.\n"
    "\n"
    "A and B are PNG (any kind, brought to 8 bits of RGB, transparency laid over black) or binary PPM.\n"
    "\n"
    "  psnr            peak signal to noise ratio over R, G and B in dB; 99 when equal, and at most\n"
    "  rmse            root of the mean squared difference over R, G and B, 0 to 255\n"
    "  ssim            structural similarity of the luma (Wang et al. 2004: Gaussian window 11 x 11 of\n"
    "                  sigma 1.5), the mean over all windows within the picture; 1 when equal. If a side\n"
    "                  is below 11 pixels, the formula once on the whole picture\n"
    "  max_difference  the largest difference of any R, G or B, 0 to 255\n"
    "  differing       the share of pixels that differ at all, 0 to 1\n"
    "\n"
    "Options:\n"
    "  -o, --output F  write a picture of the differences to F (.png or .ppm): |A - B| of each channel\n"
    "                  times 8, at most 255; equal pixels are black\n"
    "  --json          print one JSON object with these five keys\n"
    "  -h, --help      print this text\n"
    "\n"
    "The exit status is 0 whether they differ or not, 1 if they cannot be compared.\n";

static bool same_size(const tool_image *a, const tool_image *b, char *const paths[2]) {
    if (a->width == b->width && a->height == b->height) {
        return true;
    }
    tool_error(paths[1], 0, "this picture is %lux%lu, but %s is %lux%lu", (unsigned long)b->width,
               (unsigned long)b->height, paths[0], (unsigned long)a->width, (unsigned long)a->height);
    return false;
}

static void subtract_row(uint8_t *row, const uint8_t *a, const uint8_t *b, size_t n) {
    for (size_t i = 0; i < n; i++) {
        unsigned step = AMPLIFICATION * (unsigned)abs((int)a[i] - (int)b[i]);
        row[i] = (uint8_t)(step < 255u ? step : 255u);
    }
}

/* Writes the difference picture, row by row into a's own memory, which is not needed any more. */
static bool write_difference(const char *path, tool_image *a, const tool_image *b) {
    size_t row_bytes = (size_t)a->width * CHANNELS;
    tool_picture *picture = tool_picture_open(path, a->width, a->height, CHANNELS);
    if (picture == NULL) {
        return false;
    }
    for (uint32_t y = 0; y < a->height; y++) {
        uint8_t *row = a->rgb + y * row_bytes;
        subtract_row(row, row, b->rgb + y * row_bytes, row_bytes);
        if (!tool_picture_row(picture, row)) {
            tool_picture_abort(picture);
            return false;
        }
    }
    return tool_picture_close(picture);
}

static bool print_figures(const metrics_difference *difference, double ssim, bool is_global, bool json) {
    tool_output output;
    double differing = (double)difference->n_differing / (double)difference->n_pixels;
    double psnr = metrics_psnr(difference), rmse = metrics_rmse(difference);
    if (!tool_output_open(&output, "-")) {
        return false;
    }
    if (json) {
        (void)fprintf(output.stream,
                      "{\"psnr\":%.9g,\"rmse\":%.9g,\"ssim\":%.9g,\"max_difference\":%u,\"differing\":%.9g}\n", psnr, rmse,
                      ssim, difference->max_difference, differing);
    } else {
        (void)fprintf(output.stream,
                      "psnr            %.3f dB%s\n"
                      "rmse            %.4f of 255\n"
                      "ssim            %.6f%s\n"
                      "max_difference  %u of 255\n"
                      "differing       %.6f (%llu of %llu pixels)\n",
                      psnr, difference->squares == 0 ? " (equal)" : "", rmse, ssim,
                      is_global ? " (one window: a side is below 11 pixels)" : "", difference->max_difference,
                      differing, (unsigned long long)difference->n_differing, (unsigned long long)difference->n_pixels);
    }
    return tool_output_close(&output);
}

static int compare(char *const paths[2], const char *difference_path, bool json) {
    tool_image a = {NULL, 0, 0}, b = {NULL, 0, 0};
    bool done = tool_image_read(&a, paths[0]) && tool_image_read(&b, paths[1]) && same_size(&a, &b, paths);
    if (done) {
        metrics_difference difference = metrics_differ(a.rgb, b.rgb, a.width, a.height);
        double ssim = metrics_ssim(a.rgb, b.rgb, a.width, a.height);
        done = difference_path == NULL || write_difference(difference_path, &a, &b);
        done = done && print_figures(&difference, ssim, metrics_ssim_is_global(a.width, a.height), json);
    }
    tool_image_free(&a);
    tool_image_free(&b);
    return done ? TOOL_DONE : TOOL_FAILED;
}

int command_compare(int argc, char **argv) {
    static const struct option longs[] = {
        {"output", required_argument, NULL, 'o'},
        {"json", no_argument, NULL, 'j'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    const char *difference_path = NULL;
    bool json = false;
    int option;
    while ((option = tool_option_next(argc, argv, "o:h", longs)) != -1) {
        switch (option) {
        case 'o':
            if (!tool_parse_output(optarg, &difference_path)) {
                return TOOL_USAGE;
            }
            break;
        case 'j': json = true; break;
        case 'h': return tool_help(help);
        default: return TOOL_USAGE;
        }
    }
    if (argc - optind != 2) {
        tool_error(NULL, 0, "compare: expected two pictures, got %d words; aset compare --help", argc - optind);
        return TOOL_USAGE;
    }
    if (difference_path != NULL && strcmp(difference_path, "-") == 0) {
        tool_error(NULL, 0, "compare: --output: the figures go to standard output; give the picture a file");
        return TOOL_USAGE;
    }
    if (difference_path != NULL && !tool_picture_path_ok(difference_path)) {
        return TOOL_USAGE;
    }
    return compare(argv + optind, difference_path, json);
}
