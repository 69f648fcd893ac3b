#!/bin/bash
# What README and docs show is so: docs.sh BUILD CC FLAGS [quick]
#
#   ```c       blocks that have a main are whole programs: compiled without a warning, linked and run (also with quick). A line
#              <!-- file: NAME.c --> before the block names it; after <!-- prints --> the next ```text block is, to the letter,
#              what the last program printed.
#   ```sh      blocks are run line by line in a folder of the page's own, from top to bottom; build/, examples/ and the page's
#              programs are there, and models by any name, which are all one ball (`suzanne.stl`, `models/bunny.obj`)
#   ```sh show blocks are only shown: they install, take minutes, or want other machines
#
# Then: the README's program is examples/smallest.c, to the letter and under 60 lines; docs/README.md names every page; every
# link to a file is to one that exists.
set -u
case "$1" in /*) build=$1 ;; *) build=$PWD/$1 ;; esac
cc=$2
flags=$3
mode=${4:-all}
project=$PWD
export LC_ALL=C
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
is_plain=yes # bytes are as the page says
[ -z "${flags// /}" ] || is_plain=no
bad=0 n_programs=0 n_commands=0 n_links=0
fail() {
    echo "docs: $*"
    bad=1
}
# A link to nowhere is told always, and is an error of the whole check.
missing() {
    echo "docs: $*"
    [ "$mode" = quick ] || bad=1
}

# ---- a page into pieces: NUMBER-KIND files, in order, with their first line's number ----

split_page() {
    awk -v to="$2" '
        /^<!-- file: .* -->$/ { file = $3; next }
        /^<!-- prints -->$/ { prints = 1; next }
        /^```/ && !on {
            on = 1
            kind = substr($0, 4)
            gsub(" ", "-", kind)
            out = sprintf("%s/%03d", to, ++n)
            print FNR, kind, (kind == "c" ? file : ""), (kind == "text" && prints ? "prints" : "") > (out ".about")
            if (kind == "text") prints = 0
            if (kind == "c") file = ""
            printf "" > (out ".body")
            next
        }
        /^```$/ { on = 0; close(out ".body"); close(out ".about"); next }
        on { print > (out ".body") }' "$1"
}

program() { # PAGE LINE BODY NAME
    local name=${4:-program$n_programs.c}
    cp "$3" "$name"
    n_programs=$((n_programs + 1))
    # shellcheck disable=SC2086
    if ! $cc -std=c99 -Wall -Wextra -pedantic -Werror $flags -I"$project/include" "$name" "$build/libaset_procedural.a" \
        "$build/libaset_load.a" "$build/libaset.a" -lm -o "${name%.c}" 2>log; then
        fail "$1:$2: the program does not compile: $(head -n 1 log)"
    elif ! "./${name%.c}" >printed 2>said; then
        fail "$1:$2: the program ends with an error: $(tail -n 1 said)"
    fi
}

commands() { # PAGE LINE BODY
    local line
    while IFS= read -r line; do
        case $line in "" | "#"*) continue ;; esac
        n_commands=$((n_commands + 1))
        bash -c "$line" >>log 2>&1 </dev/null || fail "$1:$2: $line: status $?: $(tail -n 1 log)"
    done <"$3"
}

# A ball as any model that a page names.
models() {
    local name
    mkdir -p models
    for name in $(grep -hoE '\b(models/)?[a-z]+\.(stl|obj|ply)\b' "$1" | sort -u) models/a.stl models/b.obj; do
        case $name in
        *.obj) cp "$work/ball.obj" "$name" ;;
        *.stl) "$build/tests/convert" "$work/ball.obj" "$name" stl ;;
        *.ply) "$build/tests/convert" "$work/ball.obj" "$name" ply-le ;;
        esac
    done
}

page() {
    local file=$1 folder about line kind name prints
    folder=$work/$(echo "$file" | tr '/.' '--')
    mkdir -p "$folder/pieces" "$folder/in"
    split_page "$file" "$folder/pieces"
    cd "$folder/in" || exit 1
    ln -s "$build" build
    ln -s "$project/examples" "$project/include" "$project/tools" .
    [ "$mode" = quick ] || models "$project/$file"
    for about in "$folder"/pieces/*.about; do
        [ -e "$about" ] || continue
        read -r line kind name prints <"$about"
        body=${about%.about}.body
        case $kind in
        c) ! grep -q '^int main(' "$body" || program "$file" "$line" "$body" "$name" ;;
        text) [ "$name$prints" != prints ] || [ $is_plain = no ] || cat printed said | cmp -s - "$body" ||
            fail "$file:$line: the program prints something else: $(cat printed said | diff "$body" - | head -n 3 | tr '\n' ' ')" ;;
        sh) [ "$mode" = quick ] || commands "$file" "$line" "$body" ;;
        sh-show | "" | console | html) ;;
        *) [ "$kind" != "${kind#sh}" ] && fail "$file:$line: what is \`\`\`$kind?" ;;
        esac
    done
    cd "$project" || exit 1
}

if [ "$mode" != quick ]; then
    awk 'BEGIN {
        n = 12; pi = atan2(0, -1)
        for (i = 0; i <= n; i++) for (j = 0; j < n; j++) {
            u = pi * i / n; v = 2 * pi * j / n
            printf "v %.4f %.4f %.4f\n", sin(u) * cos(v), cos(u), sin(u) * sin(v)
        }
        for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
            a = i * n + j + 1; b = i * n + (j + 1) % n + 1
            printf "f %d %d %d %d\n", a, b, b + n, a + n
        }
    }' >"$work/ball.obj"
fi
for file in README.md docs/*.md; do
    page "$file"
done

lines=$(wc -l <examples/smallest.c)
[ "$lines" -lt 60 ] || fail "examples/smallest.c has $lines lines, not under 60"
awk '/^```c$/ && !n++ { on = 1; next } /^```$/ { on = 0 } on' README.md | cmp -s - examples/smallest.c ||
    fail "the program in README.md differs from examples/smallest.c"

for file in docs/*.md; do
    [ "$file" = docs/README.md ] || grep -q "($(basename "$file"))" docs/README.md || fail "docs/README.md does not name $file"
done
for file in README.md docs/*.md; do
    for link in $(grep -oE '\]\([^)#]+[)#]' "$file" | sed 's/^](//; s/[)#]$//' | grep -v '^[a-z]*:'); do
        n_links=$((n_links + 1))
        [ -e "$(dirname "$file")/$link" ] || missing "$file: there is no $link"
    done
done
[ $n_programs -ge 4 ] || fail "only $n_programs programs found"
[ $bad = 0 ] && echo "docs: $n_programs programs, $n_commands commands, $n_links links; README's program is examples/smallest.c, $lines lines"
exit $bad
