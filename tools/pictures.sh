#!/bin/bash
# The README's first picture, snow and a skull, each exact and approximate, with bytes and dB: pictures.sh ASET DIRECTORY OUT.png
set -eu
export LC_ALL=C
aset=$1
dir=$2
out=$3
mkdir -p "$dir"
figure() { grep -o "\"$2\":[0-9.]*" "$1" | head -n 1 | cut -d: -f2; }
draw() { # NAME SCENE words of the tool
    local name=$1 scene=$2
    shift 2
    "$aset" render "$dir/$scene" "$@" --quiet -s 256x256 -o "$dir/$name.png" --stats "$dir/$name.json"
}
decibels() { "$aset" compare --json "$dir/$1.png" "$dir/$2.png" > "$dir/$2.compared" && printf '%.1f dB' "$(figure "$dir/$2.compared" psnr)"; }
grouped() { echo "$1" | sed -E ':a; s/([0-9])([0-9]{3})($|,)/\1,\2\3/; ta'; }

"$aset" scene snow -o "$dir/snow.nff"
"$aset" scene skull -o "$dir/skull.nff"
"$aset" bake "$dir/skull.nff" --grid 40 --quiet -o "$dir/skull.draft"
draw snow snow.nff --grid 30
draw snow-aset snow.nff --grid 30 -m aset
draw skull skull.nff
draw skull-draft skull.draft
"$aset" sheet -o "$out" --columns 4 \
    "$dir/snow.png=snow, exact: 813 objects|$(grouped "$(figure "$dir/snow.json" peak)") bytes in all" \
    "$dir/snow-aset.png=second rays approximate|$(grouped "$(figure "$dir/snow-aset.json" peak)") bytes, $(decibels snow snow-aset)" \
    "$dir/skull.png=skull, exact: 203 objects|$(grouped "$(figure "$dir/skull.json" peak)") bytes in all" \
    "$dir/skull-draft.png=its draft, from read-only memory|$(grouped "$(wc -c < "$dir/skull.draft")") bytes, $(decibels skull skull-draft)"
