#!/bin/bash
# What a step of each method costs, in instructions counted by callgrind (repeatable, whatever else the machine does), on tetra of
# size 6 at 100 x 100: the table in DESIGN.md. costs.sh ASET DIRECTORY
set -eu
export LC_ALL=C # numbers with a point
aset=$1
dir=$2
mkdir -p "$dir"
"$aset" scene tetra -o "$dir/tetra.nff"
first() { grep -o "\"$1\":[0-9.]*" "$dir/stats.json" | head -n 1 | cut -d: -f2; }
last() { grep -o "\"$1\":[0-9.]*" "$dir/stats.json" | tail -n 1 | cut -d: -f2; }
inclusive() { # a function's instructions with all it calls
    awk -v name="$1" '$0 ~ ":" name "( |$)" { gsub(",", "", $1); if ($1 + 0 > most) most = $1 + 0 } END { print most + 0 }' "$dir/annotated"
}
echo "| method | bytes of cells | bytes of references | references | bits each | cells a ray | instructions a ray | tests a ray |"
echo "|---|---|---|---|---|---|---|---|"
for method in set mset grid octree arts excell; do
    valgrind --tool=callgrind --callgrind-out-file="$dir/callgrind" "$aset" render "$dir/tetra.nff" -s 100x100 --grid 64 \
        -m $method --stats "$dir/stats.json" --quiet 2> /dev/null
    callgrind_annotate --inclusive=yes "$dir/callgrind" > "$dir/annotated"
    case $method in set | mset) go=aset_sides_go ;; grid) go=grid_go ;; *) go=aset_leaves_go ;; esac
    rays=$(($(first primary) + $(first shadow)))
    walk=$(($(inclusive $go) - $(inclusive visit_exact)))
    refs=$(first references)
    ref_bytes=$(last references)
    echo "$method $(first cells_visited) $(first tests) $rays $walk $refs $ref_bytes $(last cells)" | awk '{
        printf "| %s | %d | %d | %d | %.1f | %.1f | %d | %.1f |\n", $1, $8, $7, $6, $7 * 8 / $6, $2 / $4, $5 / $4, $3 / $4 }'
done
