#!/bin/bash
# Are a plan's expectations right? Bytes exactly, PSNR within 3 dB, relative time within 30 %, for scenes at three budgets, and for
# wishes of an error: plan-check.sh ASET DIRECTORY [SCENE.nff ...]; without scenes, the seven SPD scenes at their default sizes.
set -eu
aset=$1
dir=$2
shift 2
mkdir -p "$dir"
if [ $# = 0 ]; then
    for scene in balls gears mount rings teapot tetra tree; do
        "$aset" scene $scene -o "$dir/$scene.nff"
        set -- "$@" "$dir/$scene.nff"
    done
fi
held=0
missed=0
value() { sed -n "s/.*\"$1\":\"\{0,1\}\([a-z0-9.x]*\).*/\1/p" "$2" | head -n 1; }
number() { grep -o "\"$1\":[0-9.]*" "$2" | head -n 1 | cut -d: -f2; }
seconds() { echo "$(number build_s "$1") $(number render_s "$1")" | awk '{ print $1 + $2 }'; }
for scene in "$@"; do
    for wish in "--memory 128K" "--memory 512K" "--memory 2M" "--memory 2M --error 20"; do
        # shellcheck disable=SC2086
        if ! "$aset" plan "$scene" $wish --json > "$dir/plan.json" 2> "$dir/error"; then
            need=$(sed -n 's/.*needs \([0-9]*\) bytes.*/\1/p' "$dir/error")
            if [ -n "$need" ] && "$aset" plan "$scene" --memory "$need" > /dev/null && ! "$aset" plan "$scene" --memory $((need - 1)) \
                > /dev/null 2>&1; then
                held=$((held + 1))
                echo "ok $(basename "$scene") $wish: nothing fits, $need bytes would"
            else
                missed=$((missed + 1))
                echo "not ok $(basename "$scene") $wish: $(cat "$dir/error")"
            fi
            continue
        fi
        words="--method $(value method "$dir/plan.json") --grid $(value grid "$dir/plan.json") --approx $(value approx "$dir/plan.json")"
        words="$words --approx-depth $(value approx_depth "$dir/plan.json")"
        bytes=$(value bytes "$dir/plan.json")
        rm -f "$dir/ratios"
        for _ in 1 2 3; do # interleaved
            "$aset" render "$scene" --memory 64M -o "$dir/exact.png" --stats "$dir/exact.json" --quiet
            # shellcheck disable=SC2086
            "$aset" render "$scene" $words --memory "$bytes" -o "$dir/planned.png" --stats "$dir/planned.json" --quiet
            echo "$(seconds "$dir/planned.json") $(seconds "$dir/exact.json")" | awk '{ print $1 / $2 }' >> "$dir/ratios"
        done
        ratio=$(sort -n "$dir/ratios" | sed -n 2p)
        psnr=$("$aset" compare --json "$dir/exact.png" "$dir/planned.png" | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p')
        verdict=$(echo "$bytes $(number peak "$dir/planned.json") $(value psnr "$dir/plan.json") $psnr $(value relative_time "$dir/plan.json") $ratio" |
            awk '{ t = $5 / $6; d = $3 - $4; print ($1 == $2 && d <= 3 && d >= -3 && t <= 1.3 && t >= 1 / 1.3) ? "ok" : "not ok" }')
        [ "$verdict" = ok ] && held=$((held + 1)) || missed=$((missed + 1))
        echo "$verdict $(basename "$scene") $wish: $words; bytes $bytes, peak $(number peak "$dir/planned.json");" \
            "PSNR expected $(value psnr "$dir/plan.json"), $psnr; time expected $(value relative_time "$dir/plan.json"), $ratio"
    done
done
echo "$held passed, $missed failed"
[ $missed = 0 ]
