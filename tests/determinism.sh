#!/bin/bash
# The same bytes everywhere: tests/determinism.c, built for every compiler and machine at hand, against golden/pictures.txt.
#   determinism.sh quick PROGRAM     the program as it is built already (make test)
#   determinism.sh all ASET DIRECTORY [MACHINE]   every machine, or the one of that name; threads by the tool
#   determinism.sh golden PROGRAM32 PROGRAM64     writes the golden file anew: after a change that means to change pictures
# Promised for -ffp-contract=off and arithmetic in the type's own precision (FLT_EVAL_METHOD 0). Two compilers want more:
# GCC 12's vectorizer of straight code fuses a * b +- c * d in pairs (vfmaddsub) whatever -ffp-contract says, hence
# -fno-tree-slp-vectorize; and GCC for s390x takes -std=c99 to mean float arithmetic in double, hence there
# -fexcess-precision=fast.
set -u
here=$(dirname "$0")
golden=$here/golden/pictures.txt
strict="-std=c99 -Wall -Wextra -pedantic -ffp-contract=off -fno-tree-slp-vectorize -Iinclude"
passed=0
failed=0
skipped=0

# A program's lines, in a file, against those of the same precision: NAME FILE BITS
compare() {
    grep "^$3 " "$golden" > "$2.golden"
    case "$1" in
    i686*-double) # its ABI aligns doubles in structs to 4 bytes, so bytes differ: left out
        sed -i 's/ [0-9]*$//' "$2" "$2.golden" ;;
    esac
    if [ -s "$2.golden" ] && cmp -s "$2" "$2.golden"; then
        passed=$((passed + 1))
        printf 'same     %-26s %s lines\n' "$1" "$(wc -l < "$2")"
        return
    fi
    failed=$((failed + 1))
    printf 'DIFFERS  %-26s %s of %s lines; golden (<) and this (>), first ones:\n' "$1" \
        "$(diff "$2.golden" "$2" | grep -c '^<')" "$(wc -l < "$2.golden")"
    diff "$2.golden" "$2" | grep '^[<>]' | sort -s -k 3,3 | head -n 12
}

skip() { # NAME WHY
    skipped=$((skipped + 1))
    printf 'skipped  %-26s %s\n' "$1" "$2"
}

finish() {
    echo "determinism: $passed the same, $failed differ, $skipped skipped"
    [ "$failed" = 0 ] && [ "$passed" != 0 ]
    exit
}

# --- building and running for one machine: NAME BITS RUNNER COMPILER FLAG ...; RUNNER "" for the machine itself ---

