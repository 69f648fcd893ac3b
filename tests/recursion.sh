#!/bin/bash
# No function of the core calls itself, directly or through others (calls by pointer go downwards by design: a space calls its
# visitor, which calls no space). Needs gcc: recursion.sh BUILD
set -eu
dir=$1/recursion
mkdir -p "$dir"
if ! gcc -fcallgraph-info -x c -c /dev/null -o "$dir/none.o" 2>/dev/null; then
    echo "recursion: skipped, this compiler writes no call graphs"
    exit 0
fi
rm -f "$dir"/*.ci
for file in lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c lib/load/*.c; do
    gcc -std=c99 -O0 -Iinclude -Ilib -fcallgraph-info -c "$file" -o "$dir/$(echo "$file" | tr / _).o"
done
sed -n 's/^edge: { sourcename: "\([^"]*\)" targetname: "\([^"]*\)".*/\1 \2/p' "$dir"/*.ci | grep -v __indirect_call > "$dir/edges"
own=$(awk '$1 == $2' "$dir/edges")
if [ -n "$own" ]; then echo "recursion: $own"; exit 1; fi
if ! tsort "$dir/edges" > /dev/null 2> "$dir/loops"; then
    echo "recursion: a loop of calls:"
    cat "$dir/loops"
    exit 1
fi
echo "recursion: none among $(wc -l < "$dir/edges") calls"
