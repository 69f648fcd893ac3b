#!/bin/bash
# The seven methods side by side, as a contact sheet of drafts and as a table of exact pictures: methods.sh ASET DIRECTORY
#
# sheet.png: gears and snow with every ray approximate, from cells of the same finest size (64 divisions, depth 6).
# table.md:  the seven scenes of the SPD and snow at 128 x 128, exact: automatic divisions, depth 6, one object in a leaf;
#            for brute force, what it tests at 32 x 32.
# Counts are the same on every machine. Of RUNS (3) interleaved runs on one thread, build s is the least disturbed one's,
# time the median of each run's ratio of the time to draw to that of mset in the same round.
set -eu
export LC_ALL=C
aset=$1
dir=$2
runs=${RUNS:-3}
side=${SIDE:-240}
methods="mset set grid octree arts excell"
mkdir -p "$dir"

# The first number that the statistics give for a key, of an object (structure, rays ...) if one is named.
figure() { # FILE [OBJECT] KEY
    text=$(cat "$1")
    [ $# -eq 2 ] || text=$(printf '%s' "$text" | sed "s/.*\"$2\":{\([^}]*\)}.*/\1/")
    shift $(($# - 1))
    printf '%s' "$text" | grep -o "\"$1\":[-+0-9.e]*" | head -n 1 | cut -d: -f2
}
# Numbers of the same runs in two files: the median of their ratios.
ratio() { paste "$1" "$2" | awk '$2 > 0 { print $1 / $2 }' | median; }
median() { sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
place() { # METHOD JSON: its divisions or its depth
    case $1 in
    octree | arts | excell) echo "depth 6" ;;
    *) grep -o '"grid":\[[0-9,]*\]' "$2" | head -n 1 | tr -d '"grid:[]' | tr , x ;;
    esac
}

# ---- the sheet ----

decibels() { "$aset" compare --json "$1" "$2" | grep -o '"psnr":[0-9.]*' | cut -d: -f2; }

draft() { # SCENE METHOD: a picture and its label
    set -- "$1" "$2" "$dir/draft-$1-$2"
    curtail=0.5 note=""
    # nearly every ray comes to the one cell from nearer than half its diagonal: all would be trapped
    [ "$2" != brute ] || { curtail=0 && note=", no curtailing"; }
    "$aset" render "$dir/draft-$1.nff" -m "$2" --approx all --approx-depth 0 --grid 64 --octree-depth 6 --curtail $curtail \
        --memory 64M -s "${side}x$side" --quiet -o "$3.png" --stats "$3.json"
    shared=$(figure "$3.json" textures merged)
    [ "$shared" -eq 0 ] || note=", $shared cells share"
    pictures+=("$3.png=$2$note|$(figure "$3.json" memory peak) bytes|$(printf 'density %.2f, %.1f dB' \
        "$(figure "$3.json" density)" "$(decibels "$dir/draft-$1-exact.png" "$3.png")")")
}

pictures=()
for scene in "gears --size 3" snow; do
    name=${scene%% *}
    # shellcheck disable=SC2086
    "$aset" scene $scene -o "$dir/draft-$name.nff"
    "$aset" render "$dir/draft-$name.nff" --memory 64M -s "${side}x$side" --quiet -o "$dir/draft-$name-exact.png"
    pictures+=("$dir/draft-$name-exact.png=$scene, exact")
    for method in brute set mset grid octree arts excell; do
        draft "$name" "$method"
    done
done
"$aset" sheet -o "$dir/sheet.png" --columns 4 --title "Every ray approximate: 64 divisions, depth 6" "${pictures[@]}"

# ---- the table ----

exact() { # SCENE METHOD SIDE: statistics into SCENE-METHOD.json, times added to SCENE-METHOD.build and .render
    "$aset" render "$dir/$1.nff" -m "$2" --octree-depth 6 --leaf 1 --memory 64M -s "$3x$3" --quiet \
        --stats "$dir/$1-$2.json"
    figure "$dir/$1-$2.json" build_s >>"$dir/$1-$2.build"
    figure "$dir/$1-$2.json" render_s >>"$dir/$1-$2.render"
}

row() { # SCENE METHOD
    set -- "$1" "$2" "$dir/$1-$2"
    rays=0
    for kind in primary shadow reflected refracted; do
        rays=$((rays + $(figure "$3.json" rays $kind)))
    done
    figures="$(figure "$3.json" memory peak) $(figure "$3.json" structure nonempty) $(figure "$3.json" density)"
    tests=$(awk -v tests="$(figure "$3.json" tests)" -v rays=$rays 'BEGIN { print tests / rays }')
    # shellcheck disable=SC2086
    if [ "$2" = brute ]; then # a smaller picture, whose cells and times compare with none
        printf '| %s | %s | | %d | %d | %.0f | | %.2f | | |\n' "$1" "$2" $figures "$tests"
    else
        printf '| %s | %s | %s | %d | %d | %.2f | %d | %.2f | %.4f | %.2f |\n' "$1" "$2" "$(place "$2" "$3.json")" $figures \
            "$(figure "$3.json" cells_visited)" "$tests" "$(sort -g "$3.build" | head -n 1)" \
            "$(ratio "$3.render" "$dir/$1-mset.render")"
    fi
}

table() {
    echo "| scene | method | divisions | bytes | non-empty cells | density | cells visited | tests a ray | build s | time |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    for name in balls gears mount rings teapot tetra tree snow; do
        "$aset" scene $name -o "$dir/$name.nff"
        rm -f "$dir/$name"-*.build "$dir/$name"-*.render
        for run in $(seq "$runs"); do
            for method in $methods; do
                exact $name $method 128
            done
        done
        exact $name brute 32
        for method in $methods brute; do
            row $name $method
        done
    done
}

table >"$dir/table.md"
echo "the sheet and the table are in $dir"