only=
fill=0
machine() {
    local name=$1 bits=$2 runner=$3 cc=$4 out
    shift 4
    out=$dir/$name
    if [ -n "$only" ] && [ "$only" != "$name" ]; then return; fi
    if ! command -v "$cc" > /dev/null; then skip "$name" "no $cc"; return; fi
    if [ -n "$runner" ] && ! command -v "$runner" > /dev/null; then skip "$name" "no $runner"; return; fi
    if ! printf '#include <math.h>\nint main(int n, char **v) { return v == 0 ? (int)sqrt(n) : 0; }\n' |
        "$cc" "$@" -x c - -o "$out.probe" -lm 2> "$out.log"; then
        skip "$name" "$cc $* makes no program: $(head -n 1 "$out.log")"
        return
    fi
    if ! $runner "$out.probe" 2> "$out.log"; then skip "$name" "its programs do not run: $(tail -n 1 "$out.log")"; return; fi
    # shellcheck disable=SC2086
    if ! "$cc" $strict "$@" -DASET_REAL_BITS="$bits" -Ilib "$here/determinism.c" lib/*/*.c -o "$out.program" -lm \
        2> "$out.log"; then
        failed=$((failed + 1))
        echo "FAILS    $name: $(grep -m 1 error "$out.log" || head -n 1 "$out.log")"
        return
    fi
    fill=$(((fill + 89) % 256)) # another garbage in the arena each time
    if $runner "$out.program" "$fill" > "$out.txt" 2> "$out.log"; then
        compare "$name" "$out.txt" "$bits"
    else
        failed=$((failed + 1))
        echo "FAILS    $name: $(tail -n 1 "$out.log")"
    fi
}

# Compilers that must refuse: NAME COMPILER FLAG ...
refused() {
    local name=$1 cc=$2
    shift 2
    if [ -n "$only" ] && [ "$only" != "$name" ]; then return; fi
    if ! echo 'typedef int t;' | "$cc" "$@" -x c -c - -o "$dir/$name.o" 2> /dev/null; then
        skip "$name" "no $cc $*"
    # shellcheck disable=SC2086
    elif "$cc" $strict "$@" -Ilib -c lib/base/real.c -o "$dir/$name.o" 2> "$dir/$name.log"; then
        failed=$((failed + 1))
        echo "FAILS    $name: $cc $* is taken, and its pictures would differ"
    elif grep -q 'error: #error' "$dir/$name.log"; then
        passed=$((passed + 1))
        printf 'refused  %-26s %s\n' "$name" "$cc $*"
    else
        skip "$name" "$(grep -m 1 error "$dir/$name.log")"
    fi
}

# What a compiler's macros do not show is seen when the program starts: NAME COMPILER FLAG ..., after -ffp-contract=off
stopped() {
    local name=$1 cc=$2
    shift 2
    if [ -n "$only" ] && [ "$only" != "$name" ]; then return; fi
    if ! command -v "$cc" > /dev/null; then skip "$name" "no $cc"; return; fi
    if ! grep -qw fma /proc/cpuinfo 2> /dev/null; then skip "$name" "this processor fuses nothing"; return; fi
    # shellcheck disable=SC2086
    if ! "$cc" $strict "$@" -Ilib "$here/determinism.c" lib/*/*.c -o "$dir/$name.program" -lm 2> "$dir/$name.log"; then
        skip "$name" "$(head -n 1 "$dir/$name.log")"
    elif "$dir/$name.program" > /dev/null 2> "$dir/$name.log"; then
        failed=$((failed + 1))
        echo "FAILS    $name: $cc $* runs, and its pictures may differ"
    elif grep -q 'rounded as libaset needs' "$dir/$name.log"; then
        passed=$((passed + 1))
        printf 'stopped  %-26s %s\n' "$name" "$cc $*"
    else
        failed=$((failed + 1))
        echo "FAILS    $name: $(tail -n 1 "$dir/$name.log")"
    fi
}

machines() {
    local bits suffix level
    for bits in 32 64; do
        suffix=
        [ $bits = 64 ] && suffix=-double
        for level in 0 1 2 3 s; do machine gcc-O$level$suffix $bits "" gcc -O$level; done
        for level in 0 2 3; do machine clang-O$level$suffix $bits "" clang -O$level; done
        # Without what is compiled a second time for AVX2; the others take it where the machine has that.
        machine gcc-O2-narrow$suffix $bits "" gcc -O2 -DASET_WIDE=0
        # The processor's own instructions, fused multiply-add among them, which -ffp-contract=off must keep out.
        machine gcc-O3-native$suffix $bits "" gcc -O3 -march=native
        machine clang-O3-native$suffix $bits "" clang -O3 -march=native
        if gcc -m32 -x c -c /dev/null -o /dev/null 2> /dev/null && echo 'int main(void) { return 0; }' |
            gcc -m32 -x c - -o "$dir/m32" 2> /dev/null; then
            machine i686-sse2$suffix $bits "" gcc -m32 -O2 -msse2 -mfpmath=sse
        elif command -v qemu-i386 > /dev/null; then
            machine i686-sse2$suffix $bits qemu-i386 i686-linux-gnu-gcc -static -O2 -msse2 -mfpmath=sse
        else
            machine i686-sse2$suffix $bits "" i686-linux-gnu-gcc -static -O2 -msse2 -mfpmath=sse
        fi
        machine aarch64$suffix $bits qemu-aarch64 aarch64-linux-gnu-gcc -static -O2
        machine armhf$suffix $bits qemu-arm arm-linux-gnueabihf-gcc -static -O2
        machine armhf-Os$suffix $bits qemu-arm arm-linux-gnueabihf-gcc -static -Os -mthumb
        machine armhf-neon$suffix $bits qemu-arm arm-linux-gnueabihf-gcc -static -O3 -mfpu=neon-vfpv4
        machine s390x-big-endian$suffix $bits qemu-s390x s390x-linux-gnu-gcc -static -O2 -fexcess-precision=fast
    done
    refused x87 gcc -m32 -march=i686 -mfpmath=387
    refused x87-cross i686-linux-gnu-gcc -march=i686 -mfpmath=387
    refused s390x-float-in-double s390x-linux-gnu-gcc -O2 -fexcess-precision=standard
    refused fast-math gcc -O2 -ffast-math
    stopped fused-gcc gcc -O2 -mfma -ffp-contract=fast
    stopped fused-clang clang -O2 -mfma -ffp-contract=fast
}

