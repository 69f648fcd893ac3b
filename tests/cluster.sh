#!/bin/bash
# Many machines, as far as one shows it: cluster.sh ASET CONVERT [MPI_RENDER|-] [PATTERN]
#
# Pictures by GNU parallel, by Slurm's array (sbatch is a stand-in here that runs the jobs in turn), by MPI with 1 to 8 ranks:
# the bytes of aset render; a job or rank that is slow, stops, fails or is killed; then times. As tool.sh: one line a case.
set -u
if [ $# -lt 2 ] || [ ! -x "$1" ] || [ ! -x "$2" ]; then
    echo "usage: bash tests/cluster.sh build/aset build/tests/convert [build/cluster/mpi_render|-] [PATTERN]" >&2
    exit 1
fi
aset=$1
convert=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
mpi_render=${3:--}
pattern=${4:-*}
suite=cluster
project=$PWD
[ "$mpi_render" = - ] || mpi_render=$(cd "$(dirname "$mpi_render")" && pwd)/$(basename "$mpi_render")
. "$(dirname "$0")/support/cases.sh"
export ASET=$aset
cluster=$project/examples/cluster
# what Open MPI asks for in a container: to be root, and more ranks than processors
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Without the limit of cases.sh on processor time, under which a process's clock is told in steps longer than a row takes.
mpi() {
    ulimit -S -t unlimited
    mpirun --oversubscribe -n "$@"
}

skip() {
    echo "$*" >"$top/skipped"
    exit 0
}
needs_parallel() { command -v parallel >/dev/null || skip "no GNU parallel: make deps-cluster"; }
needs_mpi() { { [ "$mpi_render" != - ] && command -v mpirun >/dev/null; } || skip "no Open MPI: make deps-cluster"; }

# Nothing is left but what is named.
only() {
    [ "$(echo $(ls -A))" = "$*" ] || fail "there is $(ls -A | tr '\n' ' '), expected $*"
}
run() {
    status=0
    ("$@") >"$out" 2>"$err" </dev/null || status=$?
}

# ---- GNU parallel ----

parallel_pieces() {
    needs_parallel
    local pieces
    for pieces in 1 3 7 40; do
        run bash "$cluster/parallel.sh" "$scenes/gears.nff" a.png 48x33 $pieces -m aset --grid 20
        [ $status -eq 0 ] && [ ! -s "$err" ] || fail "$pieces pieces: status $status: $(head -n 1 "$err")"
        works render "$scenes/gears.nff" -s 48x33 -m aset --grid 20 -o b.png
        same a.png b.png "$pieces pieces: not the picture of one"
        only a.png b.png
    done
}

# A tool that is killed at one piece of rows.
mortal_tool() {
    printf '#!/bin/bash\ncase " $* " in *" --rows %s "*) kill -KILL $$ ;; esac\nexec "%s" "$@"\n' "$1" "$aset" >"$top/mortal"
    chmod +x "$top/mortal"
}

parallel_fails_as_a_whole() {
    needs_parallel
    run bash "$cluster/parallel.sh" "$scenes/gears.nff" a.png 48x33 4 --memory 10K
    [ $status -eq 1 ] || fail "too little memory: status $status"
    grep -q "^aset: .*gears.nff: the picture needs [0-9]* bytes, has 10240$" "$err" || fail "it says $(cat "$err")"
    only
    mortal_tool 16:24
    ASET=$top/mortal run bash "$cluster/parallel.sh" "$scenes/gears.nff" a.png 48x33 4
    [ $status -eq 1 ] || fail "a job that is killed: status $status"
    [ -s "$err" ] || fail "a job that is killed: not a word"
    only
}

frames_of_a_turn() {
    needs_parallel
    local format
    for format in obj stl; do
        run bash "$cluster/frames.sh" "$scenes/block.$format" frames-$format 5 -s 48x48
        [ $status -eq 0 ] && [ ! -s "$err" ] || fail "$format: status $status: $(head -n 1 "$err")"
        [ "$(ls -A frames-$format | tr '\n' ' ')" = "$(printf 'frame-%04d.png ' 0 1 2 3 4)" ] || fail "made $(ls -A frames-$format)"
        # the first is the view that aset chooses; the others are other ones
        works bake "$scenes/block.$format" --grid 64 -q -o block.draft
        works render block.draft -s 48x48 -o own.png
        works compare own.png frames-$format/frame-0000.png --json
        [ "$(sed 's/.*"psnr":\([0-9]*\).*/\1/' "$out")" -ge 45 ] || fail "$format: the first frame is not aset's own view"
        cmp -s frames-$format/frame-0000.png frames-$format/frame-0002.png && fail "$format: nothing turns"
    done
    run bash "$cluster/frames.sh" "$scenes/gears.none" none 5
    [ $status -eq 1 ] && grep -q '^aset: .*gears.none: ' "$err" || fail "no model: status $status: $(cat "$err")"
}

# ---- Slurm: a stand-in for sbatch that runs arrays task by task, and dependent jobs if all went well ----

stand_in() {
    mkdir -p "$top/bin"
    cat >"$top/bin/sbatch" <<'END'
#!/bin/bash
array= dependency=
while :; do
    case $1 in
    --array=*) array=${1#--array=} ;;
    --dependency=afterok:*) dependency=${1#--dependency=afterok:} ;;
    --*) ;;
    *) break ;;
    esac
    shift
