#!/bin/bash
# Are a plan's expectations right? Bytes exactly, PSNR within 3 dB, relative time within 30 %, the plan itself in under two
# seconds, for scenes at three budgets, and with an error asked for; where nothing fits, the bytes told are enough and one
# less is not.
#     plan-check.sh ASET DIRECTORY [SCENE.nff ...]
# Without scenes: the seven SPD scenes at their default sizes, and three with odd sizes (odd-scenes.sh).
#
# Times are wall clock, exact and planned by turns; the median of the turns' ratios counts, for a busy machine slows both down.
# Three turns, or for short ones as many as take two seconds; where that is out of bounds, up to fifteen, with the same bounds.
set -eu
export LC_ALL=C # numbers with a point
aset=$1
dir=$2
shift 2
mkdir -p "$dir"
if [ $# = 0 ]; then
    for scene in balls gears mount rings teapot tetra tree; do
        "$aset" scene $scene -o "$dir/$scene.nff"
        set -- "$@" "$dir/$scene.nff"
    done
    bash "$(dirname "$0")/odd-scenes.sh" "$dir"
    set -- "$@" "$dir/cluster.nff" "$dir/corridor.nff" "$dir/field.nff"
fi
held=0
missed=0
value() { sed -n "s/.*\"$1\":\"\{0,1\}\([a-z0-9.x]*\).*/\1/p" "$2" | head -n 1; }
number() { grep -o "\"$1\":[0-9.]*" "$2" | head -n 1 | cut -d: -f2; }
seconds() { echo "$(number build_s "$1") $(number render_s "$1")" | awk '{ print $1 + $2 }'; }
true_that() { awk "BEGIN { exit !($1) }"; }
tell() { # verdict, text
    if [ "$1" = ok ]; then held=$((held + 1)); else missed=$((missed + 1)); fi
    echo "$1 $2"
}

# Plans: words in $words, what is expected in plan.json, the time taken in $took. False where there is no plan.
plan() { # scene, wish
    began=$(date +%s.%N)
    # shellcheck disable=SC2086
    "$aset" plan "$1" $2 --json > "$dir/plan.json" 2> "$dir/error" || return 1
    took=$(date +%s.%N | awk -v began="$began" '{ printf "%.2f", $1 - began }')
    words="--method $(value method "$dir/plan.json") --grid $(value grid "$dir/plan.json") --approx $(value approx "$dir/plan.json")"
    words="$words --approx-depth $(value approx_depth "$dir/plan.json")"
}

# Nothing fits: are the bytes told enough, for a plan and for a small picture drawn by it, and is one less not?
check_need() { # scene, wish
    need=$(sed -n 's/.*needs \([0-9]*\) bytes.*/\1/p' "$dir/error")
    [ -n "$need" ] || cat "$dir/error"
    verdict="not ok"
    # shellcheck disable=SC2086
    if [ -n "$need" ] && [ "$need" -gt "$(number memory "$dir/wish")" ] && plan "$1" "--memory $need" &&
        "$aset" render "$1" $words --memory "$need" --size 8x8 --quiet && true_that "$took < 2" &&
        ! "$aset" plan "$1" --memory $((need - 1)) > /dev/null 2>&1; then
        verdict=ok
    fi
    tell "$verdict" "$(basename "$1") $2: nothing fits, $need bytes would, planned in ${took:-?} s"
}

turn() { # scene: once exact, once as planned
    "$aset" render "$1" --memory 64M -o "$dir/exact.png" --stats "$dir/exact.json" --quiet
    # shellcheck disable=SC2086
    "$aset" render "$1" $words --memory "$bytes" -o "$dir/planned.png" --stats "$dir/planned.json" --quiet
    echo "$(seconds "$dir/planned.json") $(seconds "$dir/exact.json")" >> "$dir/turns"
    turns=$(wc -l < "$dir/turns")
    ratio=$(awk '{ printf "%.4f\n", $1 / $2 }' "$dir/turns" | sort -g | sed -n $(((turns + 1) / 2))p)
    total=$(awk '{ s += $1 + $2 } END { print s }' "$dir/turns")
}

within_time() { true_that "$expected <= 1.3 * $ratio && $ratio <= 1.3 * $expected"; }

check_plan() { # scene, wish
    bytes=$(value bytes "$dir/plan.json")
    expected=$(value relative_time "$dir/plan.json")
    expected_psnr=$(value psnr "$dir/plan.json")
    spent=$took
    rm -f "$dir/turns"
    turn "$1"
    while [ "$turns" -lt 3 ] || { [ "$turns" -lt 15 ] && { true_that "$total < 2" || ! within_time; }; }; do
        turn "$1"
    done
    psnr=$("$aset" compare --json "$dir/exact.png" "$dir/planned.png" | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p')
    peak=$(number peak "$dir/planned.json")
    verdict="not ok"
    if [ "$bytes" = "$peak" ] && [ "$bytes" -le "$(number memory "$dir/wish")" ] && true_that "$spent < 2" &&
        true_that "$psnr - $expected_psnr <= 3 && $expected_psnr - $psnr <= 3" &&
        within_time; then
        verdict=ok
    fi
    tell "$verdict" "$(basename "$1") $2: $words; bytes $bytes, peak $peak; PSNR expected $expected_psnr, $(printf %.2f "$psnr");\
 time expected $expected, $ratio ($turns turns); planned in $spent s"
}

for scene in "$@"; do
    for wish in "--memory 128K" "--memory 512K" "--memory 2M" "--memory 2M --error 20"; do
        echo "$wish" | sed 's/--memory \([0-9]*\)\([KM]\).*/\1 \2/' |
            awk '{ printf "\"memory\":%d\n", $1 * ($2 == "K" ? 1024 : 1048576) }' > "$dir/wish"
        if plan "$scene" "$wish"; then check_plan "$scene" "$wish"; else check_need "$scene" "$wish"; fi
    done
done
echo "plan-check: $held held, $missed missed"
[ $missed = 0 ]
