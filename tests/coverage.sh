#!/bin/bash
# coverage.sh BUILD - branches of the core that the tests take, by gcov; BUILD was compiled with --coverage, and its tests have run.
# Prints each file's share, then every branch that no test takes and tests/coverage.txt does not name; fails if less than 95 % of all
# branches are taken. coverage.txt has a line for each line of code with such branches:
#
#     lib/base/arena.c ## the line's text ## why no test takes all its branches
#
# The tool's threads count without locks (with -fprofile-update=atomic the tests take several times as long): so a branch or two may be
# told otherwise from run to run.
#
# A line's text is without the blanks around it; the same text names the same line wherever it stands in the file.
set -u
build=$1
names=$(dirname "$0")/coverage.txt
dir=$build/gcov
least=95
rm -rf "$dir" && mkdir -p "$dir" || exit 1
if ! command -v gcov >/dev/null; then
    echo "coverage: skipped, there is no gcov"
    exit 0
fi
n=0
for file in lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c; do
    nm --defined-only "$build/obj/${file%.c}.o" | grep -qi ' t ' || continue # no code on this machine
    [ -e "$build/obj/${file%.c}.gcda" ] || { echo "coverage: nothing ran of $file"; exit 1; }
    n=$((n + 1))
    # headers' inline functions are counted with every file that includes them
    gcov -b -c -t -o "$build/obj/$(dirname "$file")" "$build/obj/${file%.c}.gcda" >"$dir/$n.gcov" 2>"$dir/log" || { cat "$dir/log"; exit 1; }
done

# Each branch once, taken if it is in any of the files: FILE|LINE|NUMBER|taken (0 or 1)|TEXT
awk '
    /^ *-: *0:Source:/ { sub(/^.*Source:/, ""); file = $0; next }
    /^branch / {
        if (file ~ /^lib\/(base|scene|space|approx|trace)\//) {
            key = file "|" line "|" $2
            if (!(key in taken)) { order[++n] = key; taken[key] = 0; text_of[key] = text }
            if ($3 == "taken" && $4 > 0) taken[key] = 1
        }
        next
    }
    /^ *[-#=0-9*]+: *[0-9]+:/ {
        at = index($0, ":"); rest = substr($0, at + 1); at = index(rest, ":")
        line = substr(rest, 1, at - 1) + 0
        text = substr(rest, at + 1)
        gsub(/^[ \t]+|[ \t]+$/, "", text)
    }
    END { for (i = 1; i <= n; i++) print order[i] "|" taken[order[i]] "|" text_of[order[i]] }' "$dir"/*.gcov >"$dir/branches"

awk -F'|' -v least=$least -v names="$names" '
    BEGIN {
        while ((getline line < names) > 0) {
            if (line ~ /^#/) continue
            split(line, part, / ## /)
            named[part[1] "|" part[2]] = 1
            n_named++
        }
    }
    {
        text = $0
        for (i = 1; i <= 4; i++) text = substr(text, index(text, "|") + 1)
        all[$1]++; n++
        if ($4 == 1) { got[$1]++; n_taken++; next }
        key = $1 "|" text
        if (key in named) { used[key] = 1; n_known++; next }
        missing[++m] = $1 ":" $2 ": branch " $3 ": " text
    }
    END {
        for (file in all) printf "%6.1f %%  %4d of %4d  %s\n", 100 * got[file] / all[file], got[file], all[file], file | "sort -k5"
        close("sort -k5")
        for (i = 1; i <= m; i++) print "not taken: " missing[i]
        for (key in named) if (!(key in used)) { print "taken, but named: " key }
        share = 100 * n_taken / n
        printf "coverage: %d of %d branches of the core taken, %.1f %%; %d named in %s, %d neither\n", n_taken, n, share, n_known, names, m
        exit share < least
    }' "$dir/branches"
