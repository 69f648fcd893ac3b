#!/usr/bin/env bash
# fuzz.sh SECONDS DIR [NAME ...] - every fuzzer (or those named, fuzz_nff ...) for SECONDS each, two at a time, under the
# address and undefined-behaviour sanitizers; first the seeds and the crashes kept of it. SECONDS 0: these only, also
# without clang. What a run finds stays in DIR: a grown corpus, and crashes, to be kept in tests/fuzz/corpus as crash-<what>.
set -u
seconds=${1:-60} dir=${2:-build/fuzz}
shift 2 2>/dev/null || set --
here=$(cd "$(dirname "$0")" && pwd) root=$(cd "$(dirname "$0")/.." && pwd)
flags="-std=c99 -Wall -Wextra -pedantic -Wconversion -Wshadow -Wmissing-prototypes -ffp-contract=off -O2 -g ${FUZZ_FLAGS:-}"
flags="$flags -I$root/include -I$root/lib -fno-sanitize-recover=all -fsanitize=address,undefined,float-cast-overflow"
names=${*:-$(cd "$here/fuzz" && ls fuzz_*.c | sed 's/\.c$//')}
cc=${CC:-cc} main=$here/fuzz/main.c fuzzer=no
if echo 'int LLVMFuzzerTestOneInput(const char *d, long n) { return n < 0 && d; }' |
    clang -fsanitize=fuzzer -x c - -o /dev/null 2>/dev/null; then
    cc=clang main='' fuzzer=yes
elif [ "$seconds" -gt 0 ]; then
    echo "fuzz: no clang with libFuzzer: only the seeds and kept crashes are run"
fi

rm -rf "$dir/obj" # a source may be gone
mkdir -p "$dir/obj" || exit 1
# Fuzzers of readers learn words from comparisons; in the core, which compares numbers all the time,
# it costs most of the speed.
compile() {
    local extra=
    if [ $fuzzer = yes ]; then
        extra=-fsanitize=fuzzer-no-link
        case $1 in */lib/load/*) ;; *) extra="$extra -fno-sanitize-coverage=trace-cmp" ;; esac
    fi
    $cc $flags $extra -c "$1" -o "$2"
}
for source in "$root"/lib/*/*.c; do
    object=$dir/obj/$(basename "$(dirname "$source")")_$(basename "$source" .c).o
    while [ "$(jobs -rp | wc -l)" -ge 2 ]; do wait -n; done
    compile "$source" "$object" &
done
wait
link=$([ $fuzzer = yes ] && echo -fsanitize=fuzzer)
for name in $names; do
    $cc $flags $link "$here/fuzz/$name.c" $main "$dir"/obj/*.o -lm -o "$dir/$name" || exit 1
done

# One fuzzer; its last line says how many inputs it ran.
run() {
    local name=$1 seeds=$here/fuzz/corpus/$1 status=0 longest
    mkdir -p "$dir/corpus/$name"
    if [ ! -d "$seeds" ]; then
        echo "$name: no seeds in $seeds"
        return 1
    fi
    if ! ASET_FUZZ_ALL=1 "$dir/$name" $(find "$seeds" -type f) >"$dir/$name.seeds.log" 2>&1; then
        echo "$name: a seed or kept crash fails: $dir/$name.seeds.log"
        return 1
    fi
    echo "$name: $(find "$seeds" -type f | wc -l) seeds pass"
    [ $fuzzer = yes ] && [ "$seconds" -gt 0 ] || return 0
    case $name in fuzz_scene | fuzz_baker) longest=1024 ;; *) longest=4096 ;; esac # 40 entities; a file
    "$dir/$name" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=1024 -max_len="$longest" -entropic=0 -print_final_stats=1 \
        -artifact_prefix="$dir/$name-" "$dir/corpus/$name" "$seeds" >"$dir/$name.log" 2>&1 || status=1
    echo "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$dir/$name.log") executions in $seconds s"
    if [ $status -ne 0 ]; then
        echo "$name: CRASH: $(grep -m1 -E 'not so|runtime error|ERROR: ' "$dir/$name.log") (log: $dir/$name.log)"
    fi
    return $status
}
failed=0 pids=
for name in $names; do
    while [ "$(jobs -rp | wc -l)" -ge 2 ]; do sleep 0.2; done
    run "$name" &
    pids="$pids $!"
done
for pid in $pids; do
    wait "$pid" || failed=1
done
exit $failed
