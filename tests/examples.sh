#!/bin/bash
# Every example runs and draws the picture that it drew before: examples.sh ASET DIRECTORY [golden]
#
# The pixels of each picture, as a PPM whose cksum stands in golden/examples.txt behind the bits of a real number: so an
# example cannot change unnoticed, whatever compiled it. Examples without a line there are a failure; planned.c, which needs
# a plan's header, has tests/plan.sh. With golden, writes this build's lines anew: after a change that means to change pictures.
set -u
aset=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
examples=$(cd "$2" && pwd)
golden=$PWD/tests/golden/examples.txt
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0
fail() {
    echo "examples: $*"
    bad=1
}

# Doubles have records of another size.
"$aset" scene balls --size 1 -o balls.nff && "$aset" render balls.nff -s 8x8 --stats stats.json || exit 1
bits=32
grep -q '"scratch":160' stats.json || bits=64

for program in "$examples"/*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    name=$(basename "$program")
    mkdir "$name"
    (cd "$name" && "$program" . >out.ppm 2>said) || fail "$name: status $?: $(tail -n 1 "$name/said")"
    # a picture on standard output, or files
    head -c 2 "$name/out.ppm" | grep -q P6 || rm "$name/out.ppm"
    for picture in "$name"/*.png "$name"/*.ppm; do
        [ -e "$picture" ] || continue
        "$aset" join "$picture" -o whole.ppm || fail "$picture is no picture"
        echo "$bits $picture $(cksum <whole.ppm)" >>seen
    done
    grep -q " $name/" seen || fail "$name draws no picture"
done
if [ "${3:-}" = golden ]; then
    { grep -v "^$bits " "$golden" 2>/dev/null; cat seen; } | sort >new && cp new "$golden"
    exit
fi
grep "^$bits " "$golden" | sort >expected
sort seen | diff expected - >difference || fail "other pictures than before: $(tr '\n' ' ' <difference)"
[ $bad = 0 ] && echo "examples: $(cut -d ' ' -f 2 seen | cut -d / -f 1 | sort -u | wc -l) programs, $(wc -l <seen) pictures, as before"
exit $bad
