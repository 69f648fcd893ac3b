#!/bin/bash
# What a cell may remember, rung by rung, as pictures side by side and as a table: ladder.sh ASET DIRECTORY [MODEL ...]
#
# Scenes: gears, mount and tetra of size 8, and the models given. 512 x 512, 64 divisions, eye and shadow rays only (--depth 1)
# but for the row "plane, full depth". The sheet shows 256 x 256. PSNR against the exact picture of 16 samples a pixel; time is build and drawing of the
# median of RUNS (3) interleaved runs, as a ratio to the exact picture at one sample, built and drawn.
set -eu
export LC_ALL=C
aset=$1
dir=$2
shift 2
runs=${RUNS:-3}
mkdir -p "$dir"
"$aset" scene gears -o "$dir/gears.nff"
"$aset" scene mount -o "$dir/mount.nff"
"$aset" scene tetra --size 8 -o "$dir/tetra.nff"
set -- "$dir/gears.nff" "$dir/mount.nff" "$dir/tetra.nff" "$@"

figure() { grep -o "\"$2\":[-+0-9.e]*" "$1" | head -n 1 | cut -d: -f2; }
kept() { grep -o '"memory":{"budget":[0-9]*,"used":[0-9]*' "$1" | grep -o '[0-9]*$'; }
seconds() { echo "$(figure "$1" build_s) $(figure "$1" render_s)" | awk '{ print $1 + $2 }'; }
median() { sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
decibels() { "$aset" compare --json "$1" "$2" | grep -o '"psnr":[0-9.]*' | cut -d: -f2; }

draft="--approx all --approx-depth 0 --grid 64"
shadow="--approx shadow --approx-depth 0 --grid 64"
rungs=(
    "exact, one sample|--approx none|1"
    "flat, the paper's|$draft --cells flat|1"
    "normal|$draft --cells normal|1"
    "plane|$draft --cells plane|1"
    "plane, 128 divisions|--approx all --approx-depth 0 --grid 128 --cells plane|1"
    "exact eye rays, flat shadows|$shadow --cells flat|1"
    "exact eye rays, plane shadows|$shadow --cells plane|1"
    "plane, full depth|$draft --cells plane|5"
)

draw() { # SCENE WORDS DEPTH OUT [SIDE]: OUT.png, OUT.json
    # shellcheck disable=SC2086
    "$aset" render "$1" $2 --depth "$3" --memory 256M --quiet -s "${5:-512}x${5:-512}" -o "$4.png" --stats "$4.json"
}

{
    echo "| scene | cells remember | bytes kept | bytes at the peak | time, exact = 1 | PSNR, dB |"
    echo "|---|---|---|---|---|---|"
} > "$dir/table.md"
pictures=()
for scene in "$@"; do
    name=$(basename "${scene%.*}")
    for depth in 1 5; do
        "$aset" render "$scene" --depth $depth --samples 16 --memory 256M --quiet -s 512x512 -o "$dir/$name-reference-$depth.png"
    done
    rm -f "$dir/$name"-*.times
    for run in $(seq "$runs"); do
        for i in "${!rungs[@]}"; do
            IFS='|' read -r label words depth <<< "${rungs[i]}"
            draw "$scene" "$words" "$depth" "$dir/$name-$i"
            [ "$i" -gt 0 ] || base=$(seconds "$dir/$name-0.json")
            echo "$(seconds "$dir/$name-$i.json") $base" | awk '{ print $1 / $2 }' >> "$dir/$name-$i.times"
        done
    done
    draw "$scene" "--samples 16" 1 "$dir/$name-small" 256
    pictures+=("$dir/$name-small.png=$name|exact, 16 samples")
    for i in "${!rungs[@]}"; do
        IFS='|' read -r label words depth <<< "${rungs[i]}"
        psnr=$(decibels "$dir/$name-$i.png" "$dir/$name-reference-$depth.png")
        printf '| %s | %s | %s | %s | %.2f | %.2f |\n' "$name" "$label" "$(kept "$dir/$name-$i.json")" \
            "$(figure "$dir/$name-$i.json" peak)" "$(median < "$dir/$name-$i.times")" "$psnr" >> "$dir/table.md"
        case $i in
        1 | 2 | 3 | 6)
            draw "$scene" "$words" "$depth" "$dir/$name-small-$i" 256
            pictures+=("$dir/$name-small-$i.png=$label|$(printf '%.1f dB' "$psnr")")
            ;;
        esac
    done
done
"$aset" sheet -o "$dir/sheet.png" --columns 5 "${pictures[@]}"
cat "$dir/table.md"
