#!/bin/bash
# Who may include whom: a file includes its own room and the rooms before it; load and procedural see the public headers and
# their own room only; tools and examples see the public headers and their own.
set -eu
rooms="base scene space approx trace"
bad=0
fail() { echo "layers: $1"; bad=1; }
allowed=""
for room in $rooms; do
    allowed="$allowed $room"
    for file in lib/"$room"/*.[ch]; do
        for include in $(sed -n 's/^#include "\(.*\)"/\1/p' "$file"); do
            case " aset$allowed " in
            *" ${include%%/*} "*) ;;
            *) fail "$file includes $include, which is a later room's" ;;
            esac
        done
    done
done
for room in load procedural; do
    for file in lib/"$room"/*.[ch]; do
        for include in $(sed -n 's/^#include "\(.*\)"/\1/p' "$file"); do
            case "$include" in
            aset/load.h | aset/procedural.h | aset/scene.h | aset/types.h | aset/config.h | "$room"/*) ;;
            aset/*) fail "$file includes $include: a source knows no space" ;;
            */*) fail "$file includes $include, which is another room's" ;;
            esac
        done
    done
done
for file in tools/*.[ch] examples/*.[ch] examples/*/*.[ch]; do
    [ -e "$file" ] || continue
    for include in $(sed -n 's/^#include ["<]\(.*\)[">]/\1/p' "$file"); do
        case "$include" in
        base/* | scene/* | space/* | approx/* | trace/* | load/* | procedural/*) fail "$file includes $include, which is private" ;;
        esac
    done
done
for method in lib/space/brute.c lib/space/mset.c; do
    if grep -q '#include "approx' "$method"; then fail "$method knows of the approximation"; fi
done
[ $bad = 0 ] && echo "layers: every file includes only what stands before it"
exit $bad
