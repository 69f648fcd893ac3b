#!/bin/bash
# One picture by an array of Slurm jobs: each draws a piece of the rows, and a last job, which waits for all of them to have
# done well, joins the pieces to the bytes of the whole.
#
#     bash slurm.sh SCENE OUT.png WIDTHxHEIGHT PIECES [options of aset render]
#
# Run in a folder that all machines share; SBATCH_PARTITION, SBATCH_TIMELIMIT and so on are heard by sbatch itself. If a piece
# fails the last job is never run: no picture, the pieces' logs (slurm-*.out) say why. ASET names the program if it is not in
# the PATH.
set -eu
aset=${ASET:-aset}
if [ $# -lt 4 ]; then
    echo "usage: slurm.sh SCENE OUT.png WIDTHxHEIGHT PIECES [options of aset render]" >&2
    exit 2
fi
scene=$1 out=$2 size=$3 pieces=$4
shift 4
height=${size#*x}
piece() { printf '%s.piece-%05d.png' "$out" "$1"; }

case ${ASET_STEP:-submit} in
submit)
    if [ "$pieces" -gt "$height" ]; then pieces=$height; fi
    array=$(ASET_STEP=draw sbatch --parsable --export=ALL --array=0-$((pieces - 1)) "$0" "$scene" "$out" "$size" "$pieces" "$@")
    ASET_STEP=join sbatch --parsable --export=ALL --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes "$0" \
        "$scene" "$out" "$size" "$pieces" "$@"
    ;;
draw)
    i=$SLURM_ARRAY_TASK_ID
    exec "$aset" render "$scene" -s "$size" "$@" --rows $((height * i / pieces)):$((height * (i + 1) / pieces)) \
        -o "$(piece "$i")" --quiet
    ;;
join)
    list=()
    for i in $(seq 0 $((pieces - 1))); do list+=("$(piece "$i")"); done
    "$aset" join "${list[@]}" -o "$out"
    rm -f "${list[@]}"
    ;;
esac
