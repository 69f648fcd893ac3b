#!/bin/bash
# tool.sh - end-to-end tests of the program aset, run from the project's top: bash tests/tool.sh build/aset [PATTERN]
#
# One line for each case, `ok NAME` or `not ok NAME: why`, then `N passed, N failed`; exit status 1 if any failed. PATTERN,
# a shell pattern, picks cases by name. Each case is a function of this file that runs in a subshell and in an empty folder
# of its own, so that a look at the folder finds every file that the tool leaves. The folders lie in one that is removed
# at the end.
set -u

if [ $# -lt 1 ] || [ ! -x "$1" ]; then
    echo "usage: bash tests/tool.sh build/aset [PATTERN]" >&2
    exit 1
fi
aset=$1
pattern=${2:-*}
suite=tool
. "$(dirname "$0")/support/cases.sh"

# ---- checks ----

# The run before ended with this status and one line on standard error that begins so.
refused() {
    local expected=$1 start=$2 line
    line=$(head -n 1 "$err")
    [ $status -eq "$expected" ] || fail "status $status, expected $expected; said: $line"
    [ "$(wc -l <"$err")" -eq 1 ] || fail "$(wc -l <"$err") lines on standard error, expected 1; the first: $line"
    case $line in
    "$start"?*) ;;
    *) fail "the line does not begin with '$start': $line" ;;
    esac
}

# Wrong words: status 2, one line, nothing else.
wrong_words() {
    tool "$@"
    (refused 2 "aset: ") || fail "aset $*: $(cat "$why")"
    [ ! -s "$out" ] || fail "aset $*: standard output is not empty"
    [ -z "$(ls -A)" ] || fail "aset $*: left $(ls -A)"
}

# Two PPM of one width (in pixels), row by row.
same_rows() {
    local at
    [ -s "$1" ] && [ -s "$2" ] || fail "$4: a picture is empty"
    at=$(cmp -l "$1" "$2" 2>/dev/null | awk 'NR == 1 { print $1 }')
    [ -z "$at" ] || fail "$4: differ from about row $(((at - 16) / (3 * $3))) on"
    same "$1" "$2" "$4: one is longer"
}

