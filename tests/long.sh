#!/bin/bash
# Every method against brute force, byte for byte, at 256 x 256 on the default scenes: long.sh ASET DIRECTORY
set -eu
aset=$1
dir=$2
mkdir -p "$dir"
passed=0
failed=0
for scene in tetra snow mount teapot rings tree balls gears; do
    "$aset" scene "$scene" -o "$dir/$scene.nff"
    methods=${METHODS:-set mset grid octree arts excell}
    for method in brute $methods; do
        "$aset" render "$dir/$scene.nff" -m "$method" -s 256x256 -j "${JOBS:-2}" -o "$dir/$scene-$method.ppm" \
            --stats "$dir/$scene-$method.json" --memory 64M --quiet
    done
    number() { grep -o "\"$2\":[0-9]*" "$dir/$scene-$1.json" | head -n 1 | cut -d: -f2; } # the first of that name
    rays() { echo $(($(number "$1" primary) + $(number "$1" shadow) + $(number "$1" reflected) + $(number "$1" refracted))); }
    why=""
    [ "$(number brute tests)" = $(($(rays brute) * $(number brute objects))) ] || why="brute force tests something else; "
    counts=""
    for method in $methods; do
        cmp -s "$dir/$scene-$method.ppm" "$dir/$scene-brute.ppm" || why="$why$method draws another picture; "
        [ "$(rays "$method")" = "$(rays brute)" ] || why="$why$method sends other rays; "
        [ "$(number "$method" tests)" -lt "$(number brute tests)" ] || why="$why$method tests no less; "
        counts="$counts, $method $(number "$method" tests)"
    done
    if [ -z "$why" ]; then
        passed=$((passed + 1))
        echo "ok $scene: equal; tests: brute $(number brute tests)$counts"
    else
        failed=$((failed + 1))
        echo "not ok $scene: $why"
    fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
