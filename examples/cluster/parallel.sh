#!/bin/bash
# One picture by many jobs of GNU parallel, on this machine or (PARALLEL="--sshloginfile FILE --workdir .") on several that
# share the folder: rows are drawn in pieces and joined to the bytes of the whole.
#
#     bash parallel.sh SCENE OUT.png WIDTHxHEIGHT PIECES [options of aset render]
#
# A few pieces for each processor: then a slow one draws fewer. If one fails the others are ended, there is its error line,
# status 1 and no picture. ASET names the program if it is not in the PATH.
set -eu
if [ $# -lt 4 ]; then
    echo "usage: parallel.sh SCENE OUT.png WIDTHxHEIGHT PIECES [options of aset render]" >&2
    exit 2
fi
aset=${ASET:-aset} scene=$1 out=$2 size=$3 pieces=$4
shift 4
height=${size#*x}
if [ "$pieces" -gt "$height" ]; then pieces=$height; fi
folder=$(mktemp -d "$out.pieces.XXXXXX")
trap 'rm -rf "$folder"' EXIT
for i in $(seq 0 $((pieces - 1))); do
    printf '%d:%d\t%s/%05d.png\n' $((height * i / pieces)) $((height * (i + 1) / pieces)) "$folder" "$i"
done >"$folder/list"
parallel --quote --colsep '\t' --halt now,fail=1 \
    "$aset" render "$scene" -s "$size" "$@" --rows '{1}' -o '{2}' --quiet <"$folder/list" 2>"$folder/log" || {
    grep '^aset: ' "$folder/log" >&2 || cat "$folder/log" >&2
    exit 1
}
"$aset" join "$folder"/*.png -o "$out"
