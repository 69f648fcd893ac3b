# The frame of the tool's end-to-end tests, sourced by tests/*.sh after these have looked at their words: where the tool is, a
# folder for each case, the checks that all of them use, the loop over the cases. Sourced with aset (the tool's path), suite (a
# word for the folder's name) and pattern set.
set -u
export LC_ALL=C
unset POSIXLY_CORRECT
aset=$(cd "$(dirname "$aset")" && pwd)/$(basename "$aset")
top=$(mktemp -d "${TMPDIR:-/tmp}/aset-$suite.XXXXXX") || exit 1
trap 'rm -rf "$top"' EXIT
trap 'exit 1' HUP INT TERM
# the files of the checks themselves, outside the folders of the cases
out=$top/out err=$top/err why=$top/why noise=$top/noise scenes=$top/scenes
n_passed=0 n_failed=0
# a tool that runs on for ever is ended, and its case fails
ulimit -S -t 60

fail() {
    printf '%s\n' "$*" >"$why"
    exit 1
}

# Runs the tool with these words; leaves status, $out and $err.
tool() {
    status=0
    "$aset" "$@" >"$out" 2>"$err" </dev/null || status=$?
}

# It does its work and has nothing to say on standard error, which is no terminal here.
works() {
    tool "$@"
    [ $status -eq 0 ] || fail "aset $*: status $status: $(head -n 1 "$err")"
    [ ! -s "$err" ] || fail "aset $*: done, but it says: $(head -n 1 "$err")"
}

same() {
    cmp -s "$1" "$2" || fail "$3"
}

# No file may be longer than so many blocks, in this case. (Nor can a build for coverage write its counts then, which would be cut.)
limit_files() {
    export GCOV_PREFIX=/dev/null GCOV_ERROR_FILE=/dev/null
    ulimit -S -f "$1"
}

# Runs the cases named, each a function, in a subshell and in an empty folder of its own. True: none failed.
run_cases() {
    local name
    for name in "$@"; do
        case $name in
        $pattern) ;;
        *) continue ;;
        esac
        rm -f "$why" "$top/skipped"
        mkdir "$top/$name"
        if (cd "$top/$name" && "$name") >"$noise" 2>&1; then
            echo "ok $name$([ ! -e "$top/skipped" ] || echo " # skipped: $(cat "$top/skipped")")"
            n_passed=$((n_passed + 1))
        else
            [ -s "$why" ] || head -n 1 "$noise" >"$why"
            echo "not ok $name: $(tr '\n' ' ' <"$why")"
            n_failed=$((n_failed + 1))
        fi
        rm -rf "${top:?}/$name"
    done
    echo "$n_passed passed, $n_failed failed"
    [ $n_failed -eq 0 ]
}
