#!/bin/bash
# models.sh - the program aset on models: bash tests/models.sh build/aset build/tests/convert [PATTERN]
#
# As tool.sh: one line for each case, `ok NAME` or `not ok NAME: why`; each case is a function that runs in an empty folder
# of its own. The cases make their models themselves; with a folder of further models, ../shared/models, those are drawn too.
set -u

if [ $# -lt 2 ] || [ ! -x "$1" ] || [ ! -x "$2" ]; then
    echo "usage: bash tests/models.sh build/aset build/tests/convert [PATTERN]" >&2
    exit 1
fi
aset=$1
convert=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
pattern=${3:-*}
more=$(cd "$(dirname "$0")/.." && pwd)/../shared/models
suite=models
. "$(dirname "$0")/support/cases.sh"

# ---- checks ----

# Done, with exactly this line on standard error.
works_and_says() {
    local line=$1
    shift
    tool "$@"
    [ $status -eq 0 ] || fail "aset $*: status $status: $(head -n 1 "$err")"
    [ "$(cat "$err")" = "$line" ] || fail "aset $*: it says: $(cat "$err")"
}

# Status, the start of the only line on standard error, words.
refuses() {
    local expected=$1 start=$2
    shift 2
    tool "$@"
    [ $status -eq "$expected" ] || fail "aset $*: status $status, expected $expected; said: $(head -n 1 "$err")"
    [ "$(wc -l <"$err")" -eq 1 ] || fail "aset $*: $(wc -l <"$err") lines on standard error"
    case $(cat "$err") in
    "$start"*) ;;
    *) fail "aset $*: the line does not begin with '$start': $(cat "$err")" ;;
    esac
}

# A bumpy ball of $1 rings, as an OBJ of polygons, with a normal at each vertex. Its numbers are whole parts of 4096, which
# float and double read alike.
ball() {
    awk -v n="$1" '
    function part(x) { return int(x * 4096 + 8192) / 4096 - 2 }
    BEGIN {
        pi = atan2(0, -1)
        for (i = 0; i <= n; i++) for (j = 0; j < n; j++) {
            u = pi * i / n; v = 2 * pi * j / n; r = 1 + 0.1 * sin(3 * u) * cos(4 * v)
            printf "v %.12f %.12f %.12f\n", part(r * sin(u) * cos(v)), part(r * cos(u)), part(r * sin(u) * sin(v))
            printf "vn %.6f %.6f %.6f\n", sin(u) * cos(v), cos(u), sin(u) * sin(v)
        }
        for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
            a = i * n + j + 1; b = i * n + (j + 1) % n + 1
            printf "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, b + n, b + n, a + n, a + n
        }
    }'
}

formats="obj:obj stl:stl stl-ascii:stl ply-ascii:ply ply-le:ply ply-be:ply"
draft="--approx all --approx-depth 0 --cells plane --grid 24"
flat="--approx all --approx-depth 0 --cells flat --grid 24"

# ---- pictures ----

