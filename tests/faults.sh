#!/bin/bash
# faults.sh - the commands of aset on a full disk and ended by a signal, run from the project's top: bash tests/faults.sh
# build/aset [PATTERN]. What tool.sh shows of aset render holds for all others: an output is there whole, or as it was before.
#
# As tool.sh: one line for each case, each in a folder of its own, exit status 1 if any failed.
set -u

if [ $# -lt 1 ] || [ ! -x "$1" ]; then
    echo "usage: bash tests/faults.sh build/aset [PATTERN]" >&2
    exit 1
fi
aset=$1
pattern=${2:-*}
suite=faults
. "$(dirname "$0")/support/cases.sh"

mkdir "$scenes" "$scenes/models" || exit 1
"$aset" scene balls --size 3 -o "$scenes/balls.nff" || exit 1
for name in balls gears rings; do "$aset" scene $name --size 1 -o "$scenes/models/$name.nff" || exit 1; done
for name in a b; do
    "$aset" render "$scenes/models/balls.nff" --angle $([ $name = a ] && echo 30 || echo 40) -s 96x96 -o "$scenes/$name.png" || exit 1
done

# ---- signals ----

# Runs the words, ends them by a signal after a while. They were done by then, or that is how they ended; n_cut counts the latter.
# The signals take turns, but what this shell was started to ignore no job of it can be made to hear.
n_cut=0 n_runs=0
case $(trap -p INT) in *"''"*) signals="TERM TERM" ;; *) signals="INT TERM" ;; esac
ended_by() {
    local delay=$1 pid expected signal
    shift
    n_runs=$((n_runs + 1))
    signal=$([ $((n_runs % 2)) = 1 ] && echo "${signals% *}" || echo "${signals#* }")
    case $signal in INT) expected=130 ;; TERM) expected=143 ;; esac
    set -m # or else the job would ignore SIGINT, as jobs in the background do
    "$aset" "$@" >/dev/null 2>"$err" &
    pid=$!
    sleep "$delay"
    kill -s "$signal" $pid 2>/dev/null
    status=0
    wait $pid || status=$?
    set +m
    [ $status -eq 0 ] || [ $status -eq $expected ] || fail "aset $*, $signal after $delay s: status $status: $(cat "$err")"
    [ -z "$(find . -name '.aset*')" ] || fail "aset $*, $signal after $delay s: left $(find . -name '.aset*')"
    [ $status -eq 0 ] || n_cut=$((n_cut + 1))
}

# A command with one output, which begins as an old one: whole afterwards, or still the old one. $1: the output; then the words.
one_output_interrupted() {
    local output=$1 delay
    shift
    works "$@" -o "full.$output"
    for delay in 0 0.003 0.01 0.02 0.05 0.1; do
        echo old >"$output"
        ended_by $delay "$@" -o "$output"
        if [ $status -eq 0 ]; then
            same "$output" "full.$output" "$*: done, but another file"
        elif [ "$(cat "$output")" != old ]; then # the signal came between the last byte and the end
            same "$output" "full.$output" "aset $*, ended after $delay s: part of a file"
        fi
        [ "$(ls -A | tr '\n' ' ')" = "$(printf '%s\n' "$output" "full.$output" | sort | tr '\n' ' ')" ] || fail "left $(ls -A)"
    done
    [ $n_cut -gt 0 ] || fail "$*: no signal came in time"
}

scene_interrupted() {
    one_output_interrupted a.nff scene balls --size 6
}

bake_interrupted() {
    one_output_interrupted a.draft bake "$scenes/balls.nff" --grid 50 --quiet
}

render_interrupted() {
    one_output_interrupted a.png render "$scenes/balls.nff" -s 120x120 -j 2
}