done
id=$(($(ls "$JOBS" | wc -l) + 100))
: >"$JOBS/$id"
echo $id
if [ -n "$dependency" ]; then
    [ -s "$JOBS/$dependency" ] && exit 0 # one of the tasks failed: never run
    bash "$@" >>"$JOBS.log" 2>&1 || echo failed >"$JOBS/$id"
    exit 0
fi
for task in $(seq "${array%-*}" "${array#*-}"); do
    SLURM_ARRAY_TASK_ID=$task bash "$@" >>"$JOBS.log" 2>&1 || echo failed >"$JOBS/$id"
done
END
    chmod +x "$top/bin/sbatch"
    rm -rf "$top/jobs" "$top/jobs.log"
    mkdir "$top/jobs"
    export JOBS=$top/jobs
    PATH=$top/bin:$PATH
}

slurm_array() {
    stand_in
    local pieces
    for pieces in 1 5 40; do
        run bash "$cluster/slurm.sh" "$scenes/gears.nff" a.png 48x33 $pieces --grid 20
        [ $status -eq 0 ] && [ ! -s "$err" ] || fail "$pieces pieces: status $status: $(head -n 1 "$err")"
        works render "$scenes/gears.nff" -s 48x33 --grid 20 -o b.png
        same a.png b.png "$pieces pieces: not the picture of one"
        only a.png b.png
    done
    rm a.png b.png
    mortal_tool 16:24
    ASET=$top/mortal run bash "$cluster/slurm.sh" "$scenes/gears.nff" a.png 48x33 4
    [ ! -e a.png ] || fail "a picture with a piece missing"
}

# ---- MPI ----

mpi_equals_one_process() {
    needs_mpi
    local n scene
    for scene in gears.nff balls.nff block.draft; do
        works render "$scenes/$scene" -s 96x75 -o expected.ppm
        for n in 1 2 3 4 5 6 7 8; do
            run mpi $n "$mpi_render" "$scenes/$scene" a.ppm 96x75
            [ $status -eq 0 ] && [ ! -s "$err" ] || fail "$scene, $n ranks: status $status: $(head -n 3 "$err" | tr '\n' ' ')"
            same a.ppm expected.ppm "$scene, $n ranks: another picture"
            # all rows, each once
            [ "$(sed 's/.*by rank://' "$out" | awk '{ for (i = 1; i <= NF; i++) n += $i; print n, NF }')" = "75 $n" ] ||
                fail "$scene, $n ranks: $(cat "$out")"
            rm a.ppm
        done
    done
    run mpi 17 "$mpi_render" "$scenes/gears.nff" a.ppm 96x75 # rank 0 only deals
    [ $status -eq 0 ] && grep -q 'by rank: 0 ' "$out" || fail "17 ranks: status $status: $(cat "$out")"
    works render "$scenes/gears.nff" -s 96x75 -o expected.ppm
    same a.ppm expected.ppm "17 ranks: another picture"
    run mpi 2 "$mpi_render" "$scenes/tiny.nff" b.ppm # fewer rows than one run, and the file's own size
    works render "$scenes/tiny.nff" -o expected.ppm
    same b.ppm expected.ppm "3 rows: another picture"
}