# The value of a member of the compact JSON in a file; a member of a member as OBJECT KEY.
json() {
    local text
    text=$(tr -d ' \n' <"$1")
    if [ $# -eq 3 ]; then
        text=$(printf '%s' "$text" | sed -n "s/.*\"$2\":{\\([^}]*\\)}.*/{\\1}/p")
        shift
    fi
    printf '%s' "$text" | sed -n "s/.*[{,]\"$2\":\\(\\[[^]]*\\]\\|{[^}]*}\\|\"[^\"]*\"\\|[^,}]*\\).*/\\1/p"
}

# Valid JSON: strings, numbers, lists and objects are replaced by 0 from the inside out until 0 is left.
json_valid() {
    local rest
    rest=$(tr -d ' \n' <"$1" | sed -E -e 's/"[^"\\]*":/@/g' -e 's/"[^"\\]*"|true|false|null/0/g' \
        -e 's/-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?/0/g' \
        -e ':again' -e 's/\[(0(,0)*)?\]|\{(@0(,@0)*)?\}/0/g' -e 'tagain')
    [ "$rest" = 0 ] || fail "$1 is no valid JSON: $(head -c 200 "$1")"
    if python3 -c '' 2>/dev/null; then
        python3 -m json.tool <"$1" >/dev/null 2>&1 || fail "python's json.tool refuses $1"
    fi
}

# The bytes that a run with too little memory asks for.
need_of() {
    tool render "$@"
    (refused 1 "aset: $1: ") || fail "$*: $(cat "$why")"
    need=$(sed -n 's/.* needs \([0-9][0-9]*\) bytes, has [0-9][0-9]*$/\1/p' "$err")
    [ -n "$need" ] || fail "no '... needs N bytes, has M': $(cat "$err")"
}

psnr() {
    works compare "$1" "$2" --json
    json "$out" psnr
}

# WIDTHxHEIGHT by the header of a PNG, after a look at its first and last bytes.
png_size() {
    [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 does not begin like a PNG"
    [ "$(tail -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 49454e44ae426082 ] || fail "$1 does not end like a PNG"
    od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }' # sides below 65536
}

# ---- pictures ----

pictures_png_ppm_and_standard_output() {
    works render "$scenes/balls.nff" -o a.png -s 60x45
    [ ! -s "$out" ] || fail "words on standard output"
    [ "$(png_size a.png)" = 60x45 ] || fail "the PNG is $(png_size a.png)"
    works render "$scenes/balls.nff" -o a.ppm -s 60x45
    [ "$(head -n 3 a.ppm | tr '\n' ' ')" = "P6 60 45 255 " ] || fail "the PPM's header is $(head -c 20 a.ppm | tr '\n' ' ')"
    [ "$(wc -c <a.ppm)" -eq $((13 + 60 * 45 * 3)) ] || fail "the PPM has $(wc -c <a.ppm) bytes"
    [ "$(psnr a.png a.ppm)" = 99 ] || fail "PNG and PPM differ"
    works render "$scenes/balls.nff" -o - -s 60x45
    same "$out" a.png "PNG on standard output and in a file differ"
    works render "$scenes/balls.nff" -s 60x45
    [ ! -s "$out" ] || fail "without -o something came on standard output"
    [ "$(ls -A | tr '\n' ' ')" = "a.png a.ppm " ] || fail "left $(ls -A | tr '\n' ' ')"
}

picture_has_the_scene_s_size() {
    works render "$scenes/tetra.nff" -o a.png
    [ "$(png_size a.png)" = 512x512 ] || fail "it is $(png_size a.png)"
}

picture_shows_something() {
    # a black picture would equal itself in every other case
    works render "$scenes/balls.nff" -o a.ppm -s 60x45
    [ "$(tail -c 8100 a.ppm | od -An -v -tx1 -w3 | sort -u | wc -l)" -gt 100 ] || fail "under 100 colours"
}

rules_spd_draws_corners() {
    works render "$scenes/tetra.nff" --rules spd -s 40x30 -o a.png
    [ "$(png_size a.png)" = 41x31 ] || fail "it is $(png_size a.png), expected 41x31"
}

short_form() {
    works render "$scenes/balls.nff" -o long.png -s 50x40 -j 2
    works "$scenes/balls.nff" short.png -s 50x40 -j 2
    same long.png short.png "not the picture of render"
    works "$scenes/balls.nff" - -s 50x40
    same long.png "$out" "not the picture of render on standard output"
    works "$scenes/balls.nff" short.ppm --size=50x40
    [ "$(psnr short.png short.ppm)" = 99 ] || fail "the PPM differs"
    cp "$scenes/balls.nff" render.nff
    works ./render.nff local.png -s 50x40
    same long.png local.png "another name, another picture"
}

option_values_with_and_without_equals() {
    works render "$scenes/balls.nff" -o a.ppm --size 40x30 --grid 9 --approx shadow,reflected --approx-depth 0 --depth 3 \
        --samples 4 --curtail 0.25 --curtail-when more --threads 2 --memory 1M --method mset --stats a.json
    works render --size=40x30 --grid=9 --approx=shadow,reflected --approx-depth=0 --depth=3 --samples=4 --curtail=0.25 \
        --curtail-when=more --threads=2 --memory=1024K --method=mset --stats=b.json --output=b.ppm "$scenes/balls.nff"
    works render -j2 -mmset -s40x30 -oc.ppm --grid 9x9x9 --approx shadow,reflected --approx-depth 0 --depth 3 --samples 4 \
        --curtail 0.25 --curtail-when more --memory 1048576 -- "$scenes/balls.nff"
    same a.ppm b.ppm "--opt VALUE and --opt=VALUE give different pictures"
    same a.ppm c.ppm "long and short options give different pictures"
    [ "$(json a.json memory budget)" = 1048576 ] || fail "--memory 1M is $(json a.json memory budget)"
    [ "$(json b.json memory budget)" = 1048576 ] || fail "--memory=1024K is $(json b.json memory budget)"
    [ "$(json a.json grid)" = "[9,9,9]" ] || fail "--grid 9 is $(json a.json grid)"
    [ "$(json a.json approx)" = '["shadow","reflected"]' ] || fail "--approx is $(json a.json approx)"
}

camera_options() {
    works render "$scenes/tetra.nff" -s 30x30 -o a.ppm
    set -- $(awk '/^(from|at|up) / { print $2 "," $3 "," $4 } /^angle / { print $2 }' "$scenes/tetra.nff")
    works render "$scenes/tetra.nff" -s 30x30 --from "$1" --at "$2" --up "$3" --angle "$4" -o b.ppm
    same a.ppm b.ppm "the scene's own view by options gives another picture"
    works render "$scenes/tetra.nff" -s 30x30 --angle 60 -o c.ppm
    cmp -s a.ppm c.ppm && fail "--angle changes nothing"
    return 0
}

method_aset_is_mset_approximating() {
    works render "$scenes/balls.nff" -s 40x40 -m aset -o a.ppm
    works render "$scenes/balls.nff" -s 40x40 -m mset --approx all --approx-depth 1 -o b.ppm
    works render "$scenes/balls.nff" -s 40x40 -m mset -o c.ppm
    same a.ppm b.ppm "not the picture of --approx all --approx-depth 1"
    cmp -s a.ppm c.ppm && fail "it is the exact picture"
    return 0
}

mset_equals_brute() {
    local scene name size
    for scene in balls:2 gears:1 mount:3 rings:1 teapot:2 tetra:3 tree:3; do
        name=${scene%:*} size=${scene#*:}
        works scene "$name" --size "$size" -o s.nff
        works render s.nff -s 40x40 -o mset.png -m mset --stats mset.json
        works render s.nff -s 40x40 -o brute.png -m brute --stats brute.json
        [ "$(psnr mset.png brute.png)" = 99 ] || fail "$scene: psnr $(psnr mset.png brute.png)"
        [ "$(json mset.json rays)" = "$(json brute.json rays)" ] || fail "$scene: other rays"
    done
}

brute_tests_every_object_for_every_ray() {
    local kind rays=0
    works render "$scenes/balls.nff" -s 30x20 -m brute --stats s.json
    for kind in primary shadow reflected refracted; do
        rays=$((rays + $(json s.json rays $kind)))
    done
    [ "$(json s.json rays primary)" = 600 ] || fail "$(json s.json rays primary) primary rays for 30 x 20 pixels"
    [ "$(json s.json work tests)" -eq $((rays * $(json s.json scene objects))) ] ||
        fail "$(json s.json work tests) tests of $rays rays and $(json s.json scene objects) objects"
}

threads_draw_the_same_picture() {
    local options threads
    for options in "" "-m aset" "-m brute" "--samples 4"; do
        for threads in 1 2 3; do
            works render "$scenes/balls.nff" -s 50x41 $options -j $threads -o $threads.ppm
            same_rows 1.ppm $threads.ppm 50 "$options -j $threads"
        done
    done
    works render "$scenes/balls.nff" -s 16x2 -o few.ppm
    works render "$scenes/balls.nff" -s 16x2 -j 40 -o many.ppm
    same few.ppm many.ppm "more threads than rows"
    for threads in 1 8 9 100; do # counts, too, whatever room beams have
        works render "$scenes/balls.nff" -s 64x64 --approx all --approx-depth 0 --cells plane --grid 20 --memory 700K -j $threads --stats $threads.json
        sed -i 's/"time".*//; s/"memory".*//' $threads.json
        same 1.json $threads.json "counts of $threads threads"
    done
}

rows_are_pieces_of_the_picture() {
    local piece
    works render "$scenes/balls.nff" -s 50x40 -o all.ppm --stats all.json
    for piece in 0:1 1:17 17:18 18:40; do
        works render "$scenes/balls.nff" -s 50x40 --rows $piece -o piece.ppm
        [ "$(head -n 2 piece.ppm | tail -n 1)" = "50 $((${piece#*:} - ${piece%:*}))" ] || fail "rows $piece: wrong size"
        tail -c $((50 * 3 * (${piece#*:} - ${piece%:*}))) piece.ppm >>joined
    done
    { printf 'P6\n50 40\n255\n' && cat joined; } >joined.ppm
    same_rows all.ppm joined.ppm 50 "pieces"
    works render "$scenes/balls.nff" -s 50x40 --rows 10:30 -j 3 -o piece.ppm --stats piece.json
    { printf 'P6\n50 20\n255\n' && tail -c +$((14 + 50 * 3 * 10)) all.ppm | head -c $((50 * 3 * 20)); } >cut.ppm
    same_rows cut.ppm piece.ppm 50 "rows 10:30 of three threads"
    [ "$(json piece.json rays primary)" = 1000 ] || fail "20 rows of 50 have $(json piece.json rays primary) primary rays"
    tool render "$scenes/balls.nff" -s 50x40 --rows 30:41 -o behind.ppm
    [ $status -ne 0 ] && [ "$(wc -l <"$err")" -eq 1 ] && [ ! -e behind.ppm ] || fail "rows behind the last: status $status"
}

# ---- words ----

help_and_version() {
    local command word
    works --help
    cp "$out" commands
    for command in render info scene compare tables sheet; do
        grep -q "^ *$command " commands || fail "aset --help does not name $command"
        works $command --help
        cp "$out" long
        [ -s long ] || fail "aset $command --help says nothing"
        works $command -h
        same long "$out" "aset $command: -h and --help differ"
    done
    works render --help
    for word in -o -m --approx --approx-depth --grid --cells --curtail --curtail-when --memory -s --samples --depth --rules \
        --rows -j --from --at --up --angle --stats --quiet; do
        grep -q -e "$word[ ,]" "$out" || fail "aset render --help does not name $word"
    done
    works scene --help
    for word in balls gears mount rings teapot tetra tree snow tetra-moon skull; do
        grep -q "^ *$word " "$out" || fail "aset scene --help does not name $word"
    done
    works --version
    grep -Eqx 'aset [0-9]+(\.[0-9]+)+' "$out" || fail "aset --version says $(cat "$out")"
}

wrong_commands() {
    wrong_words
    wrong_words nonsense
    wrong_words --nonsense
    wrong_words ""
    wrong_words Render x.nff
    wrong_words render
    wrong_words render a.nff b.nff
    wrong_words "$scenes/balls.nff"
    wrong_words "$scenes/balls.nff" -q
    wrong_words "$scenes/balls.nff" a.png b.png
    wrong_words info
    wrong_words info a.nff b.nff
    wrong_words scene
    wrong_words scene balls tetra
    wrong_words scene nonsense
    wrong_words compare
    wrong_words compare a.png
    wrong_words compare a.png b.png c.png
}

wrong_options() {
    local option
    for option in --nonsense -x --nonsense=1 --quiet=1 -o --grid; do
        wrong_words render "$scenes/balls.nff" $option
    done
    wrong_words info --nonsense x.nff
    wrong_words scene --nonsense balls
    wrong_words compare --nonsense a.png b.png
    wrong_words render "$scenes/balls.nff" -o - --stats -
    wrong_words render "$scenes/balls.nff" -o - --report
    wrong_words render "$scenes/balls.nff" --stats - --report
    wrong_words render "$scenes/balls.nff" --cells plane --approx all --approx-depth 0 --grid 513
    wrong_words render "$scenes/balls.nff" --rules spd --samples 4
    wrong_words "$scenes/balls.nff" a.png -o b.png
    wrong_words compare a.png b.png -o -
}

wrong_values() {
    local pair
    for pair in -o=a.jpg -o=a -o=.png --method=nonsense --approx=nonsense --approx=all, --approx=all,none --approx=none,shadow --approx= --approx-depth=-1 \
        --approx-depth=1.5 --grid=0 --grid=5x5 --grid=5x5x0 --grid=5x5x5x5 --grid=-1 --grid=1e3 --grid=999999999 --grid= \
        --cells=nonsense --curtail=-1 --curtail=nan --curtail=inf --curtail=0x1 --curtail=half --curtail-when=never \
        --memory=-1 --memory=1T --memory=1.5M --memory=M --memory= --memory=99999999999999999999 --size=0x5 --size=5x0 \
        --size=5x --size=x5 --size=5x5x5 --size=-5x5 --size=1000000x1000000 --samples=0 --samples=3 --samples=-4 \
        --depth=0 --depth=-1 --depth=99999999999 --rules=nonsense --rows=5 --rows=5:5 --rows=6:5 --rows=:5 --rows=-1:5 \
        --threads=0 --threads=-1 --threads=x --threads=4294967297 --from=1,2 --from=1,2,3,4 --from=nan,0,0 --at=inf,0,0 \
        --at=1e399,0,0 --up=a,b,c --angle=0 --angle=180 --angle=-5 --angle=nan; do
        wrong_words render "$scenes/balls.nff" "${pair%%=*}" "${pair#*=}"
    done
    for pair in 0 -1 x 99999 1.5 ""; do
        wrong_words scene tetra --size "$pair"
    done
    wrong_words compare a.png b.png -o a.gif
    wrong_words info "$scenes/balls.nff" --grid 0
}

# ---- bad scenes ----

# render refuses the scene FILE in this way and leaves no picture.
bad_file() {
    local start=$1 file=$2 before
    before=$(ls -A)
    tool render "$file" -o picture.png --stats picture.json
    refused 1 "$start"
    [ "$(ls -A)" = "$before" ] || fail "left $(ls -A | tr '\n' ' ')"
    [ ! -s "$out" ] || fail "standard output is not empty"
    tool info "$file"
    (refused 1 "$start") || fail "info: $(cat "$why")"
    [ ! -s "$out" ] || fail "info: standard output is not empty"
}

# The same for a scene with this text (printf's escapes), wrong in this line.
bad_text() {
    printf '%b' "$2" >scene.nff
    bad_file "aset: scene.nff:$1: " scene.nff
}

bad_missing_file() { bad_file "aset: nothing.nff: " nothing.nff; }

bad_empty_file() { bad_text 1 ''; }

bad_blank_file() { bad_text 4 '\n\n  \n'; }

bad_folder() {
    mkdir folder.nff folder
    bad_file "aset: folder.nff: " folder.nff
    bad_file "aset: folder: " folder
}

bad_unknown_extension() {
    cp "$scenes/balls.nff" scene.xyz
    cp "$scenes/balls.nff" nff
    bad_file "aset: scene.xyz: " scene.xyz
    bad_file "aset: nff: " nff
}

bad_name_is_one_line() {
    # a line end in the file's name must not break the error in two
    bad_file "aset: no?where.nff: " "no
where.nff"
}

bad_picture_for_a_scene() {
    works render "$scenes/balls.nff" -s 8x8 -o a.png
    mv a.png a.nff
    bad_file "aset: a.nff:1: " a.nff
}

bad_long_word() {
    { cat "$scenes/balls.nff" && head -c 100000 /dev/zero | tr '\0' a; } >scene.nff
    bad_file "aset: scene.nff:$(($(wc -l <"$scenes/balls.nff") + 1)): " scene.nff
}

bad_scene_on_standard_input() {
    head -n 4 "$scenes/balls.nff" >cut
    status=0
    "$aset" render - -o a.png <cut >"$out" 2>"$err" || status=$?
    refused 1 "aset: "
    grep -q ':[0-9][0-9]*: ' "$err" || fail "no line: $(cat "$err")"
    status=0
    "$aset" render - -o a.png <&- >"$out" 2>"$err" || status=$?
    refused 1 "aset: "
    [ "$(ls -A)" = cut ] || fail "left $(ls -A)"
}

# Appends this text (printf's escapes) to a scene: it is cut off in the line of this number behind the scene's last.
bad_tail() {
    { cat "$1" && printf '%b' "$3"; } >cut.nff
    bad_file "aset: cut.nff:$(($(wc -l <"$1") + $2)): " cut.nff
}

# Files cut off within each kind of entity: the error names the line where the file ends.
bad_cut_off_files() {
    local scene=$scenes/balls.nff lines
    for lines in 1 2 4 7; do
        head -n $lines "$scene" >cut.nff
        bad_file "aset: cut.nff:$((lines + 1)): " cut.nff
    done
    bad_tail "$scene" 1 'f 1 0.5'
    bad_tail "$scene" 3 'f 1 0.5\n\n'
    bad_tail "$scene" 1 's 1 2'
    bad_tail "$scene" 2 'c 1 2 3 1\n'
    bad_tail "$scene" 1 'p'
    bad_tail "$scene" 2 'p 3\n'
    bad_tail "$scene" 3 'p 3\n0 0 0\n'
    bad_tail "$scene" 3 'p 3\n0 0 0\n0.5'
    bad_tail "$scene" 2 'pp 3\n'
    bad_tail "$scene" 3 'pp 3\n0 0 0 0 0 1\n'
    bad_tail "$scene" 2 'pp 3\n0 0 0 0 0'
    bad_tail "$scene" 1 'l 1 2'
    bad_tail "$scene" 1 'l 1 2 3 0.5'
    bad_tail "$scene" 2 'b 0 0\n'
}

# Every seventh prefix of a file is drawn, or refused in one line.
bad_prefixes() {
    local n=0 size
    head -n 16 "$scenes/tetra.nff" >whole
    size=$(wc -c <whole)
    while [ $n -lt "$size" ]; do
        head -c $n whole >cut.nff
        tool render cut.nff -s 4x4 -o a.png
        if [ $status -eq 0 ]; then
            [ -s a.png ] || fail "$n bytes: done, but there is no picture"
            rm a.png
        else
            (refused 1 "aset: cut.nff:") || fail "$n bytes: $(cat "$why")"
            [ ! -e a.png ] || fail "$n bytes: refused, but there is a picture"
        fi
        n=$((n + 7))
    done
}

# View and material for the small texts below: lines 1 to 7 and 8.
view='v\nfrom 0 -5 0\nat 0 0 0\nup 0 0 1\nangle 45\nhither 1\nresolution 16 16\n'
head="${view}f 1 1 1 1 0 0 0 0\n"

bad_letters_for_numbers() {
    bad_text 9 "${head}s 0 a 0 1\n"
    bad_text 9 "${head}s 0 0 0 1x\n"
    bad_text 9 "${head}s 0 0 0x10 1\n"
    bad_text 9 "${head}p three\n"
    bad_text 2 'v\nfrom x y z\n'
    bad_text 8 "${view}f red 0 0 1 0 0 0 0\n"
    bad_text 9 "${head}q 1 2 3\n"
    bad_text 9 "${head}1 2 3\n"
    bad_text 9 "${head}s 0 0 \0000 1\n"
}

bad_nan_and_infinity() {
    local word
    for word in nan NaN -nan inf -inf Infinity 1e999 -1e999 1e39x; do
        bad_text 9 "${head}s 0 0 $word 1\n"
        bad_text 11 "${head}p 3\n0 0 0\n0 $word 0\n1 1 1\n"
        bad_text 8 "${view}f $word 1 1 1 0 0 0 0\n"
        bad_text 2 "v\nfrom 0 $word 0\n"
        bad_text 5 "v\nfrom 0 1 0\nat 0 0 0\nup 0 0 1\nangle $word\n"
        bad_text 9 "${head}l 0 0 $word\n"
    done
}

bad_counts() {
    local points='0 0 0\n1 0 0\n0 1 0\n' word
    for word in 0 -1 -3 1 2 3.5 +-3 4294967296 99999999999999999999; do
        bad_text 9 "${head}p $word\n$points"
        bad_text 9 "${head}pp $word\n$points$points"
    done
    for word in 0 -1 65536 1000000000 1.5; do
        bad_text 7 "${view%resolution*}resolution $word 16\n${head#"$view"}"
        bad_text 7 "${view%resolution*}resolution 16 $word\n${head#"$view"}"
    done
}

bad_announced_but_missing_points() {
    # not a byte may be set aside for what a file only announces
    bad_text 13 "${head}p 1000000000\n0 0 0\n1 0 0\n0 1 0\n"
    bad_text 12 "${head}pp 1000000000\n0 0 0 0 0 1\n1 0 0 0 0 1\n"
    bad_text 13 "${head}p 4\n0 0 0\n1 0 0\n0 1 0\ns 0 0 0 1\n"
}

bad_order() {
    bad_text 2 "f 1 1 1 1 0 0 0 0\ns 0 0 0 1\n$view"
    bad_text 8 "${view}s 0 0 0 1\n"
    bad_text 8 "${view}p 3\n0 0 0\n1 0 0\n0 1 0\n"
    bad_text 2 'f 1 1 1 1 0 0 0 0\n'
}

bad_views() {
    bad_text 1 'v\nfrom 0 0 0\nat 0 0 0\nup 0 0 1\nangle 45\nhither 1\nresolution 16 16\n'
    bad_text 1 'v\nfrom 0 1 0\nat 0 0 0\nup 0 0 0\nangle 45\nhither 1\nresolution 16 16\n'
    bad_text 1 'v\nfrom 0 1 0\nat 0 0 0\nup 0 2 0\nangle 45\nhither 1\nresolution 16 16\n'
    bad_text 5 'v\nfrom 0 1 0\nat 0 0 0\nup 0 0 1\nangle 0\nhither 1\nresolution 16 16\n'
    bad_text 5 'v\nfrom 0 1 0\nat 0 0 0\nup 0 0 1\nangle 180\nhither 1\nresolution 16 16\n'
    bad_text 6 'v\nfrom 0 1 0\nup 0 0 1\nangle 45\nresolution 16 16\nf 1 1 1 1 0 0 0 0\n'
}

bad_objects() {
    bad_text 9 "${head}s 0 0 0 0\n"
    bad_text 9 "${head}c 0 0 0 1 0 0 0 1\n"
    bad_text 9 "${head}c 0 0 0 0 0 0 1 0\n"
    bad_text 9 "${head}c 0 0 0 1 0 0 1 -1\n"
    bad_text 8 "${view}f 1 1 1 -1 0 0 0 0\n"
}

bad_camera_options() {
    local options
    for options in "--from 0,0,0 --at 0,0,0" "--up 0,0,0" "--from 0,0,5 --at 0,0,0 --up 0,0,1"; do
        tool render "$scenes/balls.nff" -o a.png $options
        (refused 1 "aset: ") || fail "$options: $(cat "$why")"
        [ -z "$(ls -A)" ] || fail "$options: left $(ls -A)"
    done
}

# Numbers at the ends of what a float can say: a picture or one line, never a crash.
extreme_coordinates() {
    local object method
    for object in 's 0 0 0 3e38' 's 1e38 1e38 0 1e38\ns -1e38 -1e38 -1e38 3e38' 's 1e38 0 0 1\ns -1e38 0 0 1' \
        'p 3\n3e38 0 0\n-3e38 0 0\n0 3e38 0' 'c 3e38 0 0 1 -3e38 0 0 1' 's 0 0 0 1e19' 's 0 0 0 1e-40' \
        's 1e10 1e10 1e10 1e-10' 'f 1 0 0 0 1 1 1 1e11\ns 0 0 0 1e18' 'f 1 0 0 0 0 0 1 0\ns 0 0 -3e38 1' \
        'p 3\n0 0 0\n1 1 1\n2 2 2' 'p 3\n1 1 1\n1 1 1\n1 1 1'; do
        printf '%b' "$head$object\n" >scene.nff
        for method in mset aset brute; do
            tool render scene.nff -m $method -o a.png
            if [ $status -eq 0 ]; then
                [ ! -s "$err" ] || fail "$object, $method: done, but it says $(head -n 1 "$err")"
                rm a.png
            else
                (refused 1 "aset: scene.nff:") || fail "$object, $method: $(cat "$why")"
            fi
        done
    done
}

scene_text_is_read_freely() {
    # line ends of other systems, no last line end, comments, no objects at all
    works render "$scenes/balls.nff" -s 20x20 -o a.ppm
    sed 's/$/\r/' "$scenes/balls.nff" >scene.nff
    works render scene.nff -s 20x20 -o b.ppm
    same a.ppm b.ppm "carriage returns change the picture"
    { printf '# first\n' && sed 's/$/ # more/' "$scenes/balls.nff" && printf '# last'; } >scene.NFF
    works render scene.NFF -s 20x20 -o b.ppm
    same a.ppm b.ppm "comments change the picture"
    printf '%b' "b 1 0.2 0\n$view" >scene.nff
    works render scene.nff -o c.ppm
    [ "$(tail -c 768 c.ppm | od -An -v -tu1 -w3 | sort -u | tr -s ' ')" = " 255 51 0" ] || fail "no plain background"
}

# ---- memory ----

# With these words exactly the bytes asked for are enough, and one byte less is refused alike. Leaves them in need.
exact_budget() {
    local words=("$@" -s 16x16) least less
    need_of "${words[@]}" --memory 1
    least=$need
    works render "${words[@]}" --memory "$least" --stats s.json -o a.png
    [ "$(json s.json memory budget)" = "$least" ] || fail "$*: the budget is told as $(json s.json memory budget)"
    [ "$(json s.json memory peak)" -le "$least" ] || fail "$*: the peak of $least bytes is $(json s.json memory peak)"
    works render "${words[@]}" --memory $((least + 1)) -o b.png
    same a.png b.png "$*: one byte more gives another picture"
    rm a.png b.png
    for less in $((least - 1)) $((least / 2)); do
        need_of "${words[@]}" --memory $less -o a.png
        [ "$need" = "$least" ] || fail "$*: needs $least bytes by --memory 1, but $need by --memory $less"
        [ ! -e a.png ] || fail "$*: too little memory, but a picture"
    done
}

budget_exact() {
    local scene grid
    for scene in balls tetra; do
        for grid in 1 8 20 3x40x1; do
            exact_budget "$scenes/$scene.nff" --grid $grid
        done
    done
    exact_budget "$scenes/balls.nff" --grid 20 -m brute
}

budget_approximate() {
    local grid
    for grid in 1 8 20 3x40x1; do
        exact_budget "$scenes/balls.nff" --grid $grid --approx all
        exact_budget "$scenes/tetra.nff" --grid $grid --approx all --approx-depth 0
    done
}

# With everything approximate no object is held, with more and with less memory; the picture and the counts are those of a render
# that holds all (whose eye and shadow rays are all that there are).
flat_is_streamed() {
    local scene method key
    for scene in balls tetra; do
        for method in mset grid; do
            works render "$scenes/$scene.nff" -m $method --grid 20 --approx primary,shadow --approx-depth 0 --depth 1 -s 24x24 \
                --stats a.json -o a.ppm
            need_of "$scenes/$scene.nff" -m $method --grid 20 --approx all --approx-depth 0 --depth 1 -s 24x24 --memory 1
            for memory in $need 1M; do
                works render "$scenes/$scene.nff" -m $method --grid 20 --approx all --approx-depth 0 --depth 1 -s 24x24 \
                    --memory "$memory" --stats b.json -o b.ppm
                same a.ppm b.ppm "$scene, $method, $memory: another picture than with the objects"
                for key in structure rays work textures scene; do
                    [ "$(json a.json $key)" = "$(json b.json $key)" ] ||
                        fail "$scene, $method, $memory: $key $(json b.json $key) instead of $(json a.json $key)"
                done
                for key in objects vertices references voxels; do
                    [ "$(json b.json memory $key)" = 0 ] || fail "$scene, $method: $(json b.json memory $key) bytes of $key"
                done
            done
        done
    done
}

budget_of_two_threads() {
    local one
    exact_budget "$scenes/balls.nff" --grid 12 -j 1
    one=$need
    exact_budget "$scenes/balls.nff" --grid 12 -j 2
    [ "$need" -gt "$one" ] || fail "two threads need $need bytes, one needs $one"
    exact_budget "$scenes/balls.nff" --grid 12 -j 2 --approx all --depth 9
}

budget_is_what_info_says() {
    exact_budget "$scenes/balls.nff" --grid 12
    works info "$scenes/balls.nff" --grid 12
    grep '^mset' "$out" | grep -qw "$need" || fail "info does not say $need for mset: $(grep '^mset' "$out")"
    exact_budget "$scenes/balls.nff" --grid 12 --approx all
    works info "$scenes/balls.nff" --grid 12
    grep '^mset' "$out" | grep -qw "$need" || fail "info does not say $need for mset: $(grep '^mset' "$out")"
    for method in mset grid; do
        exact_budget "$scenes/balls.nff" --grid 12 --approx all --approx-depth 0 -m $method
        works info "$scenes/balls.nff" --grid 12
        grep -A 3 "^$method" "$out" | grep -q "no object held: $need bytes" || fail "info does not say $need: $(cat "$out")"
    done
}

# Less and less memory makes the grid coarser and never the picture wrong, until the need is told, which then is enough.
automatic_grid() {
    local memory=65536 scene=$scenes/balls.nff voxels last=999999999
    works render "$scene" -s 20x20 -o full.ppm
    while tool render "$scene" -s 20x20 --grid auto --memory $memory --stats s.json -o a.ppm && [ $status -eq 0 ]; do
        [ ! -s "$err" ] || fail "$memory bytes: $(head -n 1 "$err")"
        [ "$(json s.json memory peak)" -le $memory ] || fail "$memory bytes: the peak is $(json s.json memory peak)"
        same full.ppm a.ppm "$memory bytes: another picture"
        voxels=$(($(json s.json grid | tr -d '[]' | tr ',' '*')))
        [ "$voxels" -le "$last" ] || fail "$memory bytes: $voxels voxels, but $last with more memory"
        last=$voxels
        memory=$((memory * 9 / 10))
    done
    [ "$last" -lt 999999999 ] || fail "64K are too little: $(cat "$err")"
    exact_budget "$scene" --grid auto
    exact_budget "$scene" --grid auto --approx all -j 2
}

# ---- statistics ----

statistics_are_json() {
    local member object
    works render "$scenes/balls.nff" -s 30x30 -m aset --stats s.json
    [ ! -s "$out" ] || fail "words on standard output"
    json_valid s.json
    works render "$scenes/balls.nff" -s 30x30 -m aset --stats -
    json_valid "$out"
    for member in method approx approx_depth cells grid; do
        [ -n "$(json s.json $member)" ] || fail "no $member"
    done
    while read -r object members; do
        for member in $members; do
            json s.json $object $member | grep -Eqx '[0-9]+(\.[0-9]+)?(e-?[0-9]+)?' ||
                fail "$object.$member is '$(json s.json $object $member)'"
        done
    done <<'END'
scene objects polygons patches spheres cones materials lights
structure interior leaves empty nonempty references density
rays primary primary_hit shadow shadow_hit reflected refracted secondary_hit curtailed
work cells_visited nonempty_visited tests test_hits approx_hits
textures used capacity merged
memory budget used peak objects vertices materials cells references voxels textures scratch
time load_s build_s render_s
END
    [ "$(json s.json method)" = '"mset"' ] || fail "method is $(json s.json method)"
    [ "$(json s.json scene spheres)" -eq 91 ] || fail "$(json s.json scene spheres) spheres"
    [ "$(json s.json structure empty)" -eq $(($(json s.json structure leaves) - $(json s.json structure nonempty))) ] ||
        fail "empty is not leaves - nonempty"
}

statistics_are_the_same_for_every_run() {
    local options threads
    for options in "" "-m aset" "-m brute"; do
        for threads in 1 1 2 3; do
            works render "$scenes/balls.nff" -s 30x31 $options -j $threads --stats s.json
            # without the wall clock, and the memory: every thread has a scratch of its own
            sed 's/"memory":.*//' s.json >$threads
            [ "$(wc -c <$threads)" -gt 300 ] || fail "$options: 'memory' is not where it was expected"
            same 1 $threads "$options: other counts with -j $threads: $(cat 1 $threads)"
        done
        mv 1 last
    done
}

report_is_text() {
    works render "$scenes/balls.nff" -s 16x16 --report
    [ "$(wc -l <"$out")" -gt 5 ] || fail "only $(wc -l <"$out") lines"
}

# ---- other commands ----

scenes_are_written() {
    local name
    for name in balls gears mount rings teapot tetra tree snow tetra-moon skull; do
        works scene $name --size 1
        cp "$out" $name.nff
        works scene $name --size=1 -o again.nff
        same $name.nff again.nff "$name: file and standard output differ"
        works render $name.nff -s 16x16 --stats s.json
        [ "$(json s.json scene objects)" -gt 0 ] || fail "$name has no objects"
    done
}

scene_into_render() {
    works render "$scenes/tetra.nff" -s 32x32 -o a.png
    "$aset" scene tetra --size 3 2>"$err" | "$aset" render - -s 32x32 -o x.png 2>>"$err"
    [ "${PIPESTATUS[*]}" = "0 0" ] || fail "status ${PIPESTATUS[*]}: $(cat "$err")"
    [ ! -s "$err" ] || fail "it says: $(head -n 1 "$err")"
    same a.png x.png "not the picture of the file"
    "$aset" render - -s 32x32 -o y.png <"$scenes/tetra.nff" || fail "a file as standard input"
    same a.png y.png "a file as standard input gives another picture"
}

# What comes on standard input is known by how it begins, as a file without a name is.
models_on_standard_input() {
    local name
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n' >a.obj
    printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1\nendloop\nendfacet\nendsolid a\n' >b.stl
    printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n' >c.ply
    printf 'property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 1\n3 0 1 2\n' >>c.ply
    works bake a.obj --grid 8 -o d.draft
    for name in a.obj b.stl c.ply d.draft; do
        works $name file.png -s 24x16
        # shellcheck disable=SC2002
        cat $name | "$aset" - pipe.png -s 24x16 2>"$err" || fail "$name by a pipe: $(cat "$err")"
        same file.png pipe.png "$name by a pipe gives another picture"
        "$aset" render - -o input.png -s 24x16 --approx all --approx-depth 0 --cells plane --memory 1M <$name || fail "$name as standard input"
        same file.png input.png "$name as standard input gives another picture"
    done
    "$aset" info - <b.stl >"$out" || fail "info of a model on standard input"
    status=0
    "$aset" bake - -o e.draft <d.draft >"$out" 2>"$err" || status=$?
    refused 1 "aset: -: a baked draft"
    status=0
    "$aset" render - <&- >"$out" 2>"$err" || status=$?
    refused 1 "aset: -: cannot be read: "
}

compare_figures_and_status() {
    local figure
    works render "$scenes/balls.nff" -s 40x40 -o a.png
    works render "$scenes/balls.nff" -s 40x40 -m aset -o b.png
    works render "$scenes/balls.nff" -s 40x41 -o tall.png
    works compare a.png a.png --json
    json_valid "$out"
    for figure in psnr:99 rmse:0 ssim:1 max_difference:0 differing:0; do
        [ "$(json "$out" "${figure%:*}")" = "${figure#*:}" ] || fail "equal pictures: $(cat "$out")"
    done
    works compare a.png b.png --json -o diff.png
    json_valid "$out"
    awk -v psnr="$(json "$out" psnr)" -v ssim="$(json "$out" ssim)" -v differing="$(json "$out" differing)" \
        'BEGIN { exit !(psnr > 5 && psnr < 98 && ssim > 0 && ssim < 1 && differing > 0 && differing <= 1) }' ||
        fail "different pictures: $(cat "$out")"
    [ "$(png_size diff.png)" = 40x40 ] || fail "the difference is $(png_size diff.png)"
    works compare b.png a.png --json -o diff2.png
    same diff.png diff2.png "the difference depends on the order"
    works compare a.png b.png
    [ -s "$out" ] || fail "no figures without --json"
}

compare_refuses() {
    local bad
    works render "$scenes/balls.nff" -s 40x40 -o a.png
    works render "$scenes/balls.nff" -s 40x41 -o tall.png
    works render "$scenes/balls.nff" -s 40x40 -o a.ppm
    head -c 300 a.png >cut.png
    head -c 300 a.ppm >cut.ppm
    : >empty.png
    cp "$scenes/balls.nff" text.png
    mkdir folder.png
    for bad in tall.png cut.png cut.ppm empty.png text.png folder.png missing.png; do
        tool compare a.png $bad --json -o diff.png
        (refused 1 "aset: $bad: ") || fail "$bad: $(cat "$why")"
        [ ! -s "$out" ] || fail "$bad: figures all the same"
        [ ! -e diff.png ] || fail "$bad: a difference all the same"
    done
    tool compare missing.png a.png
    refused 1 "aset: missing.png: "
}

# The sizes are those of sheet.c's layout: margins of 12, letters of 6 x 10, lines of 12, 4 above a label.
sheet_size() { # WIDTHxHEIGHT, then the words behind -o
    local size=$1
    shift
    works sheet -o s.png "$@"
    [ "$(png_size s.png)" = "$size" ] || fail "sheet $*: $(png_size s.png), expected $size"
}

# A sheet of many pictures goes over none of them.
sheet_keeps_its_pictures() {
    local i
    works render "$scenes/balls.nff" -s 4x3 -o a.ppm
    for i in $(seq 300); do cp a.ppm "p$i.ppm"; done
    tool sheet -o p1.ppm p1.ppm p?.ppm p??.ppm p???.ppm
    refused 1 "aset: p1.ppm: "
    cmp -s p1.ppm a.ppm || fail "the first picture is not what it was"
}

sheet_lays_out() {
    works render "$scenes/balls.nff" -s 40x30 -o a.ppm
    works render "$scenes/tetra.nff" -s 20x50 -o b.png
    sheet_size 116x74 a.ppm b.png
    sheet_size 116x136 a.ppm b.png a.ppm
    sheet_size 168x74 a.ppm b.png a.ppm --columns 9
    sheet_size 64x136 --columns=1 a.ppm b.png
    sheet_size 64x192 --columns 1 a.ppm=one "b.png=two|lines"
    sheet_size 64x228 --columns 1 --title T a.ppm=one "b.png=two|lines"
    sheet_size 83x70 a.ppm=0123456789
    sheet_size 83x106 --title 01234 a.ppm=0123456789
    sheet_size 83x94 --title 012345 a.ppm=0123456789
    sheet_size 149x78 --title "a title of 21 letters" a.ppm
    works sheet -o same.png a.ppm b.png
    works sheet -o - a.ppm= b.png=
    same "$out" same.png "an empty label and none differ, or standard output and a file"
}

# A picture's pixels stand in their place on a white sheet; a label changes what is below only.
sheet_shows_the_pictures() {
    local y
    works render "$scenes/balls.nff" -s 40x30 -o a.ppm
    works sheet -o s.ppm a.ppm
    [ "$(head -n 2 s.ppm | tail -n 1)" = "64 54" ] || fail "the sheet is $(head -n 2 s.ppm | tail -n 1)"
    for y in 0 1 29; do
        tail -c +$((14 + ((y + 12) * 64 + 12) * 3)) s.ppm | head -c 120 >row
        tail -c +$((14 + y * 120)) a.ppm | head -c 120 | cmp -s - row || fail "row $y of the picture is not on the sheet"
    done
    [ "$(tail -c +14 s.ppm | head -c $((12 * 64 * 3)) | tr -d '\377' | wc -c)" -eq 0 ] || fail "the margin is not white"
    works sheet -o t.ppm a.ppm=label
    tail -c +14 t.ppm | head -c $((42 * 64 * 3)) >upper
    tail -c +14 s.ppm | head -c $((42 * 64 * 3)) | cmp -s - upper || fail "a label changes the picture"
    [ "$(tail -c +$((14 + 42 * 64 * 3)) t.ppm | tr -d '\377' | wc -c)" -gt 100 ] || fail "no label to be seen"
}

sheet_refuses() {
    local bad
    for bad in "" "a.png" "-o s.png" "-o s.gif a.png" "-o s.png --columns 0 a.png" "-o s.png --columns x a.png" \
        "-o s.png =label" "-o s.png --nonsense a.png"; do
        wrong_words sheet $bad
    done
    wrong_words sheet -o s.png $'a.png=tab\tstop'
    wrong_words sheet -o s.png a.png --title $'gr\303\274n'
    works render "$scenes/balls.nff" -s 40x40 -o a.png
    head -c 300 a.png >cut.png
    cp "$scenes/balls.nff" text.png
    mkdir folder.png
    echo old >s.png
    for bad in cut.png text.png folder.png missing.png; do
        tool sheet -o s.png a.png=label $bad=label
        (refused 1 "aset: $bad: ") || fail "$bad: $(cat "$why")"
        [ "$(cat s.png)" = old ] || fail "$bad: a sheet all the same"
    done
    tool sheet -o nowhere/s.png a.png
    refused 1 "aset: nowhere/s.png: "
}

# ---- outputs ----

# Standard output (or, with -o in the words, nothing else) cannot be written: one line, status 1.
cannot_write() {
    (refused 1 "aset: ") || fail "$*: $(cat "$why")"
}

full_disk() {
    local command
    if [ ! -c /dev/full ]; then
        echo "no /dev/full here" >"$top/skipped"
        return
    fi
    for command in "--help" "--version" "render --help" "info $scenes/balls.nff" "scene tetra" "scene balls --size 1" \
        "render $scenes/balls.nff -s 16x16 -o -" "render $scenes/balls.nff -s 300x300 -o -" \
        "render $scenes/balls.nff -s 16x16 --stats -" "render $scenes/balls.nff -s 16x16 --report" \
        "compare $scenes/balls.png $scenes/balls.png --json" "sheet -o - $scenes/balls.png"; do
        status=0
        "$aset" $command >/dev/full 2>"$err" || status=$?
        cannot_write "$command"
    done
    ln -s /dev/full full.png
    ln -s /dev/full full.ppm
    for command in "-o full.png" "-o full.ppm" "-o full.ppm -j 3" "--stats full.ppm"; do
        tool render "$scenes/balls.nff" -s 200x200 $command
        cannot_write "$command"
    done
    [ -c /dev/full ] && [ -L full.png ] || fail "the link or the device is gone"
}

file_size_limit() {
    local file
    limit_files 8 || fail "no file size limit can be set"
    echo old >old.ppm
    for file in new.png new.ppm old.ppm; do
        tool render "$scenes/balls.nff" -s 300x300 -o $file
        cannot_write "-o $file"
    done
    [ "$(ls -A) $(cat old.ppm)" = "old.ppm old" ] || fail "left $(ls -A)"
    tool scene balls --size 4 -o new.nff
    cannot_write "scene"
    [ "$(ls -A) $(cat old.ppm)" = "old.ppm old" ] || fail "scene left $(ls -A)"
}

closed_pipe() {
    local command
    for command in "scene balls --size 4" "render $scenes/balls.nff -s 16x16 -o -" \
        "render $scenes/balls.nff -s 16x16 --stats -" "info $scenes/balls.nff" "--help"; do
        # the reader has ended long before the first byte
        { sleep 0.1 && "$aset" $command 2>"$err"; } | true
        status=${PIPESTATUS[0]}
        cannot_write "$command | true"
    done
    "$aset" scene balls --size 4 2>"$err" | head -c 10 >/dev/null
    status=${PIPESTATUS[0]}
    cannot_write "scene | head"
    for command in "scene balls --size 1" "render $scenes/balls.nff -s 16x16 -o -" "--version"; do
        status=0
        "$aset" $command >&- 2>"$err" || status=$?
        cannot_write "$command with standard output closed"
    done
}

outputs_that_cannot_be() {
    mkdir folder.png
    for output in nowhere/a.png folder.png /a/b/c.ppm; do
        tool render "$scenes/balls.nff" -s 16x16 -o $output
        (refused 1 "aset: $output: ") || fail "-o $output: $(cat "$why")"
    done
    tool render "$scenes/balls.nff" -s 16x16 --stats nowhere/s.json
    refused 1 "aset: nowhere/s.json: "
    tool scene tetra -o nowhere/s.nff
    refused 1 "aset: nowhere/s.nff: "
    [ "$(ls -A)" = folder.png ] || fail "left $(ls -A)"
    # the longest path that there may be, which ends with a slash
    local path=nowhere/
    while [ ${#path} -lt 4095 ]; do path=$path/; done
    tool scene tetra -o "$path"
    refused 1 "aset: $path: "
    tool render "$scenes/balls.nff" -s 8x8 -o a.png -qo b.png
    refused 2 "aset: --output: it goes to a.png already"
    tool "$scenes/balls.nff" a.png -s 8x8 -qo b.png
    refused 2 "aset: --output: it goes to a.png already"
    for words in "scene snow" "bake $scenes/balls.nff" "compare a.ppm b.ppm" "join a.ppm" "sheet a.ppm" "tables" "thumb $scenes/balls.nff" \
        "trade $scenes/balls.nff"; do
        # shellcheck disable=SC2086
        tool $words -o one.png -o two.png
        refused 2 "aset: --output: it goes to one.png already, expected no two"
    done
    if [ -w /dev/full ]; then
        "$aset" trade "$scenes/tetra.nff" -o t --quick -s 8 --grids 4 -m mset >/dev/full 2>"$err"
        status=$?
        refused 1 "aset: standard output: "
    fi
}

# What is read, or already an output, is not written over, whatever name it goes by.
outputs_that_are_taken() {
    cp "$scenes/balls.nff" a.nff
    chmod 600 a.nff
    cp a.nff before
    ln -s a.nff link
    ln a.nff hard
    works render a.nff -s 8x8 -o a.png
    cp a.png b.png
    mkdir sub
    local output words
    for output in a.nff ./a.nff sub/../a.nff link hard; do
        for words in "render a.nff -s 8x8 --stats $output" "render a.nff -s 8x8 --png -o $output" "plan a.nff -s 8x8 --header $output" \
            "bake a.nff -o $output"; do
            # shellcheck disable=SC2086
            tool $words
            [ $status -eq 1 ] && cmp -s a.nff before || fail "aset $words: status $status, or the scene is gone"
        done
    done
    printf 'mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n' >m.obj
    printf 'newmtl m\nKd 1 0 0\n' >m.mtl
    cp m.mtl library
    for words in "render m.obj -s 8 --stats m.mtl" "render m.obj -s 8 --png -o m.mtl" "plan m.obj -s 8 --header m.mtl" "bake m.obj -o m.mtl"; do
        # shellcheck disable=SC2086
        tool $words
        cmp -s m.mtl library || fail "aset $words: the library is gone"
    done
    tool render a.nff -s 8x8 -o a.png --stats sub/../a.png
    refused 1 "aset: a.png: "
    cmp -s a.png b.png || fail "a picture is gone"
    works render a.nff -s 8x8 -o a.png
    works render a.nff -s 8x8 -o a.png
    ln -s a.png picture.png
    for words in "compare a.png b.png -o a.png" "compare a.png b.png -o picture.png" "join a.png b.png -o b.png" \
        "sheet a.png=one b.png -o sub/../a.png"; do
        # shellcheck disable=SC2086
        tool $words
        [ $status -ne 0 ] && cmp -s a.png b.png || fail "aset $words: status $status, or a picture is gone"
    done
    works join a.png b.png -o c.png
    works join c.png b.png -o d.png
}

# Plan and trade take the camera and what models get, as render does.
words_of_render_elsewhere() {
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n' >a.obj
    works plan a.obj -s 32 --from 3,2,2 --at 0,0,0 --up 0,1,0 --angle 30 --up-axis z --ground off --smooth --json
    works trade a.obj --quick -m grid --grids 4 -s 16 --from 3,2,2 --angle 30 --ground off -o one -q
    works trade a.obj --quick -m grid --grids 4 -s 16 --from 3,2,2 --angle 60 --ground off -o two -q
    for words in one two; do awk -F, 'NR > 1 { print $1, $2, $14, $15 }' $words/trade.csv >$words.rays; done
    ! cmp -s one.rays two.rays || fail "another camera sees the same"
    tool plan a.obj -s 32 --from 0,0,0 --at 0,0,0
    refused 1 "aset: a.obj: "
    tool plan a.obj -s 32 --header - --json
    refused 2 "aset: plan: --header: "
    works plan a.obj -s 32 --header -
    [ "$(head -n 1 "$out")" = "/*" ] || fail "the header on standard output begins with $(head -n 1 "$out")"
    mkdir 'a*'
    cp a.obj 'a*/b.obj'
    works plan 'a*/b.obj' -s 16 --header plan.h
    ! grep -qF 'a*/b' plan.h || fail "a path ends the comment that it stands in"
}

# What nothing exact fits in, and no pixel differs in, is planned all the same; a scene too large for a draft has other rows.
plan_and_info_at_the_edges() {
    works plan "$scenes/tetra.nff" -s 32 --memory 4000 --from 0,0,100 --at 0,0,200 --up 0,1,0
    printf 'v\nfrom 0 0 1e21\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\nf 1 1 1 1 0 1 0 1\ns 0 0 0 1e20\n' >huge.nff
    works info huge.nff
    grep -q '^draft *none: ' "$out" || fail "info of a huge scene: $(tail -n 1 "$out")"
    works "$scenes/balls.nff" a.png -m octree --octree-depth 4 -s 8
    # of a model -m aset is what it is elsewhere, and no draft
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one.obj
    works one.obj a.png -m aset -s 32
    works render one.obj -m aset -o b.png -s 32
    same a.png b.png "-m aset draws another picture of a model in the short form"
    works one.obj a.png -s 32
    works render one.obj --approx all --approx-depth 0 --cells plane --memory 1M -o b.png -s 32
    same a.png b.png "the short form is no draft"
}

# A plan keeps to what is asked for or says that it cannot; brute force, the last resort, is looked at where it does.
plan_keeps_its_word() {
    works scene snow -o snow.nff
    local need words
    need_of snow.nff -m brute -s 64 --memory 1
    for words in "" "--error 30" "--error 99" "--time 1e6"; do
        # shellcheck disable=SC2086
        works plan snow.nff -s 64 --memory $need $words --json
        [ "$(json "$out" method)" = '"brute"' ] && [ "$(json "$out" approx)" = '"none"' ] || fail "$words: $(cat "$out")"
    done
    works plan snow.nff -s 64 --memory $((need - 1)) --json
    [ "$(json "$out" approx)" = '"all"' ] || fail "one byte less: $(cat "$out")"
    tool plan snow.nff -s 64 --memory $((need - 1)) --error 60
    refused 1 "aset: snow.nff: no setting within $((need - 1)) bytes has 60 dB"
}

# A tree's depth is 6 unless said}

# What is given of a setting is not chosen, and render takes the words of the plan within its bytes.
plan_takes_renders_words() {
    local scene=$scenes/balls.nff words given
    while read -r given words; do
        # shellcheck disable=SC2086
        works plan "$scene" -s 48 $words --json -q
        [ "$(json "$out" method) $(json "$out" grid) $(json "$out" approx) $(json "$out" approx_depth)" = "$(echo "$given" | tr _ ' ')" ] ||
            fail "$words: $(cat "$out")"
        # shellcheck disable=SC2086
        works render "$scene" -s 48 $words --memory "$(json "$out" bytes)"
    done <<'END'
"grid"_"9x9x9"_"none"_1 --method grid --grid 9
"mset"_"9x8x7"_"shadow"_0 --method mset --grid 9x8x7 --approx shadow --approx-depth 0
"set"_"6x6x6"_"primary,reflected"_1 --method set --grid 6 --approx primary,reflected --curtail 0.1 --curtail-when more --depth 2 --samples 4
"grid"_"9x9x9"_"all"_0 --method grid --grid 9 --approx all --approx-depth 0
"brute"_"1x1x1"_"none"_1 --method brute
"mset"_"9x9x9"_"all"_1 --method aset --grid 9
"mset"_"9x9x9"_"shadow"_1 --method aset --grid 9 --approx shadow
END
    tool plan "$scene" -s 48 --memory 100 --grid 9 --approx none
    refused 1 "aset: $scene: the picture needs "
    tool plan "$scene" --method octree
    refused 2 "aset: --method: "
    tool plan "$scene" --leaf 2
    refused 2 "aset: --leaf: "
    for words in "--grid 4" "--approx shadow" "--approx-depth 0"; do
        # shellcheck disable=SC2086
        tool plan "$scene" --method brute $words
        refused 2 "aset: plan: --method: "
    done
    # drafts, if they are asked for: closer in little memory, and enough of it
    works scene teapot --size 4 -o pot.nff
    tool plan pot.nff -s 64 --memory 30K --error 23
    refused 1 "aset: pot.nff: no setting within 30720 bytes has 23 dB"
    grep -q -e "--cells plane" "$err" || fail "no word of drafts: $(cat "$err")"
    for given in "--memory 30K --error 23" "--memory 30K" "--memory 30K --grid 9 --approx all --approx-depth 0"; do
        # shellcheck disable=SC2086
        works plan pot.nff -s 64 $given --cells plane --json
        [ "$(json "$out" cells)" = '"plane"' ] || fail "$given: $(cat "$out")"
        words="--method $(json "$out" method) --grid $(json "$out" grid) --approx all --approx-depth 0 --cells plane --memory $(json "$out" bytes)"
        cp "$out" plan.json
        works render pot.nff -s 64 $(echo "$words" | tr -d '"') -o draft.png
        works render pot.nff -s 64 -o exact.png
        awk -v told="$(json plan.json psnr)" -v is="$(psnr exact.png draft.png)" 'BEGIN { exit !(told - is < 1.5 && is - told < 1.5) }' ||
            fail "$given: $(cat plan.json), and it has $(psnr exact.png draft.png) dB"
    done
    tool plan pot.nff --cells plane --header plan.h
    refused 2 "aset: plan: --cells: "
    tool plan pot.nff --cells plane -m set
    refused 2 "aset: plan: --cells: "
    # more memory is not worse
    works scene snow -o snow.nff
    works plan snow.nff -s 64 --memory 1000 --json
    given=$(json "$out" psnr)
    works plan snow.nff -s 64 --memory 2000 --json
    awk -v more="$(json "$out" psnr)" -v less="$given" 'BEGIN { exit !(more >= less - 1) }' || fail "in 1000 bytes $given dB, in 2000 $(json "$out" psnr)"
    # by the SPD's rules what transmits reflects too, so the program needs that code
    printf 'v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nresolution 32 32\nl 0 5 5\nf 1 1 1 0.5 0 1 0.5 1.3\ns 0 0 0 1\n' >glass.nff
    works plan glass.nff --header usual.h
    works plan glass.nff --header spd.h --rules spd
    [ "$(diff usual.h spd.h | grep '^[<>].*WITH' | xargs)" = "< #define ASET_WITH_REFLECTION 0 > #define ASET_WITH_REFLECTION 1" ] ||
        fail "the headers differ: $(diff usual.h spd.h | xargs)"
}

# A tree's depth is 6 unless said otherwise, and never less in silence.
tree_depth_is_kept() {
    works render "$scenes/balls.nff" -s 8x8 -m octree --stats s.json
    local need
    need=$(json s.json memory peak)
    works render "$scenes/balls.nff" -s 8x8 -m octree --memory "$need" --stats t.json
    [ "$(json s.json structure interior)" = "$(json t.json structure interior)" ] || fail "another tree"
    tool render "$scenes/balls.nff" -s 8x8 -m octree --memory $((need - 1))
    refused 1 "aset: $scenes/balls.nff: the picture needs $need bytes, has "
}

# A failure leaves the old picture; a success keeps its mode, and the link to it.
old_output() {
    echo old >a.ppm
    chmod 640 a.ppm
    ln -s a.ppm link.ppm
    head -n 4 "$scenes/balls.nff" >cut.nff
    tool render cut.nff -o a.ppm
    [ $status -eq 1 ] && [ "$(cat a.ppm)" = old ] || fail "a bad scene changes the old picture"
    tool render "$scenes/balls.nff" --memory 1 -o a.ppm
    [ $status -eq 1 ] && [ "$(cat a.ppm)" = old ] || fail "too little memory changes the old picture"
    works render "$scenes/balls.nff" -s 8x8 -o link.ppm
    [ -L link.ppm ] && [ "$(head -n 1 a.ppm)" = P6 ] || fail "the link is not followed"
    [ "$(ls -l a.ppm | cut -c1-10)" = -rw-r----- ] || fail "the mode is now $(ls -l a.ppm | cut -c1-10)"
}

# A signal in the middle of a picture ends the tool and leaves neither a part of the new file nor a change of the old one.
interrupted() {
    local signal pid tries threads=1
    set -m # or else the job would ignore SIGINT, as jobs in the background do
    echo old >a.png
    for signal in INT:130 TERM:143 HUP:129 QUIT:131 XCPU:152 USR1:138; do
        ulimit -c 0
        # what this shell was started to ignore, no job of it can be made to hear
        case $(trap -p "${signal%:*}") in *"''"*) continue ;; esac
        "$aset" render "$scenes/balls.nff" -m brute -s 400x30000 --samples 64 -j $threads -o a.png >/dev/null 2>"$err" &
        pid=$! tries=0
        until [ -n "$(find . -name '.aset*')" ]; do
            tries=$((tries + 1))
            [ $tries -lt 200 ] || { kill -KILL $pid; fail "$signal: no picture in progress after 10 s"; }
            sleep 0.05
        done
        kill -s ${signal%:*} $pid
        status=0
        wait $pid || status=$?
        [ $status -eq ${signal#*:} ] || fail "${signal%:*}: status $status"
        [ "$(ls -A) $(cat a.png)" = "a.png old" ] || fail "${signal%:*}: left $(ls -A)"
        threads=$((threads + 1))
    done
}

# The bar is drawn on a terminal only, and not there when --quiet is given.
progress_bar() {
    local words="$aset render $scenes/balls.nff -m brute -s 400x400"
    if ! script -qec true /dev/null </dev/null >/dev/null 2>&1; then
        echo "no script(1) that gives a terminal" >"$top/skipped"
        return
    fi
    script -qec "$words" /dev/null </dev/null >bar 2>&1 || fail "status $? on a terminal"
    grep -q '%' bar || fail "no bar on a terminal"
    script -qec "$words --quiet" /dev/null </dev/null >none 2>&1 || fail "status $? with --quiet"
    [ ! -s none ] || fail "--quiet: $(head -c 80 none)"
}

# The paper's tables: without times two runs agree to the byte; with them a row for each of the paper's.
tables_repeat_their_counts() {
    works tables --size 12 --rounds 0 -o a.txt
    works tables --size=12 --rounds=0
    same a.txt "$out" "two runs differ"
    [ "$(grep -c '^Snow 30 ' a.txt)" -ge 6 ] || fail "Snow 30 stands in $(grep -c '^Snow 30 ' a.txt) tables"
    ! grep -q ' 0\.00 (' a.txt || fail "a time of nothing: $(grep -m 1 ' 0\.00 (' a.txt)"
    grep -q '^Tetra 10 .* 1[01]\.[0-9]* (11\.40) ' a.txt || fail "no density of Tetra 10 near 11.4"
    works tables --size 9 --rounds 2 --markdown
    [ "$(grep -c '^## ' "$out")" -eq 5 ] || fail "$(grep -c '^## ' "$out") headings"
    [ "$(grep -c '^| Gears, deep |' "$out")" -eq 7 ] || fail "the last row stands in $(grep -c '^| Gears, deep |' "$out") tables"
    awk -F'|' '/^\|/ { if (n && NF != n) exit 1; n = NF; next } { n = 0 }' "$out" || fail "rows of unequal columns"
    rm a.txt
    wrong_words tables scene.nff
    wrong_words tables --size 0
    wrong_words tables --rounds 100
    tool tables --size 4 --rounds 0 -o missing/a.txt
    refused 1 "aset: missing/a.txt: "
}

# ---- trade ----

# Columns by name, for awk: c["psnr"] is its number.
trade_columns='BEGIN { FS = "," } NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next }'

trade_table() {
    works trade "$scenes/balls.nff" tetra:2 -o t -m mset,octree,brute --grids 4,auto --octree-depths 2 -s 24x24,16x20 --rounds 2
    # mset twice, octree, brute; exact, and four approximations with and without curtailment; two drafts of mset; two sizes;
    # two scenes
    [ "$(wc -l <t/trade.csv)" -eq $((1 + (4 * 9 + 2 * 2) * 2 * 2)) ] || fail "$(wc -l <t/trade.csv) lines"
    for column in scene method grid octree_depth approx level cells curtail size build_s render_s rays tests cells_visited \
        peak_bytes psnr rmse ssim max_difference differing best; do
        head -n 1 t/trade.csv | tr ',' '\n' | grep -qx $column || fail "no column $column: $(head -n 1 t/trade.csv)"
    done
    [ "$(awk -F, '{ print NF }' t/trade.csv | sort -u | wc -l)" -eq 1 ] || fail "rows of different length"
    awk "$trade_columns"' $c["approx"] == "none" && ($c["psnr"] != 99 || $c["differing"] != 0 || $c["max_difference"] != 0) { exit 1 }' \
        t/trade.csv || fail "an exact setting is not equal to the exact picture"
    awk "$trade_columns"' $c["build_min_s"] > $c["build_s"] || $c["build_s"] > $c["build_max_s"] ||
        $c["render_min_s"] > $c["render_s"] || $c["render_s"] > $c["render_max_s"] { exit 1 }' t/trade.csv ||
        fail "a median outside its spread"
    [ ! -e t/trade.csv.partial ] || fail "the partial file is still there"
}

trade_best_marks() {
    works trade "$scenes/balls.nff" tetra:2 -o t --quick -s 24x24 -q
    [ ! -s "$out" ] || fail "--quiet: $(head -n 1 "$out")"
    awk "$trade_columns"' {
            n++; scene[n] = $1; time[n] = int(1e6 * ($c["build_s"] + $c["render_s"]) + 0.5)
            bytes[n] = $c["peak_bytes"] + 0; error[n] = $c["rmse"] + 0; best[n] = $c["best"]
        }
        END {
            for (i = 1; i <= n; i++) {
                mark = 1
                for (k = 1; k <= n; k++)
                    if (scene[k] == scene[i] && time[k] <= time[i] && bytes[k] <= bytes[i] && error[k] <= error[i] &&
                        (time[k] < time[i] || bytes[k] < bytes[i] || error[k] < error[i])) mark = 0
                if (mark != best[i]) { print "row " i ": best is " best[i]; exit 1 }
                any[scene[i]] += mark
            }
            for (s in any) if (any[s] == 0) { print s ": none is best"; exit 1 }
        }' t/trade.csv >"$noise" || fail "$(cat "$noise")"
}

# The figures are those of render and compare, and peak_bytes is enough for render.
trade_says_what_render_says() {
    works trade "$scenes/balls.nff" -o t -m mset,grid,arts --grids 6,20 --octree-depths 3 --cells flat,normal,plane -s 24x24 \
        --rounds 1
    trade_says_the_same "$scenes/balls.nff" 24x24
    # flat: four of each space; drafts: two kinds, of mset all rays and shadows, of grid shadows
    [ "$(wc -l <rows)" -eq $((5 * 4 + 2 * (2 * 2 + 2))) ] || fail "$(wc -l <rows) rows"
}

# $1: the scene of t/trade.csv; $2: its size; $3: words that it was swept with; $4: the curtailment of the rows, if not 0.5.
trade_says_the_same() {
    local words
    # shellcheck disable=SC2086
    works render "$1" -s "$2" -o exact.png ${3-}
    awk "$trade_columns"' $c["cells"] != "" && $c["size"] == "'"$2"'" && ($c["curtail"] == '"${4-0.5}"' || $c["cells"] != "flat") {
        print $c["method"], $c["grid"] == "" ? "--octree-depth=" $c["octree_depth"] : "--grid=" $c["grid"], $c["approx"],
            $c["level"], $c["cells"], $c["peak_bytes"], $c["tests"], $c["cells_visited"], $c["psnr"] }' t/trade.csv >rows
    while read -r method divisions approx level kind bytes tests cells db; do
        words="-m $method $divisions --approx $approx --approx-depth $level --cells $kind --memory $bytes ${3-}"
        # shellcheck disable=SC2086
        works render "$1" $words -s "$2" -o a.png --stats a.json
        [ "$(json a.json work tests) $(json a.json work cells_visited)" = "$tests $cells" ] || fail "$words: other counts"
        [ "$(psnr exact.png a.png)" = "$db" ] || fail "$words: psnr $(psnr exact.png a.png), the table says $db"
    done <rows
}

# The words of render that say how rays are followed are trade's, too, and a sweep with other ones does not go on from there.
trade_takes_renders_words() {
    local words="--depth 3 --samples 4 --leaf 3 --curtail 0.3 --curtail-when more"
    # shellcheck disable=SC2086
    works trade "$scenes/balls.nff" -o t -m mset,octree --grids 6 --octree-depth 3 --cells flat,plane -s 24x24 --rounds 1 $words \
        --approx reflected
    trade_says_the_same "$scenes/balls.nff" 24x24 "$words" 0.3
    [ "$(wc -l <rows)" -eq 3 ] || fail "$(wc -l <rows) rows"
    works trade "$scenes/balls.nff" -o t -m mset --grids 6 -s 24x24 --rounds 1 --depth 1 --approx-depth 0
    [ "$(awk "$trade_columns"' { print $c["approx"] $c["level"] $c["curtail"] }' t/trade.csv | xargs)" = "none all00.5 all00 all0" ] ||
        fail "other settings than all rays from depth 0"
    works trade "$scenes/balls.nff" -o t -m aset --grids 6 -s 24x24 --rounds 1 --cells flat
    [ "$(awk "$trade_columns"' { print $c["method"] $c["approx"] $c["level"] $c["curtail"] }' t/trade.csv | xargs)" = "msetnone msetall10.5 msetall10" ] ||
        fail "aset is not mset with all rays from depth 1"
    works trade "$scenes/balls.nff" -o t -m aset,grid --grids 6 -s 24x24 --rounds 1 --cells flat --approx none
    [ "$(awk "$trade_columns"' { print $c["method"] $c["approx"] }' t/trade.csv | sort | xargs)" = "gridnone msetnone" ] || fail "aset among others"
    works trade "$scenes/balls.nff" -o t -m mset --grids 6 -s 24x24 --rounds 1 --approx none
    [ "$(wc -l <t/trade.csv)" -eq 2 ] || fail "not only the exact setting"
    works trade "$scenes/balls.nff" -o t -m mset,octree --grids 6 --octree-depth 3 --cells flat,plane -s 24x24 --rounds 1 --rules spd
    trade_says_the_same "$scenes/balls.nff" 24x24 "--rules spd"
    [ "$(wc -l <rows)" -eq 10 ] || fail "$(wc -l <rows) rows"
    tool trade "$scenes/balls.nff" -o t --rules spd --samples 4
    refused 2 "aset: --rules: the SPD procedure has one ray a pixel corner"
}

# With --memory the table is the one without less the settings that need more, exact ones apart; those are not called best.
trade_within_memory() {
    local sweep="trade $scenes/balls.nff -m mset,grid --grids 8,24 -s 24x24 --rounds 1" bytes
    works $sweep -o all
    bytes=$(awk "$trade_columns"' { print $c["peak_bytes"] }' all/trade.csv | sort -n | uniq | sed -n 4p) # of some it is the need
    works $sweep -o t --memory "$bytes"
    grep -qx "$(awk "$trade_columns"' $c["approx"] != "none" && $c["peak_bytes"] > '"$bytes"' { n++ } END { print n }' all/trade.csv) settings need more than $bytes bytes and are left out" "$out" ||
        fail "it does not say how many are left out"
    for table in all t; do
        awk "$trade_columns"' $c["approx"] == "none" || $c["peak_bytes"] <= '"$bytes"' { print $1, $2, $3, $4, $5, $6, $7, $8, $c["peak_bytes"] }' \
            $table/trade.csv >$table.rows
    done
    same all.rows t.rows "other settings than those that fit"
    [ "$(wc -l <t/trade.csv)" -eq $((1 + $(wc -l <t.rows))) ] || fail "there are settings that do not fit"
    awk "$trade_columns"' $c["best"] == 1 && $c["peak_bytes"] > '"$bytes"' { exit 1 }' t/trade.csv || fail "what does not fit is best"
}

# A model's view depends on the picture's shape, and its materials come from another file.
trade_of_a_model() {
    {
        echo "mtllib model.mtl"
        printf 'v %s\n' "0 0 0" "2 0 0" "1 2 0" "1 1 1.5"
        printf 'usemtl red\nf 1 3 2\nf 1 2 4\nusemtl blue\nf 2 3 4\nf 3 1 4\n'
    } >model.obj
    printf 'newmtl red\nKd 0.8 0.1 0.1\nnewmtl blue\nKd 0.1 0.1 0.9\n' >model.mtl
    works trade model.obj -o t -m mset --grids 8 -s 30x20,20x30 --rounds 1
    [ "$(wc -l <t/trade.csv)" -eq 23 ] || fail "$(wc -l <t/trade.csv) lines"
    trade_says_the_same model.obj 30x20
    trade_says_the_same model.obj 20x30
}

trade_resumes() {
    local tries sweep="trade $scenes/balls.nff -o t -m mset --grids 8 -s 40x40 --rounds 99"
    # shellcheck disable=SC2086
    "$aset" $sweep >/dev/null 2>&1 &
    # a tool that never begins is not waited for: 2000 times 0.01 s at least
    for ((tries = 0; tries < 2000; tries++)); do
        [ -e t/trade.csv.partial ] && [ "$(wc -l <t/trade.csv.partial)" -gt 5 ] && break
        kill -0 $! 2>/dev/null || fail "the sweep ended before it was interrupted"
        sleep 0.01
    done
    [ $tries -lt 2000 ] || { kill -KILL $!; fail "the sweep does not begin"; }
    kill -KILL $! && wait $! 2>/dev/null
    [ ! -e t/trade.csv ] || fail "the table is there before its time"
    # a time that no measurement gives, and a line that was cut off
    awk 'BEGIN { FS = OFS = "," } NR == 2 { $12 = 777000000 } { print }' t/trade.csv.partial >p
    printf 'deadbeef' >>p
    cp p t/trade.csv.partial
    # shellcheck disable=SC2086
    tool $sweep --grids 9
    refused 1 "aset: t/trade.csv.partial:2: "
    same p t/trade.csv.partial "a refused file was changed"
    # shellcheck disable=SC2086
    works $sweep
    [ "$(wc -l <t/trade.csv)" -eq 12 ] || fail "$(wc -l <t/trade.csv) lines"
    [ "$(grep -c ',777\.000000,' t/trade.csv)" -eq 1 ] || fail "what was measured before is not in the table"
    [ ! -e t/trade.csv.partial ] || fail "the partial file is still there"
}

# One file, whole in itself: no other file, address or script; with plots where there is gnuplot, and without where not.
trade_page() {
    works trade "$scenes/balls.nff" -o t --quick -s 24x24
    grep -q '</html>' t/trade.html || fail "the page does not end"
    [ "$(grep -o 'src="data:image/png;base64,iVBORw0KGgo' t/trade.html | wc -l)" -eq 7 ] || fail "not seven pictures within"
    ! grep -oE '(src|href)="[^d#][^"]*"|<script|@import|url\([^#]' t/trade.html || fail "it refers to something outside"
    [ "$(grep -c '<tr class="best"><td>best' t/trade.html)" -eq "$(awk -F, '$NF == 1' t/trade.csv | wc -l)" ] || fail "other marks"
    if command -v gnuplot >/dev/null; then
        [ "$(grep -c '</svg>' t/trade.html)" -eq 2 ] || fail "not two plots within"
        [ "$(find t -name '*.svg' | wc -l)" -eq 2 ] || fail "not two plots beside"
    fi
    PATH= works trade "$scenes/balls.nff" -o u --quick -s 24x24
    grep -q 'no gnuplot' "$out" || fail "it does not say that there are no plots"
    ! grep -q '<svg' u/trade.html || fail "a plot without gnuplot"
}

trade_refuses() {
    wrong_words trade
    wrong_words trade balls balls
    wrong_words trade balls -o -
    wrong_words trade balls --sizes 8x8,8x8
    wrong_words trade balls --grids 8,,9
    wrong_words trade balls --grids 8,8
    wrong_words trade balls --octree-depths 3,3
    wrong_words trade balls --samples 3
    wrong_words trade balls --approx mirrored
    wrong_words trade balls --depth 0
    wrong_words trade balls --methods mset,other
    wrong_words trade balls --rounds 0
    wrong_words trade balls --cells flat,round
    wrong_words trade balls --methods octree --cells plane
    wrong_words trade balls --grids 16,513
    tool trade nosuch
    refused 1 "aset: nosuch: "
    tool trade balls:0
    refused 1 "aset: balls:0: "
    echo old >file
    tool trade balls --quick -s 8x8 -o file
    refused 1 "aset: file: "
}

# ---- the run ----

mkdir "$scenes"
"$aset" scene balls --size 2 -o "$scenes/balls.nff" && "$aset" scene tetra --size 3 -o "$scenes/tetra.nff" &&
    "$aset" render "$scenes/balls.nff" -s 16x16 -o "$scenes/balls.png" || {
    echo "not ok scenes: the scenes of the cases cannot be made"
    exit 1
}

cases="
pictures_png_ppm_and_standard_output picture_has_the_scene_s_size picture_shows_something rules_spd_draws_corners
short_form option_values_with_and_without_equals camera_options method_aset_is_mset_approximating mset_equals_brute
brute_tests_every_object_for_every_ray threads_draw_the_same_picture rows_are_pieces_of_the_picture
help_and_version wrong_commands wrong_options wrong_values bad_missing_file bad_empty_file bad_blank_file
bad_folder bad_unknown_extension bad_name_is_one_line bad_picture_for_a_scene bad_long_word
bad_scene_on_standard_input bad_cut_off_files bad_prefixes bad_letters_for_numbers bad_nan_and_infinity bad_counts
bad_announced_but_missing_points bad_order bad_views bad_objects bad_camera_options extreme_coordinates
scene_text_is_read_freely budget_exact budget_approximate flat_is_streamed budget_of_two_threads budget_is_what_info_says
automatic_grid statistics_are_json statistics_are_the_same_for_every_run report_is_text scenes_are_written
scene_into_render models_on_standard_input compare_figures_and_status compare_refuses tables_repeat_their_counts sheet_lays_out sheet_shows_the_pictures sheet_keeps_its_pictures sheet_refuses
full_disk file_size_limit closed_pipe outputs_that_cannot_be outputs_that_are_taken words_of_render_elsewhere plan_and_info_at_the_edges plan_keeps_its_word plan_takes_renders_words tree_depth_is_kept old_output interrupted progress_bar
trade_table trade_best_marks trade_says_what_render_says trade_takes_renders_words trade_within_memory trade_of_a_model trade_resumes trade_page trade_refuses
"
# shellcheck disable=SC2086
run_cases $cases
