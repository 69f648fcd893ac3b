#!/bin/bash
# The tables of docs/numerics.md anew: numerics.sh TESTS DIRECTORY PAGE, with the programs test_scale, test_oracle and
# bench_robust in TESTS. Where the compiler has no quadruple precision that table stays as it is.
set -eu
tests=$1
dir=$2
page=$3
mkdir -p "$dir"
rm -f "$dir"/*.table
ASET_TABLES=$dir/place.table "$tests/test_scale"
ASET_LONG=1 ASET_TABLES=$dir/oracle.table "$tests/test_oracle"
"$tests/bench_robust" > "$dir/cost.table" || echo "the robust tests cost more than they may"

# The lines between <!-- NAME --> and <!-- end --> of the page become a head and those of a file.
put() { # NAME HEAD
    [ -s "$dir/$1.table" ] || return 0
    { printf '%b' "$2"; cat "$dir/$1.table"; } > "$dir/$1.new"
    awk -v name="<!-- $1 -->" -v file="$dir/$1.new" '
        $0 == name { print; while ((getline line < file) > 0) print line; inside = 1; next }
        $0 == "<!-- end -->" { inside = 0 }
        !inside { print }' "$page" > "$dir/page"
    cp "$dir/page" "$page"
}
put place '\n| scene | sizes away | a step | other hits | median error | 99 % below |\n|---|---|---|---|---|---|\n'
put oracle '\n| object | hits | median, ulp | 99.9 % below | worst | off the surface, worst |\n|---|---|---|---|---|---|\n'
put cost '\n'
