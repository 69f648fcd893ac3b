#!/bin/bash
# What bench times, in instructions counted by callgrind: the same on every run, whatever else the machine does.
#
# bench --once does each piece of work in one call of bench_pass; callgrind counts within it alone and writes its sum after
# each call, so the k-th sum is the k-th line that bench prints. The bare loop's instructions a ray are taken off.
# bench-instructions.sh BENCH DIRECTORY [NAME[:SIZE] ...]
set -eu
export LC_ALL=C
bench=$1
dir=$2
shift 2
[ $# -gt 0 ] || set -- balls:3 gears:2 gears:4 mount:6 rings:3 teapot:6 tetra:6 tree:8 snow
side=${SIDE:-64} random=${RANDOM_RAYS:-2000} brute=${BRUTE_RAYS:-30}
if ! command -v valgrind >/dev/null 2>&1; then
    echo "bench-instructions: valgrind is not here, so no instructions are counted"
    exit 0
fi
mkdir -p "$dir"

echo "Instructions a ray, without the loop around them; a build in thousands. Eye rays of $side x $side, their shadow rays,"
echo "$random random rays, about $brute of each for brute force. In brackets: over mset's exact ones."
for scene in "$@"; do
    rm -f "$dir"/callgrind.*
    if ! valgrind --tool=callgrind --toggle-collect=bench_pass --dump-after=bench_pass \
        --callgrind-out-file="$dir/callgrind" "$bench" --once --side "$side" --random "$random" --brute "$brute" \
        "$scene" >"$dir/passes" 2>"$dir/errors"; then
        cat "$dir/errors" >&2
        exit 1
    fi
    passes=$(wc -l <"$dir/passes")
    [ "$passes" -gt 0 ] || continue # left out, as bench said
    for k in $(seq "$passes"); do
        sed -n 's/^\(totals\|summary\): \([0-9]*\).*/\2/p' "$dir/callgrind.$k" | head -n 1
    done >"$dir/sums"
    if [ "$(wc -l <"$dir/sums")" -ne "$passes" ]; then
        echo "bench-instructions: callgrind wrote $(wc -l <"$dir/sums") sums for $passes passes; was bench stripped?" >&2
        exit 1
    fi
    paste -d '|' "$dir/passes" "$dir/sums" | awk -F '|' '
        $2 == "loop" { bare = $4 > 0 ? $5 / $4 : 0; print ""; print "### " $1; print ""
            print "| method | build, thousands | eye, closest | shadow, any | random, closest | random, any |"
            print "|---|---|---|---|---|---|"; next }
        { value = $3 == "build" ? $5 / 1000 : $4 > 0 ? $5 / $4 - bare : 0
          if ($2 == "mset") base[$3] = value
          cell = $3 != "build" && $4 == 0 ? "" : sprintf("%.0f (%.2f)", value, base[$3] > 0 ? value / base[$3] : 0)
          line = ($3 == "build" ? "| " $2 : line) " | " cell
          if ($3 == "random, any") print line " |" }'
done
