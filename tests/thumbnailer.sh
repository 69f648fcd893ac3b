#!/bin/bash
# The desktop's thumbnails: thumbnailer.sh ASET CONVERT [PATTERN]
#
# The entry that is installed, its words filled in as file managers fill them, run in a sandbox as theirs: no network, a root
# that is read-only and holds little, the model read-only, one folder to write to. Then odd names, copies without an ending,
# names of pictures without one, broken files; and the MIME types. As tool.sh: one line for each case.
set -u
if [ $# -lt 2 ] || [ ! -x "$1" ] || [ ! -x "$2" ]; then
    echo "usage: bash tests/thumbnailer.sh build/aset build/tests/convert [PATTERN]" >&2
    exit 1
fi
if ! command -v bwrap >/dev/null; then
    echo "thumbnailer: skipped, there is no bwrap (package bubblewrap)"
    exit 0
fi
if ! bwrap --ro-bind / / --unshare-all true 2>/dev/null; then
    echo "thumbnailer: skipped, bwrap may not make a sandbox here: $(bwrap --ro-bind / / --unshare-all true 2>&1 | head -n 1)"
    exit 0
fi
aset=$1
convert=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
pattern=${3:-*}
suite=thumbnailer
project=$PWD
. "$(dirname "$0")/support/cases.sh"
# the libraries that the tool was linked with
sandbox_root="--ro-bind /usr /usr"
for folder in /lib /lib32 /lib64 /bin; do
    if [ -L $folder ]; then
        sandbox_root="$sandbox_root --symlink $(readlink $folder | sed 's|^/||') $folder"
    elif [ -d $folder ]; then
        sandbox_root="$sandbox_root --ro-bind $folder $folder"
    fi
done
[ ! -e /etc/ld.so.cache ] || sandbox_root="$sandbox_root --ro-bind /etc/ld.so.cache /etc/ld.so.cache"

# Runs words in the sandbox; of the folder out everything may be written, of the model in $1 nothing; leaves status, $err.
sandboxed() {
    local model=$1
    shift
    status=0
    # shellcheck disable=SC2086
    bwrap $sandbox_root --ro-bind "$(dirname "$aset")" /app --setenv PATH /app --dev /dev --unshare-all --die-with-parent \
        --chdir / --bind "$PWD/out" /out --ro-bind "$PWD/$model" "/in/$model" --remount-ro / "$@" >"$top/out.txt" 2>"$err" \
        </dev/null || status=$?
}

# The words of the entry for a model, a picture and a size, in the array words.
entry_words() {
    local word
    words=()
    for word in $(sed -n 's/^Exec=//p' "$project/tools/desktop/aset.thumbnailer"); do
        case $word in
        %i) words+=("$1") ;;
        %o) words+=("$2") ;;
        %s) words+=("$3") ;;
        *) words+=("$word") ;;
        esac
    done
}

png_kind() { # width height channel-code
    od -An -tu1 -j16 -N10 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8, $10 }'
}

# A model, a picture's name, a size: drawn without a word, and nothing else is left.
thumbnail() {
    local model=$1 picture=$2 size=$3
    rm -rf out
    mkdir out
    : >"out/$picture" # file managers make the file first
    entry_words "/in/$model" "/out/$picture" "$size"
    sandboxed "$model" "${words[@]}"
    [ $status -eq 0 ] || fail "$model: status $status: $(head -n 1 "$err")"
    [ ! -s "$err" ] && [ ! -s "$top/out.txt" ] || fail "$model: done, but it says: $(head -n 1 "$err" "$top/out.txt")"
    [ "$(ls -A out)" = "$picture" ] || fail "$model: left $(ls -A out)"
    [ "$(png_kind "out/$picture")" = "${size}x$size 2" ] || fail "$model: $(png_kind "out/$picture") instead of $size"
}

# The sandbox keeps what it promises: else the other cases say nothing.
the_sandbox_is_one() {
    mkdir out
    cp "$scenes/a.stl" .
    sandboxed a.stl aset scene balls --size 1 -o /balls.nff
    [ $status -eq 1 ] || fail "the root can be written: status $status"
    sandboxed a.stl aset scene balls --size 1 -o /in/balls.nff
    [ $status -eq 1 ] || fail "the model's folder can be written"
    sandboxed a.stl aset scene balls --size 1 -o /out/balls.nff
    [ $status -eq 0 ] && [ -s out/balls.nff ] || fail "the picture's folder cannot be written: $(cat "$err")"
    sandboxed a.stl /usr/bin/sh -c 'test -e /home || test -e /root || test -e /etc/passwd'
    [ $status -eq 1 ] || fail "the user's files are there"
}

all_formats_and_sizes() {
    local format size
    for format in stl obj ply nff; do
        cp "$scenes/a.$format" .
        for size in 128 256; do
            thumbnail a.$format thumbnail.png $size
            works a.$format expected.png -s $size
            same out/thumbnail.png expected.png "$format: not the picture that is drawn outside"
        done
    done
    thumbnail a.stl thumbnail.png 1024
    works a.stl expected.png -s 1024
    same out/thumbnail.png expected.png "1024: not the picture that is drawn outside"
}

