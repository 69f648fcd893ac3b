#!/bin/bash
# A program compiled with the header that a plan wrote draws the plan's picture in an arena to the byte: plan.sh ASET CC
set -eu
aset=$1
cc=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
wide=1 # budgets and compiler's words of a build in double
case " ${CPPFLAGS:-} " in *" -DASET_REAL_BITS=64 "*) wide=2 ;; esac
passed=0
failed=0
check() { # name, command ...
    name=$1
    shift
    if "$@" > "$dir/log" 2>&1; then passed=$((passed + 1)); else
        failed=$((failed + 1))
        echo "not ok $name: $(tail -n 1 "$dir/log")"
    fi
}
value() { sed -n "s/.*\"$1\":\"\{0,1\}\([a-z0-9.x]*\).*/\1/p" "$dir/plan.json"; }
# scene, size, memory, further words of the plan; $alike: words of the plan that render gets as well
alike=
try() {
    scene=$1
    size=$2
    memory=$((${3%K} * wide))${3//[0-9]/}
    shift 3
    if [ -f "$dir/$scene.nff" ]; then cat "$dir/$scene.nff"; else "$aset" scene "$scene" --size "$size"; fi |
        sed 's/^resolution .*/resolution 64 64/' > "$dir/scene.nff"
    check "$scene-plans" "$aset" plan "$dir/scene.nff" --memory "$memory" --header "$dir/plan.h" --json $alike "$@"
    cp "$dir/log" "$dir/plan.json"
    value method >> "$dir/methods"
    check "$scene-compiles" "$cc" ${CPPFLAGS:-} -std=c99 -O1 -ffp-contract=off -include "$dir/plan.h" -Iinclude -Ilib examples/planned.c \
        lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c lib/load/*.c -lm -o "$dir/planned"
    check "$scene-runs" sh -c "'$dir/planned' '$dir/scene.nff' > '$dir/planned.ppm'"
    check "$scene-renders" "$aset" render "$dir/scene.nff" --method "$(value method)" --grid "$(value grid)" \
        --approx "$(value approx)" --approx-depth "$(value approx_depth)" --memory "$(value bytes)" $alike -o "$dir/render.ppm"
    check "$scene-same-picture" cmp "$dir/planned.ppm" "$dir/render.ppm"
    if "$aset" render "$dir/scene.nff" --method "$(value method)" --grid "$(value grid)" --approx "$(value approx)" \
        --approx-depth "$(value approx_depth)" --memory $(($(value bytes) - 1)) $alike 2> /dev/null; then
        failed=$((failed + 1))
        echo "not ok $scene: one byte less than the plan's bytes is enough"
    else
        passed=$((passed + 1))
    fi
}
bash "$(dirname "$0")/odd-scenes.sh" "$dir"
try snow 1 60K --error 20
try gears 2 256K
try tree 6 256K -m set # which of equals is the fastest is for the clock to say
try corridor - 50K
try tetra 4 64K
alike="--curtail 0 --samples 4 --depth 3"
try snow 1 100K -m mset --grid 20 --approx all --approx-depth 1
alike="--curtail 2 --curtail-when more --rules spd"
try snow 1 100K -m mset --grid 20 --approx all --approx-depth 1
alike=
try tetra 4 64K
# 5000 bytes hold no object of it: what is drawn is streamed, which a program with the header does not do
check streamed-plans "$aset" plan "$dir/scene.nff" --memory 5000 --json
cp "$dir/log" "$dir/plan.json"
check streamed-renders "$aset" render "$dir/scene.nff" --method "$(value method)" --grid "$(value grid)" --approx "$(value approx)" \
    --approx-depth "$(value approx_depth)" --memory 5000
if "$aset" plan "$dir/scene.nff" --memory $((200 * wide)) 2> "$dir/log"; then failed=$((failed + 1)); else passed=$((passed + 1)); fi
check least-plans "$aset" plan "$dir/scene.nff" --memory "$(sed -n 's/.*needs \([0-9]*\) bytes.*/\1/p' "$dir/log")"
if "$aset" plan "$dir/scene.nff" --memory 5000 --header "$dir/plan.h" 2> "$dir/log"; then failed=$((failed + 1)); else passed=$((passed + 1)); fi
need=$(sed -n 's/.*needs \([0-9]*\) bytes.*/\1/p' "$dir/log")
try tetra 4 $((need / wide)) # a multiple of 8
# what is needed goes by the words
"$aset" scene balls --size 2 | sed 's/^resolution .*/resolution 32 32/' > "$dir/scene.nff"
for words in "-m grid --approx none" "-m mset" "--approx shadow" "--cells plane" "--grid 8 --approx all --approx-depth 0" \
    "--approx-depth 0 --cells plane" "--approx all --approx-depth 0 --cells plane" "-m grid --approx primary,reflected --cells normal"; do
    if "$aset" plan "$dir/scene.nff" --memory 300 $words 2> "$dir/log"; then failed=$((failed + 1)); else passed=$((passed + 1)); fi
    check "needs-$words" "$aset" plan "$dir/scene.nff" $words --memory "$(sed -n 's/.*needs \([0-9]*\) bytes.*/\1/p' "$dir/log")"
done
for method in grid set mset brute; do check "some-plan-takes-$method" grep -q "^$method\$" "$dir/methods"; done
echo "plan: $passed passed, $failed failed"
[ $failed = 0 ]
