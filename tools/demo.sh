#!/bin/bash
# Draws gears, tetra and snow, exactly and approximately, and shows what each took: demo.sh ASET DIRECTORY
set -eu
aset=$1
out=$2
mkdir -p "$out"
draw() { # name, then the words of aset render
    name=$1
    shift
    echo "== $name.png: aset render $*"
    "$aset" render "$@" -o "$out/$name.png" --report --quiet
    echo
}
for scene in gears tetra snow; do
    "$aset" scene "$scene" -o "$out/$scene.nff"
done
draw gears-exact "$out/gears.nff" --grid 48 -j 2
draw gears-aset "$out/gears.nff" -m aset --grid 48 -j 2
draw gears-draft "$out/gears.nff" -m aset --approx-depth 0 --grid 48 -j 2
draw tetra-exact "$out/tetra.nff" --grid 64 -j 2
draw tetra-draft "$out/tetra.nff" -m aset --approx-depth 0 --grid 64 -j 2
draw snow-exact "$out/snow.nff" --grid 100 -j 2
draw snow-aset "$out/snow.nff" -m aset --grid 100 -j 2
draw snow-shadows "$out/snow.nff" --approx shadow --approx-depth 0 --grid 100 -j 2
draw snow-draft "$out/snow.nff" -m aset --approx-depth 0 --grid 100 -j 2
echo "the pictures are in $out"
