/*
 * snow.c - the paper's Snow at 30 divisions on a microcontroller: 813 objects made by rule on the board itself, drawn exactly
 * (snow-exact.ppm) and approximately from the second ray on (snow-approximate.ppm, the paper's figure 4).
 */
#include "draw.h"

#include <aset/procedural.h>

/* The function that aset_procedural_find("snow") would give: named itself, it brings along no other scene. */
aset_status aset_procedural_snow(const aset_sink *sink, uint32_t size);

static struct ram {
    ASET_ARENA_BLOCK(block, 56 * 1024);
    aset_arena arena;
    aset_counter counter;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
} ram;

static aset_status make_scene(void) {
    aset_sink sink = aset_counter_sink(&ram.counter);
    aset_status status = aset_procedural_snow(&sink, 0);
    if (status == ASET_OK) status = aset_scene_init(&ram.scene, &ram.arena, &ram.counter.counts);
    if (status == ASET_OK) sink = aset_scene_sink(&ram.scene);
    return status == ASET_OK ? aset_procedural_snow(&sink, 0) : status;
}

int main(void) {
    const aset_space_options options = {.divisions = {30, 30, 30}};
    aset_tracer tracer = {.scene = &ram.scene, .space = &ram.space, .curtail = 0.5f};
    aset_status status = aset_arena_init(&ram.arena, ram.block, sizeof ram.block);
    if (status == ASET_OK) status = make_scene();
    if (status == ASET_OK) status = aset_space_build(&ram.space, &ram.scene, &aset_mset, &options, &ram.arena);
    if (status == ASET_OK) status = aset_summary_build(&ram.summary, &ram.space, 0, &ram.arena);
    if (status == ASET_OK) status = aset_scratch_init(&ram.scratch, DEPTH, &ram.arena);
    if (status == ASET_OK) status = draw("snow-exact.ppm", &tracer, &ram.scene.view, &ram.scratch);
    tracer.summary = &ram.summary;
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.approx_depth = 1;
    if (status == ASET_OK) status = draw("snow-approximate.ppm", &tracer, &ram.scene.view, &ram.scratch);
    if (status != ASET_OK) return fail("snow", status);
    print_memory(&ram.arena);
    return 0;
}
