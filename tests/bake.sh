#!/bin/bash
# bake.sh - end-to-end tests of aset bake, join and thumb, of baked drafts in aset render, and of examples/flash.c, run from
# the project's top: bash tests/bake.sh build/aset build/examples/flash CC [PATTERN]
#
# As tool.sh: one line for each case, each in a folder of its own, exit status 1 if any failed.
set -u

if [ $# -lt 3 ] || [ ! -x "$1" ] || [ ! -x "$2" ]; then
    echo "usage: bash tests/bake.sh build/aset build/examples/flash CC [PATTERN]" >&2
    exit 1
fi
aset=$1
flash=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
cc=$3
pattern=${4:-*}
project=$PWD
suite=bake
. "$(dirname "$0")/support/cases.sh"
draft_words="--approx all --approx-depth 0 --cells plane"

# ---- checks ----

# Fails with this status and one line that begins so.
refuses() {
    local expected=$1 start=$2
    shift 2
    tool "$@"
    [ $status -eq "$expected" ] || fail "aset $*: status $status, expected $expected: $(head -n 1 "$err")"
    [ "$(wc -l <"$err")" -eq 1 ] || fail "aset $*: $(wc -l <"$err") lines on standard error"
    case $(cat "$err") in
    "$start"?*) ;;
    *) fail "aset $*: says $(cat "$err"), expected $start..." ;;
    esac
}

lines() {
    [ "$(wc -l <"$1")" -eq "$2" ] || fail "$1 has $(wc -l <"$1") lines, expected $2"
}

# The bytes of a header's words, the lowest first, and of a file, in hexadecimal.
header_bytes() {
    grep '^ *0x' "$1" | grep -o '0x[0-9a-f]*' | sed 's/0x\(..\)\(..\)\(..\)\(..\)/\4\3\2\1/' | tr -d '\n'
}
file_bytes() {
    od -An -v -tx1 "$1" | tr -d ' \n'
}

png_kind() { # width height channel-code
    od -An -tu1 -j16 -N10 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8, $10 }'
}

# ---- bake ----

# A draft's words are floats: in a library of doubles, what is kept exact beside the cells lies elsewhere by a rounding.
baked_drafts_draw_the_same_picture() {
    local scene psnr least_db=
    works render "$scenes/block.obj" --grid 20 $draft_words -s 8x8 --stats s.json
    ! grep -q '"vertices":120' s.json || least_db=40
    for scene in skull.nff block.obj block.stl balls.nff; do
        works bake "$scenes/$scene" --grid 20 -o a.draft
        works render a.draft -s 60x40 -o a.ppm
        # shellcheck disable=SC2086
        works render "$scenes/$scene" --grid 20 $draft_words -s 60x40 -o b.ppm
        works compare a.ppm b.ppm --json
        psnr=$(sed 's/.*"psnr":\([0-9]*\).*/\1/' "$out")
        [ "$psnr" -ge "${least_db:-99}" ] ||
            fail "$scene: the baked draft's picture differs: $psnr dB"
    done
    works bake "$scenes/block.obj" --grid 20 -o a.draft
    works bake "$scenes/block.obj" --grid 20 --up-axis z --ground off -o b.draft
    works bake "$scenes/block.stl" --grid 20 --ground=off -o c.draft
    ! cmp -s a.draft b.draft || fail "--up-axis and --ground change nothing"
    same b.draft c.draft "the same model as .obj and .stl, z up, gives other drafts"
    works bake "$scenes/block.stl" --grid 20 -s 20x50 -o d.draft
    works render d.draft -s 20x50 -o d.ppm
    # shellcheck disable=SC2086
    works render "$scenes/block.stl" --grid 20 $draft_words -s 20x50 -o e.ppm
    same d.ppm e.ppm "a draft for upright pictures is not seen as the model in one"
}