odd_names() {
    local name
    works "$scenes/a.stl" expected.png -s 64
    for name in "with a space.stl" UPPER.STL -dash.stl "--png.stl" "quote's \"and\" \$(x).stl" "ends in a dot..stl" "%s %i.stl" \
        "$(printf 'Sch\303\266n.Stl')" "$(printf 'new\nline.stl')" .hidden.stl; do
        cp "$scenes/a.stl" "./$name"
        thumbnail "$name" thumbnail.png 64
        same out/thumbnail.png expected.png "$name: another picture"
    done
    for name in .gnome_desktop_thumbnail.X7RQ2A "no ending" odd.ppm picture.PNG; do
        cp "$scenes/a.stl" a.stl
        thumbnail a.stl "$name" 64
        same "out/$name" expected.png "into $name: another picture"
    done
}

copies_without_an_ending() {
    local file
    for file in a.stl text.stl a.obj plain.obj commented.obj a.ply text.ply; do
        cp "$scenes/$file" copy-123
        thumbnail copy-123 thumbnail.png 64
        works "$scenes/$file" expected.png -s 64
        same out/thumbnail.png expected.png "$file by its bytes: another picture"
        cp copy-123 "copy.$file.tmp"
        thumbnail "copy.$file.tmp" thumbnail.png 64
        same out/thumbnail.png expected.png "$file by its bytes: another picture"
    done
    for file in letter empty picture another; do
        case $file in
        letter) echo "Dear Sir, this is no model" >$file ;;
        empty) : >$file ;;
        picture) cp expected.png $file ;;
        another) cp "$scenes/a.nff" $file ;; # NFF needs its name
        esac
        mkdir -p out
        tool "$file" x.png -s 64
        [ $status -eq 1 ] || fail "$file: status $status"
        grep -q "^aset: $file: neither a scene by its name nor a model or draft by its first bytes" "$err" || fail "$file: $(cat "$err")"
        [ ! -e x.png ] || fail "$file: a picture"
    done
}

broken_models_leave_nothing() {
    local size
    head -c 200 "$scenes/a.stl" >cut.stl
    rm -rf out && mkdir out && echo old >out/t.png
    entry_words /in/cut.stl /out/t.png 64
    sandboxed cut.stl "${words[@]}"
    [ $status -eq 1 ] || fail "status $status"
    [ "$(wc -l <"$err")" -eq 1 ] || fail "$(wc -l <"$err") lines"
    grep -q '^aset: /in/cut.stl: ' "$err" || fail "it says $(cat "$err")"
    [ "$(ls -A out)" = t.png ] && [ "$(cat out/t.png)" = old ] || fail "the picture of before is touched, or more is left"
    cp "$scenes/a.stl" .
    for size in 0 -1 x ""; do
        entry_words /in/a.stl /out/t.png "$size"
        sandboxed a.stl "${words[@]}"
        [ $status -eq 2 ] || fail "size '$size': status $status"
    done
}

installed_files() {
    command -v make >/dev/null || fail "no make"
    local root=$PWD/root
    make -s -C "$project" install-share DESTDIR="$root" PREFIX=/usr BUILD="$(dirname "$aset")" >log 2>&1 ||
        fail "make install-share: $(tail -n 1 log)"
    same root/usr/share/thumbnailers/aset.thumbnailer "$project/tools/desktop/aset.thumbnailer" "no thumbnailer is installed"
    [ -s root/usr/share/mime/packages/libaset.xml ] || fail "no MIME types are installed"
    if ! command -v update-mime-database >/dev/null; then
        echo "no update-mime-database: the types are not looked up" >"$top/skipped"
        return
    fi
    XDG_DATA_DIRS=$root/usr/share update-mime-database root/usr/share/mime >log 2>&1 || fail "update-mime-database: $(head -n 1 log)"
    [ ! -s log ] || fail "update-mime-database says $(head -n 1 log)"
    local type
    for type in stl obj ply x-nff; do
        grep -q "model/$type:\*.${type#x-}\$" root/usr/share/mime/globs2 || fail "*.${type#x-} has no type"
        grep -q "^MimeType=\(.*;\)\{0,1\}model/$type;" root/usr/share/thumbnailers/aset.thumbnailer ||
            fail "model/$type has no thumbnailer"
    done
    if command -v xdg-mime >/dev/null; then # by name, as file managers do first
        cp "$scenes/a.ply" .
        type=$(XDG_DATA_HOME=$PWD/root/usr/share XDG_DATA_DIRS=$PWD/root/usr/share:/usr/share xdg-mime query filetype a.ply 2>/dev/null)
        case $type in model/ply | "") ;; *) fail "xdg-mime takes a PLY for $type" ;; esac
    fi
}

mkdir "$scenes"
for format in stl:a.stl stl-ascii:text.stl obj:plain.obj ply-le:a.ply ply-ascii:text.ply; do
    awk 'BEGIN { print "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4" }' >"$scenes/a.obj"
    "$convert" "$scenes/a.obj" "$scenes/${format#*:}" "${format%:*}" || exit 1
done
{ echo "# a comment, then a blank line" && echo && cat "$scenes/a.obj"; } >"$scenes/commented.obj"
"$aset" scene balls --size 2 -o "$scenes/a.nff" || exit 1
run_cases the_sandbox_is_one all_formats_and_sizes odd_names copies_without_an_ending broken_models_leave_nothing installed_files
