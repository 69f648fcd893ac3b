#!/bin/bash
# The README's price list: bytes, time and error of exact and approximate pictures: prices.sh ASET DIRECTORY
# Bytes are the least that will do, and times are taken with these.
# Times are ratios to the exact picture's, build and drawing, medians of interleaved runs on one thread.
set -eu
export LC_ALL=C # numbers with a point
aset=$1
dir=$2
runs=${RUNS:-5}
mkdir -p "$dir"
number() { sed -n "s/.*\"$2\":\([0-9.]*\).*/\1/p" "$1"; }
seconds() { echo "$(number "$1" build_s) $(number "$1" render_s)" | awk '{ print $1 + $2 }'; }
median() { sort -n | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
echo "| scene, divisions | drawn | bytes | time | PSNR |"
echo "|---|---|---|---|---|"
for row in "snow 100" "snow 30" "gears 48" "tetra 64"; do
    # shellcheck disable=SC2086
    set -- $row
    scene=$1
    grid=$2
    "$aset" scene "$scene" -o "$dir/$scene.nff"
    least() { # words: the bytes that render asks for
        "$aset" render "$dir/$scene.nff" "$@" --grid "$grid" --memory 1 2>&1 | sed -n 's/.* needs \([0-9]*\) bytes.*/\1/p'
    }
    ways="exact:-m,mset aset:-m,aset draft:-m,aset,--approx-depth,0 planes:-m,aset,--approx-depth,0,--cells,plane"
    rm -f "$dir"/*.times
    for run in $(seq "$runs"); do
        for way in $ways; do
            name=${way%%:*}
            words=$(echo "${way#*:}" | tr ',' ' ')
            # shellcheck disable=SC2046,SC2086
            "$aset" render "$dir/$scene.nff" $words --grid "$grid" --memory $(least $words) -o "$dir/$scene-$name.png" \
                --stats "$dir/$name.json" --quiet
            seconds "$dir/$name.json" >> "$dir/$name.times"
        done
    done
    exact=$(median < "$dir/exact.times")
    for way in $ways; do
        name=${way%%:*}
        case $name in
        exact) label="exact (MSET)" ;;
        aset) label="approximate from the second ray on" ;;
        draft) label="everything approximate" ;;
        *) label="everything, as a draft of planes" ;;
        esac
        db=$("$aset" compare --json "$dir/$scene-exact.png" "$dir/$scene-$name.png" | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p')
        [ $name = exact ] && db="" || db="$(printf %.1f "$db") dB"
        printf '| %s, %s | %s | %s | %.2f | %s |\n' "$scene" "$grid" "$label" "$(number "$dir/$name.json" peak)" \
            "$(echo "$(median < "$dir/$name.times") $exact" | awk '{ print $1 / $2 }')" "$db"
    done
done
