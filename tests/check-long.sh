#!/bin/bash
# check-long.sh BUILD [STEP ...] - what takes too long for `make test`, each step with its figure at the end; all of them, or those named:
#   matrix      the unit tests by gcc and clang, float and double, -O0, -O2 and -Os (which has ASET_FUSED=0)
#   sanitize    by both compilers with the address and undefined-behaviour sanitizers, float and double
#   memory      clang's memory sanitizer over all pictures of tests/determinism.c and all seeds and kept crashes of the fuzzers
#   hostile     the unit tests and the pictures with tiny limits and an arena that is full of garbage
#   valgrind    the tool, the examples and the seeds of the fuzzers
#   fuzz        seeds and kept crashes, with the sanitizers
#   extremes    make check-extremes, where the Makefile has it
# A step whose compiler or checker is not installed is skipped, and said so. Tests of unit run with ASET_TEST_SEED, if it is set.
set -u
build=$1
shift
steps=${*:-fuzz memory hostile sanitize valgrind matrix extremes}
here=$(dirname "$0")
failed=0
mkdir -p "$build" || exit 1
units=$(cd "$here" && ls test_*.c | sed 's/\.c$//')

say() {
    printf '%-10s %s\n' "$step" "$*"
}

# The unit tests of one build: NAME CC CPPFLAGS CFLAGS
unit_tests() {
    local name=$1 dir=$build/$1 good=0 all=0 bad='' unit
    command -v "$2" >/dev/null || { say "$name: skipped, no $2"; return; }
    # shellcheck disable=SC2086
    if ! make -j2 BUILD="$dir" CC="$2" CPPFLAGS="$3" CFLAGS="$4" $(printf "$dir/tests/%s " $units) >"$build/$name.log" 2>&1; then
        say "$name: does not compile: $(grep -m 1 -E 'error|Error' "$build/$name.log")"
        failed=1
        return
    fi
    for unit in $units; do
        all=$((all + 1))
        if "$dir/tests/$unit" >"$build/$name.$unit.log" 2>&1; then good=$((good + 1)); else bad="$bad $unit"; fi
    done
    [ -z "$bad" ] || failed=1
    say "$name: $good of $all test programs pass${bad:+, not:$bad}"
}

step_matrix() {
    local cc level
    for cc in gcc clang; do
        for level in 0 2 s; do
            unit_tests "$cc-O$level" $cc "" "-O$level -g"
            unit_tests "$cc-O$level-double" $cc "-DASET_REAL_BITS=64" "-O$level -g"
        done
    done
}

step_sanitize() {
    local cc flags="-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all"
    for cc in gcc clang; do
        unit_tests "$cc-sanitize" $cc "" "$flags"
        unit_tests "$cc-sanitize-double" $cc "-DASET_REAL_BITS=64" "$flags"
    done
}

