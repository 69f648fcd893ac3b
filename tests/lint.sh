#!/bin/bash
# lint.sh DIR - cppcheck over everything and clang-tidy (by .clang-tidy) over libraries and tool. What tests/lint/known.txt does not
# name with its reason is printed and fails. A checker that is not installed is skipped, and said so.
set -u
dir=$1
known=$(dirname "$0")/lint/known.txt
mkdir -p "$dir" || exit 1
: >"$dir/findings"

if command -v cppcheck >/dev/null; then
    # style: what may be narrower in scope or const is the writer's choice
    cppcheck --std=c99 --platform=unix64 --enable=warning,style,performance,portability --inline-suppr -q -Iinclude -Ilib \
        --suppress=missingIncludeSystem --suppress=toomanyconfigs --suppress=variableScope --suppress=constVariable --suppress=compareBoolExpressionWithInt \
        --template='{file}:{line}:{column}: {message} [{id}]' --template-location= lib tools examples >"$dir/cppcheck" 2>&1
    grep -E '\[[A-Za-z]+\]$' "$dir/cppcheck" >>"$dir/findings"
else
    echo "lint: no cppcheck here"
fi
if command -v clang-tidy >/dev/null; then
    # shellcheck disable=SC2046
    clang-tidy --quiet lib/*/*.c tools/*.c -- -std=c99 -ffp-contract=off -Iinclude -Ilib -D_POSIX_C_SOURCE=200809L \
        $(pkg-config --cflags libpng) >"$dir/tidy" 2>"$dir/tidy.log"
    grep -E '^[^ ]+:[0-9]+:[0-9]+: (warning|error): ' "$dir/tidy" | sed "s|^$PWD/||" | sort -u >>"$dir/findings"
else
    echo "lint: no clang-tidy here"
fi

awk -v known="$known" '
    BEGIN { while ((getline line < known) > 0) if (line !~ /^#/) { split(line, word, " "); is_known[word[1] " " word[2]] = 1 } }
    {
        file = $0; sub(/:.*/, "", file)
        check = $0; sub(/\]$/, "", check); sub(/.*\[/, "", check); sub(/,.*/, "", check)
        if ((file " " check) in is_known) { n_known++; next }
        print; n++
    }
    END { printf "lint: %d findings, and %d that are none by %s\n", n, n_known, known; exit n > 0 }' "$dir/findings"
