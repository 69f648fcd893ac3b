#!/bin/bash
# Bytes of machine code and data of the core, whole and by feature: size.sh CC DIRECTORY
set -eu
cc=$1
dir=$2
mkdir -p "$dir"
measure() { # label, switches: sums text and data of the objects that a renderer of that set links
    label=$1
    shift
    rm -f "$dir"/*.o
    for file in lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c; do
        "$cc" -std=c99 -Os -ffp-contract=off -fno-asynchronous-unwind-tables -Iinclude -Ilib "$@" -c "$file" \
            -o "$dir/$(basename "$file" .c).o"
    done
    size "$dir"/*.o | awk -v label="$label" 'NR > 1 { text += $1; data += $2 + $3 } END {
        printf "%-58s %7d bytes of code, %d of data\n", label, text, data }'
}
all="-DASET_WITH_POLYGONS=1"
measure "everything" $all
measure "without cones" -DASET_WITH_CONES=0
measure "without cones, patches" -DASET_WITH_CONES=0 -DASET_WITH_PATCHES=0
measure "without refraction" -DASET_WITH_REFRACTION=0
measure "without reflection, refraction" -DASET_WITH_REFRACTION=0 -DASET_WITH_REFLECTION=0
measure "without the approximation" -DASET_WITH_APPROXIMATION=0
measure "polygons only, no reflection, refraction" -DASET_WITH_PATCHES=0 -DASET_WITH_SPHERES=0 -DASET_WITH_CONES=0 \
    -DASET_WITH_REFRACTION=0 -DASET_WITH_REFLECTION=0
measure "polygons only, exact only, no reflection, refraction" -DASET_WITH_PATCHES=0 -DASET_WITH_SPHERES=0 -DASET_WITH_CONES=0 \
    -DASET_WITH_REFRACTION=0 -DASET_WITH_REFLECTION=0 -DASET_WITH_APPROXIMATION=0
measure "spheres only, exact only, no reflection, refraction" -DASET_WITH_POLYGONS=0 -DASET_WITH_PATCHES=0 -DASET_WITH_CONES=0 \
    -DASET_WITH_REFRACTION=0 -DASET_WITH_REFLECTION=0 -DASET_WITH_APPROXIMATION=0
