/*
 * draft.c - a baked draft drawn out of flash (draft.ppm). model.h is made by `aset bake MODEL --name model -o model.h`; all
 * that is written to, the stack included, stays below 16 kB (tests/firmware.sh asserts it).
 */
#include "draw.h"

#include "model.h"

static struct ram {
    ASET_ARENA_BLOCK(block, MODEL_STAGE_BYTES + ASET_BYTES_SCRATCH(DEPTH));
    aset_arena arena;
    aset_draft draft;
    aset_scratch scratch;
} ram;

int main(void) {
    const char *why = NULL;
    aset_status status = aset_arena_init(&ram.arena, ram.block, sizeof ram.block);
    if (status == ASET_OK) status = aset_draft_open(&ram.draft, model, sizeof model / sizeof model[0], &ram.arena, &why);
    if (status == ASET_OK) status = aset_scratch_init(&ram.scratch, DEPTH, &ram.arena);
    const aset_tracer tracer = {
        .scene = &ram.draft.stage, .draft = &ram.draft, .approx_kinds = ASET_ALL_KINDS, .curtail = 0.5f};
    if (status == ASET_OK) status = draw("draft.ppm", &tracer, &ram.draft.stage.view, &ram.scratch);
    if (status != ASET_OK) return fail(why != NULL ? why : "draft", status);
    print_number("draft in flash", sizeof model, " bytes");
    print_memory(&ram.arena);
    return 0;
}
