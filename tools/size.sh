#!/bin/bash
# Bytes of machine code and constant data that the core adds to a program, by feature: size.sh CC DIRECTORY [docs/size.md]
# Each row is a program that draws, linked with unused sections dropped. Cortex-M: .text and .rodata of all of it, libm, libgcc and
# mem* included, without startup. The host: less the same program without the core. A file, if named, gets the table as a page.
# Ends with an error where one of the promised limits is exceeded.
set -eu
cc=$1
dir=$2
page=${3:-}
mkdir -p "$dir"
cat > "$dir/user.c" <<'END'
#ifdef EMPTY
#include <math.h>
#include <string.h>
static volatile float x = 2;
int main(void) { char a[64]; memset(a, (int)sqrtf(x), sizeof a); memcpy(a, a + 32, 16); return a[(int)x]; }
#else
#include <aset/aset.h>
static ASET_ARENA_BLOCK(block, 32768);
static unsigned char row[64 * 3];
extern const uint32_t *volatile flash; /* where a draft lies and how long it is, which the optimizer shall not know */
extern volatile size_t flash_words;
#ifdef DRAFT
int main(void) {
    aset_arena arena;
    aset_draft draft;
    aset_scratch scratch;
    const aset_tracer tracer = {.draft = &draft, .scene = &draft.stage, .approx_kinds = ASET_ALL_KINDS};
    const aset_picture picture = {.width = 64, .height = 64, .pixels = row};
    return aset_arena_init(&arena, block, sizeof block) || aset_draft_open(&draft, flash, flash_words, &arena, 0) ||
           aset_scratch_init(&scratch, 0, &arena) || aset_render_rows(&tracer, &draft.stage.view, &picture, 0, 64, &scratch, 0);
}
#else
extern volatile aset_real input[16];
int main(void) {
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_scratch scratch;
    const aset_counts limits = {.objects = 9, .coordinates = 99, .materials = 1, .lights = 1};
    const aset_vec3 p[3] = {{input[0], input[1], input[2]}, {input[3], input[4], input[5]}, {input[6], input[7], input[8]}};
    const aset_view view = {.from = p[0], .up = p[1], .angle_deg = input[9]};
    const aset_light light = {.position = p[2]};
    const aset_material material = {.diffuse = input[10], .specular = input[11], .shine = input[12]};
    aset_tracer tracer = {.scene = &scene, .space = &space};
    const aset_picture picture = {.width = 64, .height = 64, .pixels = row};
    aset_status status = aset_arena_init(&arena, block, sizeof block);
    if (status == ASET_OK) status = aset_scene_init(&scene, &arena, &limits);
    if (status != ASET_OK) return status;
    const aset_sink sink = aset_scene_sink(&scene);
    status = sink.light(sink.context, &light);
    if (status == ASET_OK) status = sink.material(sink.context, &material);
#if ASET_WITH_POLYGONS
    if (status == ASET_OK) status = aset_sink_polygon(&sink, p, ASET_WITH_PATCHES ? p : 0, 3);
#endif
#if ASET_WITH_SPHERES
    if (status == ASET_OK) status = sink.sphere(sink.context, &p[0], input[13]);
#endif
#if ASET_WITH_CONES
    if (status == ASET_OK) status = sink.cone(sink.context, &p[0], input[13], &p[1], input[14]);
#endif
#ifdef METHOD
    if (status == ASET_OK) status = aset_space_build(&space, &scene, &METHOD, 0, &arena);
#else /* any of them: which, the optimizer shall not know */
    static const aset_method *const methods[] = {&aset_brute, &aset_set, &aset_mset, &aset_grid, &aset_octree, &aset_arts, &aset_excell};
    if (status == ASET_OK) status = aset_space_build(&space, &scene, methods[(int)input[15]], 0, &arena);
#endif
#if ASET_WITH_APPROXIMATION && !defined(EXACT)
    aset_summary summary;
    if (status == ASET_OK) status = aset_summary_build(&summary, &space, 0, &arena);
    tracer.summary = &summary;
    tracer.approx_kinds = ASET_ALL_KINDS;
#endif
#ifdef DRAFTS_TOO
    aset_draft draft;
    aset_reach reach;
    aset_beams beams;
    if (status == ASET_OK) status = aset_draft_open(&draft, flash, flash_words, &arena, 0);
    if (status == ASET_OK) status = aset_reach_init(&reach, &draft, 64, &arena);
    if (status == ASET_OK) status = aset_beams_init(&beams, 1024, &arena);
    tracer.draft = &draft;
    tracer.reach = &reach;
#endif
    if (status == ASET_OK) status = aset_scratch_init(&scratch, 0, &arena);
#ifdef DRAFTS_TOO
    scratch.beams = &beams;
#endif
    return status == ASET_OK ? aset_render_rows(&tracer, &view, &picture, 0, 64, &scratch, 0) : status;
}
#endif
#endif
END
cat > "$dir/data.c" <<'END'
#include <aset/aset.h>
const uint32_t *volatile flash;
volatile size_t flash_words;
volatile aset_real input[16];
#ifdef __arm__ /* byte by byte, as a port without a C library has them; the linker drops what nobody calls */
void *memcpy(void *restrict to, const void *restrict from, size_t n) {
    for (size_t i = 0; i < n; i++) ((char *)to)[i] = ((const char *)from)[i];
    return to;
}
void *memmove(void *to, const void *from, size_t n) {
    if ((char *)to <= (const char *)from) return memcpy(to, from, n);
    for (; n > 0; n--) ((char *)to)[n - 1] = ((const char *)from)[n - 1];
    return to;
}
void *memset(void *to, int byte, size_t n) {
    for (size_t i = 0; i < n; i++) ((char *)to)[i] = (char)byte;
    return to;
}
int memcmp(const void *a, const void *b, size_t n) {
    const unsigned char *x = a, *y = b;
    for (; n > 0 && *x == *y; n--) x++, y++;
    return n > 0 ? *x - *y : 0;
}
#endif
END
common="-std=c99 -Os -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections -fno-asynchronous-unwind-tables -fvisibility=hidden -Iinclude -Ilib"
core="lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c"
lto="-flto -flto-partition=one -fno-ipa-cp -fno-move-loop-invariants -fno-schedule-insns2"
m4="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16"
m0="-mcpu=cortex-m0plus -mthumb -mfloat-abi=soft"
arm_link="--specs=nano.specs -nostartfiles -Wl,--gc-sections,-emain"
host_link="-Wl,--gc-sections"
has_arm=1
if ! command -v arm-none-eabi-gcc > /dev/null 2>&1; then
    echo "size: arm-none-eabi-gcc is not here (make deps-firmware): the host alone is measured" >&2
    has_arm=0
