/*
 * flash.c - a microcontroller, on the host: a draft in 64 kB of flash is opened where it lies and drawn row by row,
 * 160 x 120, in 16 kB of RAM; a display would take the rows, here they go to standard output as a PPM. A draft or a RAM
 * that is too large does not compile.
 *
 * The header is made by `aset bake skull.nff --grid 40 --name model -o flash_model.h`: any other scene or model will do.
 */
#include <aset/aset.h>

#include "flash_model.h"

#include <stdio.h>

#define WIDTH 160
#define HEIGHT 120
#define DEPTH ASET_DEPTH_DEFAULT
#define FLASH_BYTES (64 * 1024)
#define RAM_BYTES (16 * 1024)
/* For the stack: the library takes 3.4 kB of it here, 5.8 in double (gcc and clang on x86-64, from -O1 to -Os). */
#define STACK_BYTES (7 * 1024)

/* All that is written to; the draft itself is const and stays in the flash. */
static struct ram {
    ASET_ARENA_BLOCK(block, MODEL_STAGE_BYTES + ASET_BYTES_SCRATCH(DEPTH));
    aset_arena arena;
    aset_draft draft;
    aset_scratch scratch;
    unsigned char row[WIDTH * 3];
} ram;

/* C99's way to say it: an array of a negative size is an error. */
typedef char draft_fits_into_the_flash[sizeof model <= FLASH_BYTES ? 1 : -1];
typedef char the_rest_fits_into_the_ram[sizeof ram + STACK_BYTES <= RAM_BYTES ? 1 : -1];

static int write_row(void *context, uint32_t y, const void *pixels) {
    (void)y;
    return fwrite(pixels, 3, WIDTH, context) != WIDTH;
}

static int fail(aset_status status, const char *why) {
    fprintf(stderr, "%s\n", why != NULL ? why : aset_status_text(status));
    return 1;
}

static void print_bytes(void) {
    fprintf(stderr, "flash %6lu bytes of %d: the draft\n", (unsigned long)sizeof model, FLASH_BYTES);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        if (ram.arena.peak_by[i] > 0) {
            fprintf(stderr, "ram   %6lu bytes: %s\n", (unsigned long)ram.arena.peak_by[i],
                    aset_category_text((aset_category)i));
        }
    }
    fprintf(stderr, "ram   %6lu bytes: a row\n", (unsigned long)sizeof ram.row);
    fprintf(stderr, "ram   %6lu bytes: the structs that hold all this together\n",
            (unsigned long)(sizeof ram - sizeof ram.block - sizeof ram.row));
    fprintf(stderr, "ram   %6d bytes: left for the stack\n", STACK_BYTES);
    fprintf(stderr, "ram   %6lu bytes of %d in all\n", (unsigned long)sizeof ram + STACK_BYTES, RAM_BYTES);
}

int main(void) {
    const char *why = NULL;
    aset_status status = aset_arena_init(&ram.arena, ram.block, sizeof ram.block);
    const size_t n_words = sizeof model / sizeof model[0];
    if (status == ASET_OK) status = aset_draft_open(&ram.draft, model, n_words, &ram.arena, &why);
    if (status == ASET_OK) status = aset_scratch_init(&ram.scratch, DEPTH, &ram.arena);
    if (status != ASET_OK) return fail(status, why);
    const aset_tracer tracer = {
        .scene = &ram.draft.stage, .draft = &ram.draft, .approx_kinds = ASET_ALL_KINDS, .curtail = 0.5f};
    const aset_picture picture = {
        .width = WIDTH, .height = HEIGHT, .pixels = ram.row, .on_row = write_row, .context = stdout};
    printf("P6\n%d %d\n255\n", WIDTH, HEIGHT);
    status = aset_render_rows(&tracer, &ram.draft.stage.view, &picture, 0, HEIGHT, &ram.scratch, NULL);
    if (status != ASET_OK) return fail(status, NULL);
    print_bytes();
    return fflush(stdout) != 0;
}
