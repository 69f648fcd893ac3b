#!/bin/bash
# A model that turns, frame by frame, by GNU parallel: it is baked once, and each job draws the draft from another side. The
# folder gets frame-0000.png and so on; each is whole or not there.
#
#     bash frames.sh MODEL FOLDER FRAMES [options of aset render]
#
# With ASET_DIVISIONS=128 or so for finer drafts than 64; ASET names the program if it is not in the PATH.
set -eu
if [ $# -lt 3 ]; then
    echo "usage: frames.sh MODEL FOLDER FRAMES [options of aset render]" >&2
    exit 2
fi
aset=${ASET:-aset} model=$1 folder=$2 frames=$3
shift 3
mkdir -p "$folder"
work=$(mktemp -d "$folder/.frames.XXXXXX")
trap 'rm -rf "$work"' EXIT
case ${model,,} in *.obj) up=y ;; *) up=z ;; esac
"$aset" bake "$model" --grid "${ASET_DIVISIONS:-64}" --up-axis $up -o "$work/model.draft" --quiet
# Round the middle of the model's box, on the circle from which aset's own view (stage.h) looks: from c along
# (-0.5, 0.4, 1), as far as the sphere round the box is seen under 30 degrees.
"$aset" info "$model" --up-axis $up --ground off | awk -v n="$frames" -v up=$up '
    $1 == "low" { for (i = 1; i <= 3; i++) low[i] = $(i + 1) }
    $1 == "high" { for (i = 1; i <= 3; i++) high[i] = $(i + 1) }
    END {
        pi = atan2(0, -1)
        for (i = 1; i <= 3; i++) {
            c[i] = (low[i] + high[i]) / 2
            r += (high[i] - low[i]) ^ 2 / 4
        }
        far = sqrt(r) / sin(pi / 12)
        flat = far * sqrt(1.25 / 1.41)
        rise = far * 0.4 / sqrt(1.41)
        for (k = 0; k < n; k++) {
            a = 2 * pi * k / n + atan2(-0.5, 1)
            right = flat * sin(a)
            front = flat * cos(a)
            if (up == "y") {
                printf "%g,%g,%g\t%g,%g,%g\t0,1,0", c[1] + right, c[2] + rise, c[3] + front, c[1], c[2], c[3]
            } else {
                printf "%g,%g,%g\t%g,%g,%g\t0,0,1", c[1] + right, c[2] - front, c[3] + rise, c[1], c[2], c[3]
            }
            printf "\t%04d\n", k
        }
    }' >"$work/list"
parallel --quote --colsep '\t' --halt now,fail=1 \
    "$aset" render "$work/model.draft" "$@" --from '{1}' --at '{2}' --up '{3}' -o "$folder/frame-{4}.png" --quiet \
    <"$work/list" 2>"$work/log" || {
    grep '^aset: ' "$work/log" >&2 || cat "$work/log" >&2
    exit 1
}
