#!/bin/bash
# MSET against brute force, byte for byte, at 256 x 256 on the default scenes: long.sh ASET DIRECTORY
set -eu
aset=$1
dir=$2
mkdir -p "$dir"
passed=0
failed=0
for scene in tetra snow mount teapot rings tree balls gears; do
    "$aset" scene "$scene" -o "$dir/$scene.nff"
    for method in mset brute; do
        "$aset" render "$dir/$scene.nff" -m "$method" -s 256x256 -j "${JOBS:-2}" -o "$dir/$scene-$method.ppm" \
            --stats "$dir/$scene-$method.json" --quiet
    done
    number() { grep -o "\"$2\":[0-9]*" "$dir/$scene-$1.json" | head -n 1 | cut -d: -f2; } # the first of that name
    rays() { echo $(($(number "$1" primary) + $(number "$1" shadow) + $(number "$1" reflected) + $(number "$1" refracted))); }
    why=""
    cmp -s "$dir/$scene-mset.ppm" "$dir/$scene-brute.ppm" || why="the pictures differ"
    [ "$(rays mset)" = "$(rays brute)" ] || why="$why; rays differ"
    [ "$(number brute tests)" = $(($(rays brute) * $(number brute objects))) ] || why="$why; brute force tests something else"
    [ "$(number mset tests)" -lt "$(number brute tests)" ] || why="$why; MSET tests no less"
    if [ -z "$why" ]; then
        passed=$((passed + 1))
        echo "ok $scene: equal; tests $(number mset tests) of $(number brute tests)"
    else
        failed=$((failed + 1))
        echo "not ok $scene: $why"
    fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
