#!/bin/bash
# Takes libaset into other programs in every way that docs/linking.md names, and compares what they draw with the picture of
# examples/smallest.c, byte for byte: run.sh BUILD CC CXX [CONSUMER ...]
# Each consumer's folder is copied, and the library installed or copied beside it, so that nothing is found by chance.
set -eu
ROOT=$PWD
BUILD=$1
CC=$2
CXX=$3
shift 3
case "$BUILD" in /*) ;; *) BUILD=$ROOT/$BUILD ;; esac
work=$BUILD/consumers
EXPECTED=$work/expected.ppm
export ROOT BUILD CC CXX EXPECTED
unset MAKEFLAGS MAKELEVEL MFLAGS
rm -rf "$work"
mkdir -p "$work"
"$BUILD/examples/smallest" > "$EXPECTED" 2> /dev/null
[ $# != 0 ] || set -- $(cd tests/consumers && ls -d */ | tr -d /)

failed=""
for name in "$@"; do
    cp -r "tests/consumers/$name" "$work"
    cp tests/consumers/picture.c tests/consumers/common.sh "$work/$name"
    status=0
    (cd "$work/$name" && cat common.sh build.sh > run.sh && bash run.sh) > "$work/$name.log" 2>&1 || status=$?
    case $status in
    0) echo "consumers: $name: $(grep -c 'draws the same picture$' "$work/$name.log") programs draw the same picture" ;;
    77) echo "consumers: $name: $(tail -n 1 "$work/$name.log")" ;;
    *)
        echo "consumers: $name failed:"
        tail -n 25 "$work/$name.log"
        failed="$failed $name"
        ;;
    esac
done
if [ -n "$failed" ]; then echo "consumers: failed:$failed"; exit 1; fi