fi

# The core compiled with some switches, once: the folder of its objects.
objects() { # target's name, compiler, flags, switches
    name=$1
    compiler=$2
    flags=$3
    shift 3
    switches=$(printf '%s\n' "$@" | grep ASET_ | sort | tr -dc 'A-Z0-9\n' | sed 's/ASETWITH//' | tr -d '\n' || true)
    made=$dir/$name-$switches
    if [ ! -d "$made" ]; then
        mkdir -p "$made.new"
        for file in $core; do
            # shellcheck disable=SC2086
            "$compiler" $common $flags "$@" -c "$file" -o "$made.new/$(echo "$file" | tr / _).o"
        done
        mv "$made.new" "$made"
    fi
    echo "$made"
}
# What the linker takes to keep every public function whose name matches one expression and not another: public headers alone declare
# what is not hidden.
kept() { # regular expressions
    readelf -sW "$(objects host "$cc" "")"/*.o |
        awk -v wanted="$1" -v unwanted="${2:-^$}" '$5 == "GLOBAL" && $6 == "DEFAULT" && $7 != "UND" && $8 ~ wanted && $8 !~ unwanted { print "-Wl,-u," $8 }' | sort -u
}
host() { # switches
    made=$(objects host "$cc" "" "$@")
    # shellcheck disable=SC2086
    "$cc" $common "$@" "$dir/user.c" "$dir/data.c" "$made"/*.o $host_link -o "$dir/program" -lm
    size "$dir/program" | awk -v empty="$empty" 'NR == 2 { print $1 + $2 - empty }'
}
arm() { # target's name, its flags, switches
    target=$1
    cpu=$2
    shift 2
    if [ $has_arm = 0 ]; then echo -; return; fi
    made=$(objects "$target" arm-none-eabi-gcc "$cpu" "$@")
    # the data lie outside of what is optimized as a whole
    # shellcheck disable=SC2086
    arm-none-eabi-gcc $common $cpu "$@" -fno-lto -fno-tree-loop-distribute-patterns -c "$dir/data.c" -o "$dir/data-$target.o"
    # shellcheck disable=SC2086
    arm-none-eabi-gcc $common $cpu $arm_link "$@" "$dir/user.c" "$dir/data-$target.o" "$made"/*.o -o "$dir/$target.elf" -lm -lgcc \
        2> "$dir/log-$target" || { cat "$dir/log-$target" >&2; exit 1; }
    arm-none-eabi-size -A "$dir/$target.elf" | awk '$1 == ".text" || $1 == ".rodata" { n += $2 } END { print n }'
}
rm -rf "$dir"/host-* "$dir"/m[04]*-*
# shellcheck disable=SC2086
"$cc" $common -DEMPTY "$dir/user.c" -Wl,--gc-sections -o "$dir/empty" -lm
empty=$(size "$dir/empty" | awk 'NR == 2 { print $1 + $2 }')

bad=0
out=$dir/table
: > "$out"
say() { echo "$1" | tee -a "$out"; }
check() { # label, bytes, limit or -
    if [ "$3" != - ] && [ "$2" != - ] && [ "$2" -ge "$3" ]; then
        echo "size: $1: $2 bytes, promised are less than $3" >&2
        bad=1
    fi
}
measure() { # label, limit of the first column or -, switches
    label=$1
    limit=$2
    shift 2
    arm m4lto "$m4 $lto" "$@" > "$dir/small" &
    arm m4 "$m4" "$@" > "$dir/plain" &
    arm m0 "$m0" "$@" > "$dir/soft" &
    host "$@" > "$dir/hosted"
    wait
    small=$(cat "$dir/small") plain=$(cat "$dir/plain") soft=$(cat "$dir/soft") hosted=$(cat "$dir/hosted")
    say "| $label | $small | $plain | $soft | $hosted |"
    check "$label" "$small" "$limit"
}
polygons="-DASET_WITH_CONES=0 -DASET_WITH_PATCHES=0 -DASET_WITH_SPHERES=0"
spheres="-DASET_WITH_CONES=0 -DASET_WITH_PATCHES=0 -DASET_WITH_POLYGONS=0"
none="$polygons -DASET_WITH_POLYGONS=0"
no_effects="-DASET_WITH_REFLECTION=0 -DASET_WITH_REFRACTION=0"
exact="-DASET_WITH_APPROXIMATION=0"
say "| program | Cortex-M4F, whole | Cortex-M4F | Cortex-M0+, soft float | x86-64 |"
say "|---|---|---|---|---|"
# shellcheck disable=SC2086
{
    measure "a draft opened and drawn; no kept objects; no reflection or refraction" 12288 -DDRAFT $none $no_effects
    measure "the same with reflection and refraction" - -DDRAFT $none
    measure "a draft, kept polygons; no reflection or refraction" - -DDRAFT $polygons $no_effects
    measure "a draft, kept objects of all kinds; every switch as it comes" - -DDRAFT
    measure "exact, MSET, polygons; no reflection or refraction" 24576 -DMETHOD=aset_mset $polygons $exact $no_effects
    measure "exact, MSET, polygons; with both" 24576 -DMETHOD=aset_mset $polygons $exact
    measure "exact, MSET, spheres; no reflection or refraction" - -DMETHOD=aset_mset $spheres $exact $no_effects
    measure "exact, brute force, spheres; no reflection or refraction" - -DMETHOD=aset_brute $spheres $exact $no_effects
    measure "exact, MSET, all kinds; every switch as it comes" - -DMETHOD=aset_mset -DEXACT
    for method in mset brute set grid octree arts excell; do
        measure "exact and approximate, $method, all kinds" - -DMETHOD=aset_$method
    done
    # the whole core, more and more of it. A program has all seven methods if it chooses one at run time.
    measure "all seven methods, exact and approximate, all kinds" 65536
    measure "the same, and drafts opened and drawn, with beams and reach: all that draws" 65536 -DDRAFTS_TOO
    measure "all that draws, and reports" - -DDRAFTS_TOO $(kept '^aset_report')
    measure "all that draws, and pictures from a stream (flat.h)" - -DDRAFTS_TOO $(kept '^aset_flat')
    measure "all that draws, reports, and pictures from a stream" - -DDRAFTS_TOO $(kept '^aset_(report|flat)')
    measure "all that draws, and baking drafts" - -DDRAFTS_TOO $(kept '^aset_baker')
    measure "every public function but those that bake" - -DDRAFTS_TOO $(kept ^aset_ ^aset_baker)
    measure "every public function but those that bake and beams and reach, by which drafts are drawn faster" 65536 $(kept ^aset_ '^aset_(baker|beams|reach)')
    measure "every public function but beams and reach" - $(kept ^aset_ '^aset_(beams|reach)')
    measure "every public function" - -DDRAFTS_TOO $(kept '^aset_')
    # nothing dropped: every function of the core, and what these ask of libm, libgcc and for mem*
    arm_link="--specs=nano.specs -nostartfiles -Wl,-emain"
    host_link=""
    whole=$(arm m4 "$m4" -DMETHOD=aset_mset)
    soft=$(arm m0 "$m0" -DMETHOD=aset_mset)
    say "| the whole core, nothing dropped | - | $whole | $soft | $(host -DMETHOD=aset_mset) |"
}
if [ -n "$page" ] && [ $has_arm = 1 ]; then
    {
        echo "# What the core weighs"
        echo
        echo "Bytes of code and constants that a program takes which does what the row says, made by \`make size\` with"
        echo "$(arm-none-eabi-gcc -dumpfullversion | sed 's/^/arm-none-eabi-gcc /') and, for x86-64, $(basename "$cc") $("$cc" -dumpfullversion). A switch at 0 leaves its feature out"
        echo "(\`include/aset/config.h\`). A draft keeps large objects, a ground say, exact beside its cells, unless it was baked without them."
        echo
        cat "$out"
        echo
        echo "All: \`-Os -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections -Wl,--gc-sections\`. Cortex-M: .text and"
        echo ".rodata of the whole program with libm, libgcc and \`mem*\` of a few bytes each, without startup and without the draft itself."
        echo
        echo "- Cortex-M4F: \`$m4\`; whole: besides \`$lto\`"
        echo "- Cortex-M0+: \`$m0\`"
        echo "- x86-64: less a program that calls the same library functions and nothing of libaset"
        echo
        echo "\`make size\` fails where, in the first column, the first row reaches 12,288 bytes, exact MSET with polygons 24,576, or one of these 65,536:"
        echo "all that draws; every public function but baking, beams and reach. The rows with more than that are above it: beams and reach take"
        echo "10 kB, baking 16."
        echo
        echo "File by file, for Cortex-M4F and not as a whole, so without what one file's optimizing saves in another:"
        echo
        echo "| file | bytes |"
        echo "|---|---|"
        arm-none-eabi-size "$(objects m4 arm-none-eabi-gcc "$m4")"/*.o | # lib_room_some_noun.c.o
            awk 'NR > 1 { sub(/.*\/lib_/, "lib/", $6); sub(/_/, "/", $6); sub(/\.o$/, "", $6); print $1, $6 }' | sort -k 1,1nr -k 2 |
            awk '{ print "| " $2 " | " $1 " |"; n += $1 } END { print "| all | " n " |" }'
    } > "$page"
fi
exit $bad
