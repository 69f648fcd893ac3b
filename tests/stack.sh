#!/bin/bash
# stack.sh DIR [CC [FLAG ...]] - the deepest stack of every public call of the core and the readers, from the compiler's call graph
# (gcc's -fcallgraph-info=su,da): a function's own frame and the deepest of those it calls. Calls by pointer count as the deepest of
# what may stand behind them: a space's methods, visitors, the functions of a sink, of a reader's steps. What the caller hands in
# (read, on_row, a sink of its own) and libc come on top. Fails for a recursion or a frame of no fixed size.
set -u
dir=$1
shift
cc=${1:-gcc}
[ $# -gt 0 ] && shift
flags=${*:--O2}
mkdir -p "$dir" || exit 1
rm -f "$dir"/*.ci
if ! "$cc" -fcallgraph-info=su,da -x c -c /dev/null -o "$dir/none.o" 2>/dev/null; then
    echo "stack: skipped, $cc writes no call graphs"
    exit 0
fi
n=0
for file in lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c lib/load/*.c; do
    # shellcheck disable=SC2086
    "$cc" -std=c99 $flags -ffp-contract=off -Iinclude -Ilib -fcallgraph-info=su,da -c "$file" -o "$dir/$((n += 1)).o" || exit 1
done
rm -f "$dir/none.ci"

# F NAME BYTES for a frame, E FROM TO for a call; statics are told apart by their file
awk '
    /^graph:/ { file = $0; sub(/.*title: "/, "", file); sub(/".*/, "", file) }
    /^node:/ && /bytes \(/ {
        name = $0; sub(/.*title: "/, "", name); sub(/".*/, "", name)
        bytes = $0; sub(/ bytes \(.*/, "", bytes); sub(/.*\\n/, "", bytes)
        kind = $0; sub(/.* bytes \(/, "", kind); sub(/\).*/, "", kind)
        print "F", name, bytes, kind
    }
    /^edge:/ {
        from = $0; sub(/.*sourcename: "/, "", from); sub(/".*/, "", from)
        to = $0; sub(/.*targetname: "/, "", to); sub(/".*/, "", to)
        print "E", from, to
    }' "$dir"/*.ci >"$dir/graph"
grep '^F ' "$dir/graph" | grep -v -e ' static$' -e ' dynamic,bounded$' | awk '{ print "stack: " $2 " has a frame of no fixed size: " $3 " bytes " $4; n++ } END { exit n > 0 }' || exit 1

# Public functions, by the headers, without the names that carry switches.
sed -n 's/^[a-z].*[ *]\(aset_[a-z0-9_]*\)(.*/\1/p' include/aset/*.h | sort -u >"$dir/public"

# CALLER CALLEE: who calls by pointer, and what stands behind it, as patterns of names (statics: FILE:NAME).
cat >"$dir/pointers" <<'END'
aset_query_(closest|layers) (exact|summary|draft)_meet$
aset_(query_any|any_hit) (exact|summary|draft)_any$
aset_query_surface (exact|summary|draft)_surface$
aset_query_clearance draft_query\.c:clearance$
exact_(meet|any)|summary_meet (brute|set|mset|grid|octree|arts|excell)_go$
_go$ exact\.c:visit_exact$|summary_query\.c:visit_
render_rows beam\.c:(begin|draw_rows)$
shade_local reach\.c:last_before$
flat\.c:take_ (scene\.c:take_|counter\.c:count_)
flat_pass$ flat_pass\.c:end_
summary\.c:pass _each_cell$|aset_leaves_each$
_each_cell$|aset_cells_each|aset_leaves_each summary\.c:look_at_cell
each_block cells\.c:(mark_|count_references|place_)
halving|leaves\.c:|aset_leaves_ (excell|tree)\.c:(excell|tree)_(inner|leaf)$
space\.c:measure_with|aset_space_build (brute|set|mset|grid|octree|arts|excell|sides|tree)(\.c:[a-z]+)?_(measure|build)$
baker\.c:take_|aset_draft_read_stage (scene\.c:take_|counter\.c:count_)
aset_sink_polygon|stage\.c:|aset_stage_emit|aset_model_|nff\.c:|aset_load_nff (scene\.c:take_|counter\.c:count_|baker\.c:take_ENTITY$)
END
sed -i 's/ENTITY/(background|view|light|material|polygon_begin|polygon_point|polygon_end|sphere|cone)/' "$dir/pointers"

awk -v public="$dir/public" -v pointers="$dir/pointers" '
    function plain(name) { sub(/__[0-9]+_[01]+$/, "", name); return name }
    function deepest(name,    i, d, most) {
        if (name in depth) return depth[name]
        if (name in active) { print "stack: a recursion through " name; bad = 1; return 0 }
        active[name] = 1
        for (i = 1; i <= n_calls[name]; i++) {
            d = deepest(calls[name, i])
            if (d > most + 0) { most = d; way[name] = calls[name, i] }
        }
        delete active[name]
        return depth[name] = most + frame[name]
    }
    $1 == "F" { if (!($2 in frame)) order[++n] = $2; if ($3 > frame[$2] + 0) frame[$2] = $3 }
    $1 == "E" && $3 != "__indirect_call" { calls[$2, ++n_calls[$2]] = $3 }
    $1 == "E" && $3 == "__indirect_call" { by_pointer[$2] = 1 }
    END {
        while ((getline line < public) > 0) is_public[line] = 1
        while ((getline line < pointers) > 0) {
            split(line, pair, " ")
            used = 0
            for (from in by_pointer) if (from ~ pair[1]) {
                for (i = 1; i <= n; i++) if (order[i] ~ pair[2] && order[i] != from) { calls[from, ++n_calls[from]] = order[i]; used = 1 }
            }
            if (!used) { print "stack: no call by pointer like " line; bad = 1 }
        }
        print " bytes  public call, and the way down"
        for (i = 1; i <= n; i++) {
            name = order[i]
            if (!(plain(name) in is_public)) continue
            n_public++
            d = deepest(name); line = ""
            for (at = name; at in way; at = way[at]) { step = plain(way[at]); sub(/^.*:/, "", step); line = line " > " step }
            printf "%6d  %s%s\n", d, plain(name), line | "sort -rn"
            if (d > most) { most = d; deepest_call = plain(name) }
        }
        close("sort -rn")
        printf "stack: %d public calls, the deepest %s: %d bytes\n", n_public, deepest_call, most
        exit bad || n_public < 30
    }' "$dir/graph"
