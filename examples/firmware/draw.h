/* draw.h - what both programs do: a picture row by row into a file, as PPM, and what that took. */
#ifndef FIRMWARE_DRAW_H
#define FIRMWARE_DRAW_H

#include "print.h"

#include <aset/aset.h>

#define WIDTH 160
#define HEIGHT 120
#define DEPTH ASET_DEPTH_DEFAULT

static unsigned char row[WIDTH * 3];

static inline int fail(const char *what, aset_status status) {
    board_text("firmware: ");
    board_text(what);
    board_text(": ");
    board_text(aset_status_text(status));
    board_text("\n");
    return 1;
}

static inline int write_row(void *context, uint32_t y, const void *pixels) {
    (void)y;
    return board_write(*(const int *)context, pixels, sizeof row);
}

static inline aset_status draw(const char *name, const aset_tracer *tracer, const aset_view *view, aset_scratch *scratch) {
    static const char header[] = "P6\n160 120\n255\n";
    static aset_statistics statistics;
    int file = board_open(name);
    if (file < 0 || board_write(file, header, sizeof header - 1) != 0) {
        return ASET_ERR_STOPPED;
    }
    const aset_picture picture = {.width = WIDTH, .height = HEIGHT, .pixels = row, .on_row = write_row, .context = &file};
    const aset_statistics none = {0};
    statistics = none;
    uint64_t start = board_clock();
    aset_status status = aset_render_rows(tracer, view, &picture, 0, HEIGHT, scratch, &statistics);
    uint64_t took = board_clock() - start;
    board_close(file);
    uint64_t rays = statistics.primary + statistics.shadow + statistics.reflected + statistics.refracted;
    print_number(name, rays, " rays");
    if (status == ASET_OK && took > 0) {
        board_text(name);
        print_number(", a ray", took / rays, "");
        board_text(name);
        board_text(", unit: ");
        board_text(board_clock_unit);
        board_text("\n");
    }
    return status;
}

static inline void print_memory(const aset_arena *arena) {
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        if (arena->peak_by[i] > 0) {
            print_number(aset_category_name((aset_category)i), arena->peak_by[i], " bytes");
        }
    }
    print_number("arena", arena->peak, " bytes");
    if (board_stack_bytes() > 0) {
        print_number("flash in all", board_flash_bytes(), " bytes");
        print_number("ram without stack", board_ram_bytes(), " bytes");
        print_number("deepest stack", board_stack_deepest(), " bytes");
        print_number("ram with deepest stack", board_ram_bytes() + board_stack_deepest(), " bytes");
    }
}

#endif
