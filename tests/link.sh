#!/bin/bash
# What the core asks of the outside, and that a program with other layout switches does not link:
# link.sh BUILD CC [FLAGS]: the library's switches, and sanitizers
set -eu
build=$1
cc=$2
flags=${3:-}
core=$build/libaset.a
dir=$build/link
mkdir -p "$dir"
bad=0

# Undefined symbols: mem*, libm's square root, and what a compiler or a sanitizer adds by itself.
outside=$(nm -u "$core" | awk '$1 == "U" { print $2 }' | sort -u | grep -vE '^(__asan|__ubsan|__stack_chk|__gcov|__tsan|_GLOBAL_OFFSET)' || true)
defined=$(nm "$core" | awk 'NF == 3 && $2 ~ /[TRDB]/ { print $3 }' | sort -u)
for symbol in $(comm -23 <(echo "$outside") <(echo "$defined")); do
    case "$symbol" in
    memcpy | memset | memmove | memcmp | sqrt | sqrtf) ;;
    bcmp) ;; # clang's for a memcmp that asks for equality alone, where the system's library has it
    __cpu_model | __cpu_indicator_init) ;; # ASET_WIDE: of the compiler's library
    *) echo "link: the core asks for $symbol"; bad=1 ;;
    esac
done
# Writable data (tables of pointers that only the loader writes do not count).
writable=$(size -A "$core" | awk '$1 ~ /^\.(data|bss)(\.|$)/ && $1 !~ /^\.data\.rel\.ro/ { n += $2 } END { print n + 0 }')
case "$flags" in
*sanitize* | *coverage*) ;;
*) [ "$writable" = 0 ] || { echo "link: $writable bytes of writable data in the core"; bad=1; } ;;
esac

cat > "$dir/user.c" <<'END'
#include <aset/aset.h>
static ASET_ARENA_BLOCK(block, 64);
int main(void) {
    aset_arena arena;
    return aset_arena_init(&arena, block, sizeof block);
}
END
# shellcheck disable=SC2086
if ! $cc -std=c99 $flags -Iinclude "$dir/user.c" "$core" -lm -o "$dir/user" 2>"$dir/log"; then
    echo "link: a program with the library's own switches does not link:"; cat "$dir/log"; bad=1
fi
# What a program does not name it does not link: archive members alone, no section is dropped.
cat > "$dir/draft.c" <<'END'
#include <aset/aset.h>
int main(void) {
    aset_arena arena = {0};
    aset_draft draft;
    aset_scratch scratch = {0};
    aset_tracer tracer = {.draft = &draft, .scene = &draft.stage, .approx_kinds = ASET_ALL_KINDS};
    aset_picture picture = {0};
    return aset_draft_open(&draft, NULL, 0, &arena, NULL) +
           aset_render_rows(&tracer, &draft.stage.view, &picture, 0, 0, &scratch, NULL);
}
END
cat > "$dir/exact.c" <<'END'
#include <aset/aset.h>
int main(void) {
    aset_arena arena = {0};
    aset_scene scene;
    aset_space space;
    aset_scratch scratch = {0};
    aset_tracer tracer = {.scene = &scene, .space = &space};
    aset_picture picture = {0};
    return aset_scene_init(&scene, &arena, NULL) + aset_space_build(&space, &scene, &aset_mset, NULL, &arena) +
           aset_render_rows(&tracer, &scene.view, &picture, 0, 0, &scratch, NULL);
}
END
without() { # program, what it must have, what it must not
    # shellcheck disable=SC2086
    $cc -std=c99 $flags -Iinclude "$dir/$1.c" "$core" -lm -o "$dir/$1"
    symbols=$(nm "$dir/$1" | awk 'NF == 3 { print $3 }')
    echo "$symbols" | grep -q "^$2\$" || { echo "link: a program for $1 links no $2"; bad=1; }
    alien=$(echo "$symbols" | grep -E "^($3)" || true)
    # shellcheck disable=SC2086
    [ -z "$alien" ] || { echo "link: a program for $1 links" $alien; bad=1; }
}
without draft aset_draft_answers 'exact_|visit_exact|aset_(space|summary|brute|set|mset|grid|octree|arts|excell|baker)|sides_|cells_|slices_|summary_|texture_|baker_|sheet_'
without exact aset_exact_answers 'draft_|aset_(draft|baker|summary)|facet_|summary_|texture_|baker_|sheet_'

other=64
case "$flags" in *-DASET_REAL_BITS=64*) other=32 ;; esac
for switch in ASET_REAL_BITS=$other "ASET_WITH_POLYGONS=0 -DASET_WITH_PATCHES=0" ASET_WITH_PATCHES=0 ASET_WITH_SPHERES=0 \
    ASET_WITH_CONES=0 ASET_WITH_REFLECTION=0 ASET_WITH_REFRACTION=0 ASET_WITH_APPROXIMATION=0 \
    "ASET_WITH_POLYGONS=0 -DASET_WITH_PATCHES=0 -DASET_WITH_SPHERES=0 -DASET_WITH_CONES=0"; do
    base=$flags
    case "$switch" in ASET_REAL_BITS*) base=${flags/-DASET_REAL_BITS=64/} ;; esac
    # shellcheck disable=SC2086
    if $cc -std=c99 $base -D$switch -Iinclude "$dir/user.c" "$core" -lm -o "$dir/user" 2>"$dir/log"; then
        echo "link: a program with -D$switch links with a library without it"
        bad=1
    elif ! grep -q 'aset_arena_init__' "$dir/log"; then
        echo "link: -D$switch fails for another reason:"; cat "$dir/log"; bad=1
    fi
done
[ $bad = 0 ] && echo "link: the core asks for mem* and the square root only; other layout switches do not link; nobody links what it does not name"
exit $bad