# Words before the program of each rank: what is to happen to rank 1, by $3.
trouble() {
    cat >"$top/trouble" <<'END'
#!/bin/bash
kind=$1 picture=$2
shift 2
case $kind-$OMPI_COMM_WORLD_RANK in
first-0 | slow-1 | stopped-1 | killed-1) ;;
*) exec "$@" ;;
esac
"$@" &
pid=$!
case $kind in
slow) while kill -STOP $pid 2>/dev/null; do sleep 0.2; kill -CONT $pid; sleep 0.01; done ;;
stopped)
    # when it has drawn for a while: before that all wait for each other
    for i in $(seq 600); do
        [ "$(awk '{ print $14 + $15 }' /proc/$pid/stat)" -ge 30 ] && break
        sleep 0.05
    done
    kill -STOP $pid
    for i in $(seq 300); do [ -e "$picture" ] && break; sleep 0.1; done
    [ -e "$picture" ] && : >"$picture.before"
    kill -CONT $pid
    ;;
*) sleep 0.7; kill -KILL $pid ;;
esac
wait $pid || kill -KILL $$
END
    chmod +x "$top/trouble"
}

mpi_survives_a_slow_rank() {
    needs_mpi
    trouble
    works render "$scenes/gears.nff" -s 400x300 -o expected.ppm
    run mpi 3 "$top/trouble" slow a.ppm "$mpi_render" "$scenes/gears.nff" a.ppm 400x300
    [ $status -eq 0 ] || fail "status $status: $(head -n 3 "$err")"
    same a.ppm expected.ppm "another picture"
    sed 's/.*by rank://' "$out" | awk '{ exit !(2 * $2 < ($1 + $3) / 2) }' || fail "the slow rank drew as much: $(cat "$out")"
    rm a.ppm
    [ -r /proc/self/stat ] || return 0
    works render "$scenes/gears.nff" -s 900x700 -o expected.ppm
    run mpi 3 "$top/trouble" stopped a.ppm "$mpi_render" "$scenes/gears.nff" a.ppm 900x700
    [ $status -eq 0 ] || fail "stopped: status $status: $(head -n 3 "$err")"
    same a.ppm expected.ppm "stopped: another picture"
    [ -e a.ppm.before ] || fail "the picture waited for a rank that had stopped"
}

