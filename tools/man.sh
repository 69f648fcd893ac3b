#!/bin/bash
# The pages aset(1) and libaset(3), from `aset --help`, `aset COMMAND --help` and the public headers: man.sh ASET DIRECTORY
set -eu
aset=$1
out=$2
here=$(dirname "$0")
include=$here/../include/aset
mkdir -p "$out"
version=$(sed -n 's/^#define ASET_VERSION "\(.*\)"/\1/p' "$include/config.h")
date=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(stat -c %Y "$include/config.h" 2>/dev/null || date +%s)}" +%Y-%m-%d 2>/dev/null ||
    date -u +%Y-%m-%d)
records() { "$aset" "$@" --help | awk -f "$here/help.awk"; }
commands() { records | awk -F'\t' '$1 == "part" { on = $2 == "Commands" } $1 == "item" && on { print $2 }'; }

aset_1() {
    printf '.TH ASET 1 %s "libaset %s" "User Commands"\n' "$date" "$version"
    printf '.SH NAME\naset \\- draws scenes and models exactly or as approximate drafts, in a fixed amount of memory\n'
    printf '.SH SYNOPSIS\n'
    records | awk -F'\t' '$1 == "part" { exit } $1 == "item" { print (n++ ? ".br\n" : "") $2 }' | sed 's/-/\\-/g; s/\.\.\./\\\&.../'
    printf '.SH DESCRIPTION\n'
    records | sed 's/^usage\taset\td/usage\taset\tD/' | awk -v own=1 -f "$here/man-tool.awk"
    printf '.SH COMMANDS\n'
    for command in $(commands); do
        records "$command" | awk -f "$here/man-tool.awk"
    done
    printf '.SH EXAMPLES\nA thumbnail of a model, within one megabyte:\n.PP\n.nf\n.in +4n\n'
    printf 'aset model.stl thumbnail.png \\-s 256\n.in\n.fi\n.PP\nA scene, exactly, and the memory that each method would need:\n'
    printf '.PP\n.nf\n.in +4n\naset scene gears \\-\\-size 2 \\-o gears.nff\naset render gears.nff \\-o gears.png \\-\\-report\n'
    printf 'aset info gears.nff \\-\\-grid 30\n.in\n.fi\n.PP\n'
    printf 'Half a picture here and half of it there, joined to the bytes of the whole:\n.PP\n.nf\n.in +4n\n'
    printf 'aset render gears.nff \\-\\-rows 0:256 \\-o top.png\naset render gears.nff \\-\\-rows 256:512 \\-o bottom.png\n'
    printf 'aset join top.png bottom.png \\-o gears.png\n.in\n.fi\n'
    printf '.SH SEE ALSO\n.BR libaset (3)\n'
}

libaset_3() {
    printf '.TH LIBASET 3 %s "libaset %s" "Library Functions"\n' "$date" "$version"
    printf '.SH NAME\nlibaset \\- exact and approximate ray tracing in a memory budget fixed at compile time\n'
    printf '.SH SYNOPSIS\n.nf\n#include <aset/aset.h>\n#include <aset/load.h>\n#include <aset/procedural.h>\n.fi\n.PP\n'
    printf 'Compile and link with\n.I pkg\\-config \\-\\-cflags \\-\\-libs libaset\n'
    (
        cd "$include"
        awk -f "$OLDPWD/$here/man-headers.awk" aset.h config.h types.h arena.h scene.h stage.h space.h summary.h flat.h draft.h reach.h beams.h \
            trace.h report.h load.h procedural.h
    )
    printf '.SH SEE ALSO\n.BR aset (1)\n'
}

aset_1 > "$out/aset.1"
libaset_3 > "$out/libaset.3"