# The libraries, compiled once for a step and a precision: BITS, the compiler and its flags before
libraries() {
    local dir=$build/$step-$1 source
    rm -rf "$dir" && mkdir -p "$dir" || exit 1
    for source in "$here"/../lib/*/*.c; do
        # shellcheck disable=SC2086
        $flags -std=c99 -ffp-contract=off -DASET_REAL_BITS="$1" -I"$here/../include" -I"$here/../lib" -c "$source" \
            -o "$dir/$(basename "$(dirname "$source")")_$(basename "$source" .c).o" >"$dir/log" 2>&1 ||
            { say "$source does not compile: $(grep -m 1 error "$dir/log")"; failed=1; return 1; }
    done
}

# A program of these and one of the tests': NAME BITS FILES
compile() {
    local name=$1 bits=$2
    shift 2
    [ -d "$build/$step-$bits" ] || libraries "$bits" || return 1
    # shellcheck disable=SC2086
    $flags -std=c99 -ffp-contract=off -DASET_REAL_BITS="$bits" -I"$here/../include" -I"$here/../lib" "$@" "$build/$step-$bits"/*.o -lm \
        -o "$build/$name" >"$build/$name.log" 2>&1 || { say "$name: does not compile"; failed=1; return 1; }
}

# Seeds and kept crashes of every fuzzer, each fuzzer a program compiled by flags and run by the words given.
seeds() {
    local bits fuzzer name files n=0 bad=0
    for bits in 32 64; do
        for fuzzer in "$here"/fuzz/fuzz_*.c; do
            name=$(basename "$fuzzer" .c)
            files=$(find "$here/fuzz/corpus/$name" -type f)
            compile "$step-$name-$bits" $bits "$fuzzer" "$here/fuzz/main.c" || continue
            # shellcheck disable=SC2086
            "$@" "$build/$step-$name-$bits" $files >"$build/$step-$name-$bits.log" 2>&1 ||
                { bad=$((bad + 1)); say "$name, $bits bits: $(tail -n 1 "$build/$step-$name-$bits.log")"; }
            n=$((n + $(echo "$files" | wc -l)))
        done
    done
    [ $bad -eq 0 ] || failed=1
    say "$n seeds and kept crashes, float and double: $bad programs of $(ls "$here"/fuzz/fuzz_*.c | wc -l) x 2 fail"
}

pictures() { # the words to run it by
    local bits
    for bits in 32 64; do
        compile "$step-pictures-$bits" $bits "$here/determinism.c" || continue
        if "$@" "$build/$step-pictures-$bits" 255 >"$build/$step-$bits.lines" 2>"$build/$step-$bits.log" &&
            grep "^$bits " "$here/golden/pictures.txt" | cmp -s - "$build/$step-$bits.lines"; then
            say "$(wc -l <"$build/$step-$bits.lines") pictures and lists of $bits bits, as the golden ones"
        else
            failed=1
            say "pictures of $bits bits: $(tail -n 1 "$build/$step-$bits.log")"
        fi
    done
}

step_fuzz() {
    local flags="cc -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all"
    seeds
}

step_memory() {
    local flags="clang -O1 -g -fsanitize=memory -fno-sanitize-recover=all"
    if ! echo 'int main(void) { return 0; }' | clang -fsanitize=memory -x c - -o "$build/probe" 2>/dev/null; then
        say "skipped, no clang with its memory sanitizer"
        return
    fi
    seeds
    pictures
}

# The limits change what is counted, so only that is compared which the tests themselves compare; pictures with usual ones.
step_hostile() {
    local tiny="-DASET_HOSTILE=1 -DASET_LARGE_MAX=1 -DASET_RECENT=2 -DASET_READER_BUFFER=2"
    local flags="cc -O1 -g -DASET_HOSTILE=1"
    unit_tests hostile cc "$tiny" "-O1 -g"
    unit_tests hostile-double cc "$tiny -DASET_REAL_BITS=64" "-O1 -g"
    pictures
}

step_valgrind() {
    local flags="cc -O1 -g"
    command -v valgrind >/dev/null || { say "skipped, no valgrind"; return; }
    if make BUILD="$build/valgrind" CFLAGS="-O1 -g" check-valgrind >"$build/valgrind.log" 2>&1; then
        say "$(tail -n 1 "$build/valgrind.log")"
    else
        failed=1
        say "the tool: $(tail -n 1 "$build/valgrind.log")"
    fi
    seeds valgrind -q --error-exitcode=9 --leak-check=full
}

step_extremes() {
    grep -q '^check-extremes:' "$here/../Makefile" || { say "skipped, there is no make check-extremes"; return; }
    make BUILD="$build/extremes" check-extremes || failed=1
}

for step in $steps; do
    rm -rf "$build/$step-32" "$build/$step-64"
    step_$step || failed=1
done
[ $failed = 0 ] && echo "check-long: all of it passes" || echo "check-long: FAILED"
exit $failed