mpi_leaves_no_half_picture() {
    needs_mpi
    trouble
    local kind
    for kind in killed first; do
        echo old >a.ppm
        run mpi 3 "$top/trouble" $kind a.ppm "$mpi_render" "$scenes/gears.nff" a.ppm 1000x800
        [ $status -ne 0 ] || fail "$kind: status 0"
        grep -qiE 'signal 9|killed' "$err" || fail "$kind: it says $(head -n 5 "$err")"
        [ "$(cat a.ppm)" = old ] || fail "$kind: the picture of before is gone"
        only a.ppm
    done
    rm a.ppm
    head -c 2000 "$scenes/gears.nff" >cut.nff
    run mpi 3 "$mpi_render" cut.nff a.ppm
    [ $status -eq 1 ] || fail "a broken scene: status $status"
    grep -q '^mpi_render: rank [0-9]*: cut.nff:[0-9]*: ' "$err" || fail "a broken scene: $(head -n 2 "$err")"
    run mpi 2 "$mpi_render" nothing.nff a.ppm
    [ $status -eq 1 ] && grep -q '^mpi_render: rank 0: nothing.nff: ' "$err" || fail "no scene: $status, $(head -n 2 "$err")"
    { cat "$scenes/block.draft" && echo odd; } >bad.draft
    run mpi 2 "$mpi_render" bad.draft a.ppm
    [ $status -eq 1 ] && grep -q '^mpi_render: rank [01]: bad.draft: ' "$err" || fail "a broken draft: $status, $(head -n 2 "$err")"
    run mpi 2 "$mpi_render" "$scenes/tiny.nff" nowhere/a.ppm
    [ $status -eq 1 ] && grep -q '^mpi_render: rank 0: nowhere/a.ppm: ' "$err" || fail "nowhere: $status, $(head -n 2 "$err")"
    run mpi 2 "$mpi_render" "$scenes/tiny.nff"
    [ $status -eq 2 ] || fail "a word is missing: status $status"
    only bad.draft cut.nff
}

# ---- times: medians over rounds, ratios within a round; processor time minds others on the machine less than wall clock ----

median() { sort -n | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
said() { sed "s/.*[ (]\([0-9.]*\) $1.*/\1/" "$out"; }
by() { echo "$1 $2" | awk '{ printf "%.3f\n", $1 / $2 }'; }

mpi_times() {
    needs_mpi
    local n round single rank size=${SIZE:-512x512}
    for round in $(seq "${ROUNDS:-3}"); do
        works render "$scenes/gears.nff" -s "$size" -o a.ppm --stats s.json
        single=$(sed 's/.*"render_s":\([0-9.]*\).*/\1/' s.json)
        echo "$single" >>single
        for n in 1 2 4 8; do
            run mpi $n "$mpi_render" "$scenes/gears.nff" b.ppm "$size"
            [ $status -eq 0 ] || fail "status $status"
            same a.ppm b.ppm "another picture"
            [ $n -gt 1 ] || rank=$(said "s of processors")
            by "$single" "$(said "s to draw")" >>wall-$n
            by "$(said "s of processors")" "$rank" >>work-$n
            by "$rank" "$(said "s of the busiest")" >>share-$n
            said messages >>messages-$n
        done
    done
    {
        echo "gears of size 2, $size, exact; $(nproc) processors, medians of ${ROUNDS:-3} rounds; aset render draws in $(median <single) s"
        echo "ranks  speed by wall clock  processor time in all  one rank's by the busiest's  messages"
        for n in 1 2 4 8; do
            echo "$n $(median <wall-$n) $(median <work-$n) $(median <share-$n) $(median <messages-$n)" |
                awk '{ printf "%5d  %19.2f  %21.2f  %27.2f  %8d\n", $1, $2, $3, $4, $5 }'
        done
    } >"$top/times"
}

mkdir "$scenes"
awk 'BEGIN { print "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1"
    print "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8" }' >"$scenes/block.obj"
"$convert" "$scenes/block.obj" "$scenes/block.stl" stl && "$aset" scene gears --size 2 -o "$scenes/gears.nff" &&
    "$aset" scene balls --size 2 -o "$scenes/balls.nff" && "$aset" bake "$scenes/block.obj" -q -o "$scenes/block.draft" &&
    sed 's/^resolution .*/resolution 5 3/' "$scenes/balls.nff" >"$scenes/tiny.nff" || exit 1
cases="parallel_pieces parallel_fails_as_a_whole frames_of_a_turn slurm_array mpi_equals_one_process mpi_survives_a_slow_rank
mpi_leaves_no_half_picture mpi_times"
# shellcheck disable=SC2086
run_cases $cases
end=$?
[ ! -e "$top/times" ] || cat "$top/times"
exit $end
