#!/bin/bash
# The program that the README prints is examples/smallest.c, to the letter, and under 60 lines.
set -eu
lines=$(wc -l < examples/smallest.c)
if [ "$lines" -ge 60 ]; then echo "readme: examples/smallest.c has $lines lines, not under 60"; exit 1; fi
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' README.md | diff - examples/smallest.c > /dev/null || {
    echo "readme: the program in README.md differs from examples/smallest.c"
    exit 1
}
echo "readme: its program is examples/smallest.c, $lines lines"
