#!/bin/bash
# Bytes of machine code and constant data that the core adds to a program, by feature: size.sh CC DIRECTORY
# Each row is a program linked with unused sections dropped, less the same program without the core: what it really costs. The
# program builds a scene through the sink, a space, a summary where the row has one, and draws rows.
set -eu
cc=$1
dir=$2
mkdir -p "$dir"
cat > "$dir/user.c" <<'END'
#ifdef EMPTY
#include <math.h>
#include <string.h>
static volatile float x = 2;
int main(void) { char a[64]; memset(a, (int)sqrtf(x), sizeof a); memcpy(a, a + 32, 16); return a[(int)x]; }
#elif defined DRAFT
#include <aset/aset.h>
static ASET_ARENA_BLOCK(block, 4096);
static unsigned char row[64 * 3];
extern const uint32_t words[];
const uint32_t words[40] = {1};
int main(void) {
    aset_arena arena;
    aset_draft draft;
    aset_scratch scratch;
    aset_tracer tracer = {.draft = &draft, .scene = &draft.stage, .approx_kinds = ASET_ALL_KINDS, .depth = 1};
    aset_picture picture = {.width = 64, .height = 64, .pixels = row};
    aset_arena_init(&arena, block, sizeof block);
    aset_draft_open(&draft, words, 40, &arena, 0);
    aset_scratch_init(&scratch, 1, &arena);
    return aset_render_rows(&tracer, &draft.stage.view, &picture, 0, 64, &scratch, 0);
}
#else
#include <aset/aset.h>
static ASET_ARENA_BLOCK(block, 65536);
static unsigned char row[64 * 3];
int main(void) {
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_scratch scratch;
    aset_counts limits = {.objects = 9, .coordinates = 99, .materials = 1, .lights = 1};
    aset_view view = {.from = {0, -5, 0}, .up = {0, 0, 1}, .angle_deg = 40};
    aset_tracer tracer = {.scene = &scene, .space = &space};
    aset_picture picture = {.width = 64, .height = 64, .pixels = row};
    aset_arena_init(&arena, block, sizeof block);
    aset_scene_init(&scene, &arena, &limits);
    aset_sink sink = aset_scene_sink(&scene);
    sink.material(sink.context, &(aset_material){.diffuse = 1});
    aset_space_build(&space, &scene, &METHOD, 0, &arena);
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
    aset_summary_build(&summary, &space, 0, &arena);
    tracer.summary = &summary;
#endif
    aset_scratch_init(&scratch, 0, &arena);
    return aset_render_rows(&tracer, &view, &picture, 0, 64, &scratch, 0);
}
#endif
END
flags="-std=c99 -Os -ffp-contract=off -ffunction-sections -fdata-sections -fno-asynchronous-unwind-tables -Iinclude -Ilib"
bytes() { size "$1" | awk 'NR == 2 { print $1 + $2 }'; }
# shellcheck disable=SC2086
"$cc" $flags -DEMPTY "$dir/user.c" -Wl,--gc-sections -o "$dir/empty" -lm
empty=$(bytes "$dir/empty")
measure() { # label, method, switches
    label=$1
    method=$2
    shift 2
    # shellcheck disable=SC2086
    "$cc" $flags "$@" -DMETHOD=aset_$method "$dir/user.c" lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c \
        -Wl,--gc-sections -o "$dir/program" -lm
    printf '| %s | %s | %d |\n' "$label" "$method" $(($(bytes "$dir/program") - empty))
}
no_kinds="-DASET_WITH_CONES=0 -DASET_WITH_PATCHES=0"
no_effects="-DASET_WITH_REFLECTION=0 -DASET_WITH_REFRACTION=0"
exact="-DASET_WITH_APPROXIMATION=0"
echo "| what | method | bytes |"
echo "|---|---|---|"
for method in mset brute set grid octree arts excell; do
    measure "everything" $method
done
measure "without cones" mset -DASET_WITH_CONES=0
# shellcheck disable=SC2086
{
    measure "without cones and patches" mset $no_kinds
    measure "without refraction" mset -DASET_WITH_REFRACTION=0
    measure "without reflection and refraction" mset $no_effects
    measure "without the approximation" mset $exact
    measure "polygons only" mset $no_kinds -DASET_WITH_SPHERES=0
    measure "polygons only, no reflection or refraction" mset $no_kinds -DASET_WITH_SPHERES=0 $no_effects
    measure "the same, exact only" mset $no_kinds -DASET_WITH_SPHERES=0 $no_effects $exact
    measure "spheres only, exact only, no reflection or refraction" mset $no_kinds -DASET_WITH_POLYGONS=0 $no_effects $exact
    measure "the same" brute $no_kinds -DASET_WITH_POLYGONS=0 $no_effects $exact
    measure "a draft opened and drawn, all kinds of kept objects" - -DDRAFT
    measure "the same, kept polygons only, no reflection or refraction" - -DDRAFT $no_kinds -DASET_WITH_SPHERES=0 $no_effects
}