a_draft_is_drawn_from_anywhere() {
    works bake "$scenes/block.obj" -o a.draft
    works render a.draft -s 40x40 -o a.ppm
    works render a.draft -s 40x40 --from 4,4,-6 --at 0,0,0 --up 0,1,0 --angle 40 -o b.ppm
    ! cmp -s a.ppm b.ppm || fail "another view shows the same"
    works render a.draft -s 40x40 -j 3 -o c.ppm
    same a.ppm c.ppm "three threads draw another picture"
    works a.draft d.ppm -s 40x40
    same a.ppm d.ppm "the short form draws another picture"
    works render a.draft -s 40x40 --approx all --approx-depth 0 -o e.ppm
    same a.ppm e.ppm "the words that a draft implies change it"
    refuses 2 "aset: --approx: " render a.draft --approx shadow
    refuses 2 "aset: --approx: " render a.draft --approx all --approx-depth 1
    refuses 2 "aset: --cells: " render a.draft --cells flat
    cp a.draft copy # its first word tells
    works render copy -s 40x40 -o f.ppm
    works copy g.ppm -s 40x40
    same a.ppm f.ppm "under a name without an ending it draws another picture"
    same a.ppm g.ppm "under a name without an ending the short form draws another picture"
    refuses 1 "aset: copy: a baked draft" info copy
    refuses 1 "aset: a.draft: a baked draft" bake a.draft -o b.draft
}

# What a draft is said to need, whatever it had, is enough, and not twice what is.
needs_of_drafts_are_enough() {
    local memory need first=
    works scene gears --size 2 -o gears.nff
    for memory in 1 50000 100000 130000; do
        tool render gears.nff --grid 30 $draft_words --memory $memory -s 8x8
        [ $status -eq 1 ] || fail "$memory bytes: status $status"
        need=$(sed -n 's/.* needs \([0-9]*\) bytes.*/\1/p' "$err")
        [ "$need" -gt "$memory" ] || fail "with $memory bytes it needs $need"
        works render gears.nff --grid 30 $draft_words --memory "$need" -s 8x8
        : "${first:=$need}"
        [ $((need * 100)) -lt $((first * 125)) ] && [ $((need * 100)) -gt $((first * 80)) ] ||
            fail "with $memory bytes it needs $need, with 1 $first"
    done
    refuses 1 "aset: gears.nff: the draft needs " bake gears.nff --grid 30 --memory 50000 -o a.draft
    need=$(sed -n 's/.* needs \([0-9]*\) bytes.*/\1/p' "$err")
    [ "$need" -gt 50000 ] && [ $((need * 100)) -lt $((first * 125)) ] || fail "to be baked it needs $need, to be drawn $first"
    works bake gears.nff --grid 30 --memory "$need" -o a.draft
    works render gears.nff --grid 30 $draft_words --memory 160000 -s 8x8 # lists without maps, if there is no room for these
    works scene gears -o large.nff
    works bake large.nff --memory 400K -o a.draft # what is too fine is seen long before all of it is baked
    [ "$(sed -n 's/.* \([0-9]*\) passes$/\1/p' "$out")" -lt 80 ] || fail "too many passes: $(cat "$out")"
}

headers_hold_the_words() {
    works bake "$scenes/skull.nff" --grid 12 -o a.draft
    works bake "$scenes/skull.nff" --grid 12 -o a.h
    [ "$(header_bytes a.h)" = "$(file_bytes a.draft)" ] || fail "the header's words are not the file's"
    grep -q "^static const uint32_t a\[$(($(wc -c <a.draft) / 4))\] = {$" a.h || fail "no array a of all words"
    for word in 'skull.nff' '12x12x12 divisions' 'facets' "$(wc -c <a.draft) bytes" 'libaset'; do
        grep -q "^ \* .*$word" a.h || fail "the comment does not say $word"
    done
    works bake "$scenes/skull.nff" --grid 12 -o - # binary
    same "$out" a.draft "standard output is not the file"
}