# An OBJ and what it is converted to: the same picture, exact and drafted.
same_in_all_formats() {
    local pair way file
    for way in "" "$draft" "--approx shadow --approx-depth 0 --cells plane --grid 24"; do
        # shellcheck disable=SC2086
        works render "$1" --up-axis y --depth 1 -s 48x36 --memory 32M $way -o first.png
        for pair in $formats; do
            file=model-${pair%:*}.${pair#*:}
            "$convert" "$1" "$file" "${pair%:*}" || fail "cannot be converted to ${pair%:*}"
            # shellcheck disable=SC2086
            works render "$file" --up-axis y --depth 1 -s 48x36 --memory 32M $way -o other.png
            same first.png other.png "$1 as ${pair%:*}, $way: another picture"
        done
    done
}

all_formats() {
    ball 24 >ball.obj
    same_in_all_formats ball.obj
}

all_formats_of_further_models() {
    [ -d "$more" ] || { echo "no further models" >"$top/skipped" && exit 0; }
    local model
    for model in "$more"/*.obj; do
        "$convert" "$model" base.obj obj # as floats, which is what the other formats hold
        same_in_all_formats base.obj
    done
}

short_form_is_a_draft() {
    ball 24 >ball.obj
    works ball.obj short.png -s 40
    works render ball.obj --approx all --approx-depth 0 --cells plane --memory 1M --size 40x40 -o long.png
    same short.png long.png "not the picture of render"
    works ball.obj other.png -s 40 --grid 9
    cmp -s short.png other.png && fail "further options change nothing"
    return 0
}

# Little memory means several passes over the file, and fewer divisions: a picture all the same.
little_memory() {
    local memory
    ball 40 >ball.obj
    for memory in 1M 700K 500K 300K 200K; do
        works render ball.obj --approx all --approx-depth 0 --cells plane --memory $memory -s 32 -o a.png
    done
    refuses 1 "aset: ball.obj: the draft needs " render ball.obj $draft --memory 8K -s 32
}

# More vertices than the window holds: they go to a file.
many_vertices() {
    ball 320 >ball.obj
    "$convert" ball.obj ball.stl stl
    works render ball.obj $draft -s 32 -o obj.png
    works render ball.stl $draft -s 32 --up-axis y -o stl.png
    same obj.png stl.png "another picture with spilt vertices"
    works render ball.obj $flat -s 32 -o obj.png
    works render ball.stl $flat -s 32 --up-axis y -o stl.png
    same obj.png stl.png "another flat picture with spilt vertices"
}

# Flat cells hold no triangle: what is held does not grow with them, in the arena or beside it, and the picture is that of a
# render that holds all (whose eye and shadow rays are all that there are).
flat_holds_no_triangle() {
    local method small large
    ball 16 >small.obj
    ball 256 >ball.obj
    "$convert" ball.obj ball.stl stl
    for method in mset grid; do
        works render small.obj $flat --method $method -s 32 --stats s.json
        small=$(sed -n 's/.*"peak":\([0-9]*\).*/\1/p' s.json)
        works render ball.stl $flat --method $method -s 32 --depth 1 --up-axis y --memory 64K --stats s.json -o a.png
        large=$(sed -n 's/.*"peak":\([0-9]*\).*/\1/p' s.json)
        [ "$large" -lt $((2 * small)) ] || fail "$method: 131072 triangles take $large bytes, 512 take $small"
        grep -q '"objects":0,"vertices":0,' s.json || fail "$method: objects are held: $(cat s.json)"
        works render ball.stl --grid 24 --approx primary,shadow --approx-depth 0 --method $method -s 32 --depth 1 --up-axis y \
            --memory 32M -o b.png
        same a.png b.png "$method: another picture than with all triangles held"
    done
    (ulimit -v 24576 && "$aset" --help >/dev/null 2>&1) || return 0 # a sanitizer's memory
    (ulimit -v 24576 && "$aset" render ball.stl $flat -s 32 --up-axis y --memory 64K) 2>"$err" ||
        fail "within 24 MB of address space: $(head -n 1 "$err")"
}

axes_and_ground() {
    ball 12 >ball.obj
    "$convert" ball.obj ball.stl stl
    works render ball.obj -s 32 -o obj.png
    works render ball.stl -s 32 -o stl.png
    cmp -s obj.png stl.png && fail "obj and stl have the same axis up by default"
    works render ball.stl -s 32 --up-axis y -o y.png
    same obj.png y.png "--up-axis y of an stl is not the obj's picture"
    works render ball.obj -s 32 --up-axis z -o z.png
    same stl.png z.png "--up-axis z of an obj is not the stl's picture"
    works render ball.obj -s 32 --ground on -o on.png
    same obj.png on.png "--ground on is not the default"
    works render ball.obj -s 32 --ground off -o off.png
    cmp -s obj.png off.png && fail "--ground off changes nothing"
    works render ball.obj -s 32 --smooth -o smooth.png
    cmp -s obj.png smooth.png && fail "--smooth changes nothing"
    return 0
}

# Nothing of the model is cut off at the border, however the picture is shaped.
the_view_fits() {
    local size
    ball 12 >ball.obj
    for size in 40x40 80x20 20x80; do
        works render ball.obj -s $size --ground off -o a.ppm
        tail -c +"$(($(head -n 3 a.ppm | wc -c) + 1))" a.ppm | od -An -v -tu1 -w$((3 * ${size%x*})) >rows
        # the sky's colour all along the border
        awk -v n="$(wc -l <rows)" '
            NR == 1 { sky = $1 " " $2 " " $3 }
            $1 " " $2 " " $3 != sky || $(NF - 2) " " $(NF - 1) " " $NF != sky { bad = 1 }
            { for (i = 1; i <= NF; i += 3) if ($i " " $(i + 1) " " $(i + 2) != sky) { n_seen++; bad += NR == 1 || NR == n } }
            END { exit bad || n_seen < 60 }' rows || fail "$size: the border is not all sky"
    done
}

transparent() {
    ball 12 >ball.obj
    works ball.obj a.png -s 40 --transparent
    [ "$(od -An -tu1 -j25 -N1 a.png | tr -d ' ')" = 6 ] || fail "no RGBA"
    works ball.obj b.png -s 40 --transparent --ground on
    cmp -s a.png b.png && fail "--ground on is not heard"
    refuses 2 "aset: --transparent: " render ball.obj --transparent -o a.ppm
}

colours() {
    local unknown="aset: a.obj: 1 times usemtl names no known material, the default one stands in: a.mtl:"
    local missing="aset: a.obj: 1 times usemtl names no material of any library, the default one stands in"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl red\nf 1 2 3\n' >a.obj
    mkdir d && cp a.obj d
    works_and_says "$unknown No such file or directory" render a.obj -s 16 -o none.png
    printf 'newmtl red\nKd 1 0 0\n' >a.mtl
    works render a.obj -s 16 -o red.png
    cmp -s none.png red.png && fail "the library changes nothing"
    cp a.mtl d
    works render d/a.obj -s 16 -o folder.png
    same red.png folder.png "the library beside an OBJ in another folder is not found"
    printf 'newmtl blue\nKd 0 0 1\n' >a.mtl
    works_and_says "$missing" render a.obj -s 16
    printf 'newmtl red\nKd 1 x\n' >a.mtl
    refuses 1 "aset: a.mtl:2: " render a.obj -s 16
    rm a.mtl && mkdir a.mtl
    works_and_says "$unknown Is a directory" render a.obj -s 16
}

# File managers hand over copies whose names say nothing, and want a PNG in a file called anything.
names_of_any_kind() {
    local pair way
    ball 8 >ball.obj
    for pair in $formats; do
        "$convert" ball.obj model."${pair#*:}" "${pair%:*}"
        cp model."${pair#*:}" copy
        works model."${pair#*:}" named.png -s 24
        works copy nameless.png -s 24
        same named.png nameless.png "${pair%:*} by its bytes: another picture"
        works copy .thumbnail.XYZ --png -s 24 -q
        same named.png .thumbnail.XYZ "${pair%:*}: --png draws another picture"
    done
    works render copy -s 24 --png -o ppm.ppm --transparent
    [ "$(od -An -c -N4 ppm.ppm | tr -d ' ')" = '211PNG' ] || fail "--png is no PNG: $(od -An -c -N4 ppm.ppm)"
    refuses 2 "aset: .thumbnail.XYZ: cannot tell the kind of picture " copy .thumbnail.XYZ -s 24
    { printf '# %s\n\n' "a comment" && cat ball.obj; } >copy
    works copy nameless.png -s 24
    printf 'v\nfrom 0 0 5\n' >copy # NFF needs its name
    refuses 1 "aset: copy: neither a scene by its name nor a model or draft by its first bytes" copy a.png
    printf 'plain text\n' >copy
    refuses 1 "aset: copy: neither " copy a.png
    : >copy
    refuses 1 "aset: copy: neither " copy a.png
    head -c 90 /dev/zero >copy
    refuses 1 "aset: copy: neither " copy a.png
    [ ! -e a.png ] || fail "there is a picture"
}

# ---- bad files ----

bad_parts_are_counted() {
    printf 'solid\nfacet normal 0 0 0 outer loop vertex 0 0 nan vertex 1 0 0 vertex 0 1 0 endloop endfacet\n%s\nendsolid\n' \
        "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet" >a.stl
    tool render a.stl -s 16 -o a.png
    [ $status -eq 0 ] && [ "$(wc -l <"$err")" -eq 1 ] || fail "status $status, $(wc -l <"$err") lines"
    grep -q '^aset: a.stl: 1 of 2 facets left out: ' "$err" || fail "it says: $(cat "$err")"
    tool info a.stl
    grep -q '^left out    1 facets' "$out" || fail "info does not say so"
}

bad_files() {
    local format way size
    printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >index.obj
    refuses 1 "aset: index.obj:3: " render index.obj -s 16 -o a.png
    printf 'v 0 0 0\nv 1 x 0\n' >word.obj
    refuses 1 "aset: word.obj:2: " render word.obj -s 16 -o a.png
    for format in obj stl ply; do
        : >empty.$format
        refuses 1 "aset: empty.$format:" render empty.$format -s 16 -o a.png
        refuses 1 "aset: nosuch.$format: " render nosuch.$format -s 16 -o a.png
    done
    printf 'v 1e15 1e15 1e15\nv -1e15 0 0\nv 0 -1e15 0\nf 1 2 3\n' >large.obj
    tool render large.obj -s 16 # in double it is not too large
    [ $status -eq 0 ] || refuses 1 "aset: large.obj: the model is too large " render large.obj -s 16 -o a.png
    ball 8 >ball.obj
    for way in stl:stl ply-le:ply ply-ascii:ply stl-ascii:stl; do
        "$convert" ball.obj whole "${way%:*}"
        size=$(wc -c <whole)
        for part in 10 60 90 300 $((size / 2)) $((size - 20)); do
            head -c "$part" whole >cut.${way#*:}
            refuses 1 "aset: cut.${way#*:}:" cut.${way#*:} a.png -s 16
        done
    done
    # a binary file of four thousand million triangles, it says
    { head -c 80 /dev/zero && printf '\377\377\377\377' && head -c 500 /dev/zero; } >lies.stl
    refuses 1 "aset: lies.stl: " lies.stl a.png -s 16
    [ ! -e a.png ] || fail "there is a picture"
}

odd_models() {
    printf 'v 5 5 5\nf 1 1 1\n' >point.obj
    works render point.obj -s 16
    works point.obj point.png -s 16
    printf 'v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\nf 1 2 3 4\n' >flat.obj
    works render flat.obj -s 16
    works flat.obj flat.png -s 16
}

# ---- words ----

wrong_words() {
    ball 4 >ball.obj
    for word in --up-axis=x --up-axis= --ground=yes --smooth=1 --transparent=1; do
        refuses 2 "aset: " render ball.obj "$word"
    done
    for method in set octree arts excell brute; do
        refuses 2 "aset: --method: $method has no drafts" render ball.obj --approx all --cells plane -m $method
        refuses 2 "aset: --method: $method has no drafts" render ball.obj --approx all --cells normal -m $method
    done
    works render ball.obj --approx all --cells normal -m grid -s 16
}

info_of_a_model() {
    ball 12 >ball.obj
    works info ball.obj --grid 16
    grep -q '^objects     288: 288 polygons, 0 patches' "$out" || fail "objects: $(grep '^objects' "$out")"
    grep -q '^vertices    156$' "$out" || fail "vertices: $(grep '^vertices' "$out")"
    grep -Eq '^low +-1\.[0-9.]+ -1 -1' "$out" || grep -q '^low ' "$out" || fail "no bounds"
    grep -q '^draft       16 x 16 x 16: [1-9][0-9]* bytes$' "$out" || fail "draft: $(grep '^draft' "$out")"
    # the bytes are those of a picture
    need=$(sed -n 's/^mset .* exact \([0-9]*\) bytes.*/\1/p' "$out")
    works render ball.obj --grid 16 -s 16 --memory "$need"
    refuses 1 "aset: ball.obj: the picture needs $need bytes" render ball.obj --grid 16 -s 16 --memory $((need - 1))
}

times_are_told_apart() {
    ball 100 >ball.obj
    works render ball.obj $draft -s 16 --stats s.json
    awk 'match($0, /"load_s":[0-9.]+,"build_s":[0-9.]+/) {
        split(substr($0, RSTART, RLENGTH), t, /[:,]/); found = t[2] > 0 && t[4] > 0 } END { exit !found }' s.json ||
        fail "load and build: $(grep -o '"time".*' s.json)"
}

# ---- the run ----

cases="
all_formats all_formats_of_further_models short_form_is_a_draft little_memory many_vertices flat_holds_no_triangle axes_and_ground the_view_fits
transparent colours names_of_any_kind bad_parts_are_counted bad_files odd_models wrong_words info_of_a_model times_are_told_apart
"
# shellcheck disable=SC2086
run_cases $cases