# Every thumbnail that is there is whole.
thumb_interrupted() {
    local delay picture
    works thumb "$scenes/models" -o full -s 64 --quiet
    for delay in 0 0.005 0.02 0.05 0.1; do
        rm -rf some
        ended_by $delay thumb "$scenes/models" -o some -s 64 --quiet
        for picture in some/*; do
            [ ! -e "$picture" ] || same "$picture" "full/${picture#some/}" "$picture is not whole"
        done
    done
    [ $n_cut -gt 0 ] || fail "no signal came in time"
}

# No table and no page before their time; what was measured is kept, and the same words go on from there.
trade_interrupted() {
    local delay words="trade $scenes/models/balls.nff -o t -m mset --grids 8 -s 20x20 --rounds 30 --quiet"
    for delay in 0 0.02 0.1 0.2; do
        # shellcheck disable=SC2086
        ended_by $delay $words
        if [ $status -ne 0 ]; then
            [ ! -e t/trade.csv ] || [ -s t/trade.html ] || [ "$(wc -l <t/trade.csv)" -eq 12 ] || fail "half a table"
            for picture in t/*.png; do
                [ ! -e "$picture" ] || works compare "$picture" "$picture"
            done
        fi
    done
    [ $n_cut -gt 0 ] || fail "no signal came in time"
    # shellcheck disable=SC2086
    works $words
    [ "$(wc -l <t/trade.csv)" -eq 12 ] || fail "$(wc -l <t/trade.csv) lines"
    [ ! -e t/trade.csv.partial ] || fail "the partial file is still there"
}

# ---- no room ----

# Status 1, one line, and the output as before. $1: the output; then the words.
has_no_room() {
    local output=$1
    shift
    rm -f -- *
    for old in "" old; do
        [ -z "$old" ] || echo $old >"$output"
        tool "$@"
        [ $status -eq 1 ] || fail "aset $*: status $status"
        [ "$(wc -l <"$err")" -eq 1 ] || fail "aset $*: $(wc -l <"$err") lines on standard error: $(head -n 2 "$err")"
        case $(cat "$err") in
        "aset: $output: cannot write: "?*) ;;
        *) fail "aset $*: says $(cat "$err")" ;;
        esac
        [ "$(ls -A)" = "${old:+$output}" ] || fail "aset $*: left $(ls -A)"
        [ -z "$old" ] || [ "$(cat "$output")" = old ] || fail "aset $*: the old file is changed"
    done
}

file_size_limit() {
    limit_files 1 || fail "no file size limit can be set"
    has_no_room a.nff scene balls --size 3 -o a.nff
    has_no_room a.draft bake "$scenes/balls.nff" --grid 50 --quiet -o a.draft
    has_no_room a.h bake "$scenes/balls.nff" --grid 50 --quiet -o a.h
    has_no_room a.png join "$scenes/a.png" "$scenes/b.png" -o a.png
    has_no_room a.png compare "$scenes/a.png" "$scenes/b.png" -o a.png
    has_no_room a.ppm sheet "$scenes/a.png" "$scenes/b.png" -o a.ppm
}

thumbs_without_room() {
    limit_files 1 || fail "no file size limit can be set"
    tool thumb "$scenes/models" -o t -s 128 --quiet
    [ $status -eq 1 ] || fail "status $status"
    [ "$(grep -c 'cannot write' "$err")" -eq 3 ] || fail "says $(cat "$err")"
    [ -z "$(find t -type f)" ] || fail "left $(find t -type f)"
}

trade_without_room() {
    limit_files 1 || fail "no file size limit can be set"
    tool trade "$scenes/models/balls.nff" -o t -m mset --grids 8 -s 20x20 --rounds 9 --quiet
    [ $status -eq 1 ] || fail "status $status"
    [ "$(wc -l <"$err")" -eq 1 ] || fail "$(wc -l <"$err") lines on standard error: $(head -n 2 "$err")"
    [ ! -e t/trade.csv ] && [ ! -e t/trade.html ] || fail "a table or a page is there"
    [ -z "$(find . -name '.aset*')" ] || fail "left $(find . -name '.aset*')"
}

# A device that is always full, under names that commands take for pictures, drafts and headers.
full_disk() {
    local words
    if [ ! -c /dev/full ]; then
        echo "no /dev/full here" >"$top/skipped"
        return
    fi
    for name in f.png f.draft f.h f.nff; do ln -s /dev/full $name; done
    for words in "scene tetra --size 2 -o f.nff" "bake $scenes/models/balls.nff --grid 9 --quiet -o f.draft" \
        "bake $scenes/models/balls.nff --grid 9 --quiet -o f.h" "join $scenes/a.png $scenes/b.png -o f.png" \
        "compare $scenes/a.png $scenes/b.png -o f.png" "sheet $scenes/a.png $scenes/b.png -o f.png" \
        "plan $scenes/models/balls.nff -s 16x16 --memory 100K --header f.h"; do
        # shellcheck disable=SC2086
        tool $words
        [ $status -eq 1 ] || fail "aset $words: status $status"
        case $(cat "$err") in
        "aset: f."*": cannot write: "?*) ;;
        *) fail "aset $words: says $(cat "$err")" ;;
        esac
        [ "$(ls -A | tr '\n' ' ')" = "f.draft f.h f.nff f.png " ] || fail "aset $words: left $(ls -A)"
    done
}

run_cases scene_interrupted bake_interrupted render_interrupted thumb_interrupted trade_interrupted file_size_limit \
    thumbs_without_room trade_without_room full_disk