headers_compile() {
    local name file
    for name in bunny 2nd-try int a.b draft_ main uint32_t aset_vec3; do
        file=$name.h
        works bake "$scenes/block.obj" --grid 8 -o "$file"
        printf '#include "%s"\n#include "%s"\n#include <aset/aset.h>\n' "$file" "$file" >use.c
        sed -n 's/^static const uint32_t \([A-Za-z0-9_]*\)\[.*/int main(void) { return \1[0] != 0x41534454u; }/p' \
            "$file" >>use.c
        "$cc" -std=c99 -Wall -Wextra -pedantic -Wconversion -Wshadow -Werror -I"$project/include" -I. use.c -o use ||
            fail "$file does not compile: $(tail -n 1 "$noise")"
        ./use || fail "$file: the program does not find the draft's first word"
    done
    works bake "$scenes/block.obj" --grid 8 --name other -o c.h
    grep -q '^static const uint32_t other\[' c.h || fail "--name other: no such array"
    mkdir '*' && cp "$scenes/block.obj" '*/ x.obj'
    works bake '*/ x.obj' --grid 8 -o d.h
    "$cc" -std=c99 -Wall -Wextra -Werror -fsyntax-only d.h || fail "a path ends the comment"
}

bake_says_one_line() {
    works bake "$scenes/block.obj" --grid 8x9x10 -o a.draft
    lines "$out" 1
    grep -Eqx "$(wc -c <a.draft) bytes, 8x9x10 divisions, [0-9]+ facets, 1 kept objects, [0-9]+ passes" "$out" ||
        fail "it says: $(cat "$out")"
    works bake "$scenes/block.obj" --grid=auto -q -o b.draft
    [ ! -s "$out" ] || fail "--quiet says $(cat "$out")"
}

memory_decides_passes_only() {
    local memory need
    works bake "$scenes/skull.nff" --grid 24 -o a.draft
    for memory in 200K 300K 1M 64M; do
        works bake "$scenes/skull.nff" --grid 24 --memory $memory -o b.draft
        same a.draft b.draft "--memory $memory: another draft"
    done
    refuses 1 "aset: $scenes/skull.nff: " bake "$scenes/skull.nff" --grid 24 --memory 4K -o c.draft
    need=$(sed -n 's/.* needs \([0-9]*\) bytes, has 4096$/\1/p' "$err")
    [ -n "$need" ] || fail "no need in: $(cat "$err")"
    works bake "$scenes/skull.nff" --grid 24 --memory "$need" -o c.draft
    same a.draft c.draft "with the bytes it asks for: another draft"
}

bake_refuses() {
    local model=$scenes/block.obj
    refuses 2 "aset: bake: " bake "$model"
    refuses 2 "aset: bake: " bake -o a.h
    refuses 2 "aset: bake: " bake "$model" "$model" -o a.h
    refuses 2 "aset: --grid: " bake "$model" --grid 513 -o a.h
    refuses 2 "aset: --grid: " bake "$model" --grid 0 -o a.h
    refuses 2 "aset: --up-axis: " bake "$model" --up-axis x -o a.h
    refuses 2 "aset: --ground: " bake "$model" --ground maybe -o a.h
    refuses 2 "aset: --memory: " bake "$model" --memory 1.5M -o a.h
    refuses 2 "aset: --name: " bake "$model" --name 2x -o a.h
    refuses 2 "aset: --name: " bake "$model" --name int -o a.h
    refuses 2 "aset: --name: " bake "$model" --name aset_draft -o a.h
    refuses 2 "aset: --name: " bake "$model" --name x -o a.draft
    refuses 1 "aset: nothing.obj: " bake nothing.obj -o a.h
    refuses 1 "aset: a.draft: " bake a.draft -o b.draft
    refuses 1 "aset: no/a.h: " bake "$model" -o no/a.h
    [ -z "$(ls -A)" ] || fail "left $(ls -A)"
    echo "v 1 x" >bad.obj
    echo old >a.h
    refuses 1 "aset: bad.obj:1: " bake bad.obj -o a.h
    [ "$(cat a.h)" = old ] || fail "a failure changed the old file"
    if [ -w /dev/full ]; then
        refuses 1 "aset: /dev/full: " bake "$model" -o /dev/full
    fi
    rm a.h bad.obj
    [ -z "$(ls -A)" ] || fail "left $(ls -A)"
}

