#!/bin/bash
# The demo's programs, at small sizes, under valgrind: valgrind.sh BUILD
set -eu
build=$1
dir=$build/valgrind
mkdir -p "$dir"
run() { valgrind -q --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite "$@"; }
for scene in gears tetra snow; do
    size=""
    case $scene in gears) size="--size 2" ;; tetra) size="--size 5" ;; esac
    # shellcheck disable=SC2086
    run "$build/aset" scene $scene $size -o "$dir/$scene.nff"
    for words in "-m mset" "-m aset" "-m aset --approx-depth 0" "--approx shadow --approx-depth 0 -j 2" "--rules spd"; do
        # shellcheck disable=SC2086
        run "$build/aset" render "$dir/$scene.nff" $words -s 64x64 --grid 20 -o "$dir/$scene.png" --quiet
    done
done
run "$build/examples/smallest" > "$dir/smallest.ppm" 2> /dev/null
echo "valgrind: clean"