# --- threads: the tool's picture and counts with 1, 2 and 8 ---

threads() { # ASET
    local aset=$1 scene words j
    if [ -n "$only" ]; then return; fi
    for scene in gears snow; do
        "$aset" scene $scene --size 1 | sed 's/^resolution .*/resolution 96 96/' > "$dir/$scene.nff"
        for words in "" "--approx all --approx-depth 1" "--approx all --approx-depth 0 --cells plane" \
            "--method octree --samples 4"; do
            for j in 1 2 8; do
                # shellcheck disable=SC2086
                "$aset" render "$dir/$scene.nff" $words --grid 24 --quiet -j $j -o "$dir/$j.ppm" --stats "$dir/$j.json" \
                    2> "$dir/log" || echo "$scene $words -j $j fails: $(tail -n 1 "$dir/log")" > "$dir/$j.ppm"
                # Seconds differ, and each thread has a scratch of its own.
                grep -o '"\(scene\|structure\|rays\|work\|textures\)":{[^}]*}' "$dir/$j.json" > "$dir/$j.counts"
            done
            if cmp -s "$dir/1.ppm" "$dir/2.ppm" && cmp -s "$dir/1.ppm" "$dir/8.ppm" && [ -s "$dir/1.counts" ] &&
                cmp -s "$dir/1.counts" "$dir/2.counts" && cmp -s "$dir/1.counts" "$dir/8.counts" &&
                ! grep -q fails "$dir/1.ppm"; then
                passed=$((passed + 1))
                printf 'same     %-26s %s\n' threads-1-2-8 "$scene $words"
            else
                failed=$((failed + 1))
                echo "DIFFERS  threads-1-2-8: $scene $words $(grep -ah fails "$dir"/[128].ppm)"
            fi
        done
    done
}

case "${1:-}" in
quick)
    dir=$(mktemp -d)
    trap 'rm -rf "$dir"' EXIT
    "$2" 255 > "$dir/lines" || { echo "determinism: $2 fails"; exit 1; }
    compare "$(basename "$2")" "$dir/lines" "$(head -n 1 "$dir/lines" | cut -d ' ' -f 1)"
    finish
    ;;
all)
    dir=$3
    only=${4:-}
    mkdir -p "$dir"
    machines
    threads "$2"
    finish
    ;;
golden)
    mkdir -p "$here/golden"
    { "$2" && "$3"; } > "$golden.new" && mv "$golden.new" "$golden" && wc -l "$golden"
    ;;
*)
    echo "determinism.sh quick PROGRAM | all ASET DIRECTORY [MACHINE] | golden PROGRAM32 PROGRAM64" >&2
    exit 2
    ;;
esac