broken_drafts_are_refused() {
    local size at need
    works bake "$scenes/block.obj" --grid 8 -o a.draft
    size=$(wc -c <a.draft)
    for at in 0 1 4 100 160 400 $((size - 4)) $((size - 1)); do
        head -c "$at" a.draft >b.draft
        refuses 1 "aset: b.draft: " render b.draft
    done
    for at in 0 5 8 13 17 60 70 200 $((size / 2)) $((size - 3)); do
        { head -c "$at" a.draft && printf '\252' && tail -c +$((at + 2)) a.draft; } >b.draft
        cmp -s a.draft b.draft || refuses 1 "aset: b.draft: " render b.draft
    done
    { cat a.draft && printf 'more'; } >b.draft
    refuses 1 "aset: b.draft: " render b.draft
    cp "$scenes/block.obj" c.draft
    refuses 1 "aset: c.draft: " render c.draft
    mkdir d.draft
    refuses 1 "aset: d.draft: " render d.draft
    refuses 1 "aset: e.draft: " render e.draft
    refuses 1 "aset: a.draft: " render a.draft --memory 100
    need=$(sed -n 's/.* needs \([0-9]*\) bytes, has 100$/\1/p' "$err")
    [ -n "$need" ] || fail "no need in: $(cat "$err")"
    works render a.draft --memory "$need" -s 8x8
    refuses 1 "aset: a.draft: " render a.draft --memory $((need - 1))
}

# ---- join ----

joined_pieces_are_the_picture() {
    local kind piece n=0
    for kind in png ppm; do
        works render "$scenes/balls.nff" -s 50x40 -o all.$kind
        for piece in 0:1 1:17 17:18 18:40; do
            works render "$scenes/balls.nff" -s 50x40 --rows $piece -o $n.$kind
            n=$((n + 1))
        done
    done
    works join 0.png 1.png 2.png 3.png -o joined.png
    same joined.png all.png "four PNGs"
    works join 4.ppm 5.ppm 6.ppm 7.ppm -o joined.ppm
    same joined.ppm all.ppm "four PPMs"
    works join 4.ppm 1.png 6.ppm 3.png --output=joined.png
    same joined.png all.png "PNGs and PPMs to PNG"
    works join all.png -o -
    same "$out" all.png "one piece to standard output"
    cp 0.png piece.png
    refuses 1 "aset: 0.png: it is read, too" join 0.png 1.png 2.png 3.png -o 0.png
    same 0.png piece.png "a piece is written over"
    works render "$scenes/block.obj" --transparent $draft_words -s 30x20 -o whole.png
    works render "$scenes/block.obj" --transparent $draft_words -s 30x20 --rows 0:7 -o a.png
    works render "$scenes/block.obj" --transparent $draft_words -s 30x20 --rows 7:20 -o b.png
    works join a.png b.png -o joined.png
    same joined.png whole.png "transparent pieces"
}

join_refuses() {
    works render "$scenes/balls.nff" -s 20x10 -o a.png
    works render "$scenes/balls.nff" -s 21x10 -o wide.png
    works render "$scenes/block.obj" -s 20x10 --transparent $draft_words -o clear.png
    works render "$scenes/balls.nff" -s 20x10 -o a.ppm
    mkdir in && mv ./*.p* in && cd in || fail "no folder"
    refuses 1 "aset: wide.png: this piece is 21 pixels wide, but a.png is " join a.png wide.png -o j.png
    refuses 1 "aset: clear.png: " join a.png clear.png -o j.png
    refuses 1 "aset: nothing.png: " join a.png nothing.png -o j.png
    head -c $(($(wc -c <a.png) - 30)) a.png >cut.png
    refuses 1 "aset: cut.png: the file ends" join a.png cut.png -o j.png
    head -c $(($(wc -c <a.ppm) - 1)) a.ppm >cut.ppm
    refuses 1 "aset: cut.ppm: the file ends" join a.png cut.ppm -o j.png
    : >empty.png
    refuses 1 "aset: empty.png: the file is " join empty.png -o j.png
    { cat a.ppm && echo; } >long.ppm
    refuses 1 "aset: long.ppm: " join long.ppm -o j.png
    refuses 1 "aset: $scenes/block.obj: " join "$scenes/block.obj" -o j.png
    refuses 2 "aset: join: " join -o j.png
    refuses 2 "aset: join: " join a.png
    refuses 2 "aset: j.jpg: " join a.png -o j.jpg
    [ ! -e j.png ] || fail "left a picture"
}

# ---- thumb ----

models() {
    mkdir m m/folder.obj
    cp "$scenes/block.obj" m/a.obj
    cp "$scenes/block.stl" m/b.STL
    cp "$scenes/balls.nff" m/c.nff
    printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n' >m/d.ply
    printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 1\n3 0 1 2\n' >>m/d.ply
    echo "not a model" >m/readme.txt
    echo "v x" >m/.hidden.obj
}

thumbnails_of_a_folder() {
    models
    works thumb m -o t
    [ "$(cd t && echo *)" = "a.obj.png b.STL.png c.nff.png d.ply.png" ] || fail "made $(ls t)"
    grep -qx "4 of 4 thumbnails drawn" "$out" || fail "says $(cat "$out")"
    for name in a.obj b.STL c.nff d.ply; do
        [ "$(png_kind t/$name.png)" = "256x256 2" ] || fail "$name.png: $(png_kind t/$name.png)"
        # shellcheck disable=SC2086
        works render m/$name $draft_words --memory 1M -s 256x256 -o r.png
        same t/$name.png r.png "$name: not what render draws"
    done
    works m/a.obj short.png -s 256x256
    same t/a.obj.png short.png "not what the short form draws"
    works thumb m -o t -s 32 --transparent --memory=600K -q
    [ ! -s "$out" ] || fail "--quiet says $(cat "$out")"
    [ "$(png_kind t/a.obj.png)" = "32x32 6" ] || fail "-s 32 --transparent: $(png_kind t/a.obj.png)"
    works thumb m -o t --size 40x30
    [ "$(png_kind t/d.ply.png)" = "40x30 2" ] || fail "--size 40x30: $(png_kind t/d.ply.png)"
    mkdir empty -- -dash && cp m/a.obj ./-dash
    works thumb empty -o t2
    [ -d t2 ] || fail "no folder of no models"
    works thumb -o t3 -- -dash
    same t/../t3/a.obj.png short.png "a folder that begins with a dash"
}

broken_models_are_listed() {
    models
    works thumb m -o whole
    echo "v x" >m/aa.obj
    head -c 200 m/b.STL >m/bb.stl
    ln -s nowhere m/z.ply
    tool thumb m -o t
    [ $status -eq 1 ] || fail "status $status"
    lines "$err" 7
    grep -q "^aset: m/aa.obj:1: ." "$err" || fail "no error line of aa.obj"
    tail -n 4 "$err" >end
    printf 'aset: m: %s\n' "3 of 7 models could not be drawn:" "no thumbnail of aa.obj" "no thumbnail of bb.stl" \
        "no thumbnail of z.ply" >expected
    same end expected "the list at the end: $(cat end)"
    grep -qx "4 of 7 thumbnails drawn" "$out" || fail "says $(cat "$out")"
    diff -r t whole >/dev/null || fail "broken models change the thumbnails of the others"
}

thumb_refuses() {
    models
    refuses 2 "aset: thumb: " thumb m
    refuses 2 "aset: thumb: " thumb -o t
    refuses 2 "aset: thumb: " thumb m m -o t
    refuses 2 "aset: thumb: --output: " thumb m -o -
    refuses 2 "aset: thumb: --size: " thumb m -o t -s 0
    refuses 2 "aset: thumb: --size: " thumb m -o t -s 5x
    refuses 2 "aset: thumb: --size: " thumb m -o t -s 70000
    refuses 2 "aset: thumb: --memory: " thumb m -o t --memory x
    refuses 1 "aset: nothing: " thumb nothing -o t
    refuses 1 "aset: m/a.obj: " thumb m/a.obj -o t
    refuses 1 "aset: m/a.obj: " thumb m -o m/a.obj
    [ ! -e t ] || fail "left a folder"
}

progress_of_thumbnails() {
    models
    if ! script -qec true /dev/null </dev/null >/dev/null 2>&1; then
        echo "no script(1) that gives a terminal" >"$top/skipped"
        return
    fi
    script -qec "$aset thumb m -o t" /dev/null </dev/null >bar 2>&1 || fail "status $? on a terminal"
    grep -q '3/4 c.nff' bar || fail "no progress on a terminal"
    script -qec "$aset thumb m -o t --quiet" /dev/null </dev/null >none 2>&1 || fail "status $? with --quiet"
    [ ! -s none ] || fail "--quiet: $(head -c 80 none)"
}

# ---- the microcontroller ----

flash_draws_what_render_draws() {
    "$flash" >a.ppm 2>said || fail "status $?: $(head -n 1 said)"
    works scene skull -o skull.nff
    works bake skull.nff --grid 40 -q -o skull.draft
    works render skull.draft -s 160x120 -o b.ppm
    same a.ppm b.ppm "flash and render draw other pictures"
    grep -q "^flash *$(wc -c <skull.draft) bytes" said || fail "it does not say the draft's bytes: $(head -n 1 said)"
}

flash_is_limited_when_compiled() {
    local words="-std=c99 -fsyntax-only -I$project/include -I."
    works bake "$scenes/skull.nff" --grid 40 --name model -o flash_model.h
    # shellcheck disable=SC2086
    "$cc" $words "$project/examples/flash.c" || fail "a draft that fits does not compile"
    works bake "$scenes/skull.nff" --grid 48 --name model -o flash_model.h
    # shellcheck disable=SC2086
    ! "$cc" $words "$project/examples/flash.c" 2>/dev/null || fail "a draft of more than 64 kB compiles"
}

# A block as OBJ (z up as STL has it), and the same as STL: two triangles a side.
make_block() {
    printf 'v %s\n' "-1 -1 -1" "1 -1 -1" "1 1 -1" "-1 1 -1" "-1 -1 1" "1 -1 1" "1 1 1" "-1 1 1"
    printf 'f %s\n' "1 4 3 2" "5 6 7 8" "1 2 6 5" "3 4 8 7" "2 3 7 6" "4 1 5 8"
}
make_stl() {
    echo "solid block"
    awk '$1 == "v" { v[++n] = $2 " " $3 " " $4 }
         $1 == "f" { for (k = 3; k < NF; k++) print "facet normal 0 0 0\nouter loop\nvertex " v[$2] "\nvertex " v[$k] \
                     "\nvertex " v[$(k + 1)] "\nendloop\nendfacet" }' "$1"
    echo "endsolid block"
}

mkdir "$scenes"
make_block >"$scenes/block.obj" && make_stl "$scenes/block.obj" >"$scenes/block.stl" &&
    "$aset" scene skull -o "$scenes/skull.nff" && "$aset" scene balls --size 2 -o "$scenes/balls.nff" || {
    echo "not ok scenes: the scenes of the cases cannot be made"
    exit 1
}

cases="
baked_drafts_draw_the_same_picture a_draft_is_drawn_from_anywhere needs_of_drafts_are_enough headers_hold_the_words headers_compile bake_says_one_line
memory_decides_passes_only bake_refuses broken_drafts_are_refused joined_pieces_are_the_picture join_refuses
thumbnails_of_a_folder broken_models_are_listed thumb_refuses progress_of_thumbnails
flash_draws_what_render_draws flash_is_limited_when_compiled
"
# shellcheck disable=SC2086
run_cases $cases
