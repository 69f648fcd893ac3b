#!/bin/bash
# The completion for bash, sourced and called as bash would: completion.sh ASET FILE
# Every command and every option of the help is offered, every word offered for a value is one that the tool takes.
set -u
aset=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
. "$2" || exit 1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
bad=0
fail() {
    echo "completion: $*"
    bad=1
}
# What is offered at the end of these words, one a line, sorted.
offered() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _aset
    printf '%s\n' "${COMPREPLY[@]:-}" | sort
}
expect() {
    local expected=$1
    shift
    local is
    is=$(offered "$@" | tr '\n' ' ')
    [ "${is% }" = "$expected" ] || fail "$*: offers ${is% }, expected $expected"
}
contains() {
    local word=$1
    shift
    offered "$@" | grep -qxF -e "$word" || fail "$*: does not offer $word"
}

complete -p aset >/dev/null 2>&1 || fail "nothing is registered for aset"
commands=$("$aset" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
touch model.stl MODEL.PLY scene.nff notes.txt picture.png a.draft
mkdir folder
for command in $commands; do
    contains "$command" aset "${command%?}"
    for option in $("$aset" "$command" --help | grep -oE -e '(^|[ (])--[a-z-]+' | tr -d ' (' | sort -u); do
        # options of other commands are mentioned, too: those that the command does not take are not to be offered
        if "$aset" "$command" "$option" --help --help 2>&1 | grep -q "there is no option"; then
            ! offered aset "$command" "$option" | grep -qxF -e "$option" || fail "$command: offers $option, which it does not take"
        else
            contains "$option" aset "$command" "${option%?}"
        fi
    done
done
contains --version aset --v
expect "reflected refracted" aset render --approx ref
expect "octree" aset render -m oc
expect "octree" aset render --method = oc
expect "normal" aset model.stl --cells n
expect "off on" aset bake model.stl --ground ""
expect "tetra tetra-moon" aset scene tet
expect "MODEL.PLY a.draft folder model.stl scene.nff" aset render ""
expect "folder picture.png" aset compare ""
expect "folder" aset thumb ""
touch "a model.stl" "a[1].stl" a1.stl
mkdir "a folder"
expect "a folder a model.stl a1.stl a[1].stl" aset info "a"
expect "a[1].stl" aset render scene.nff -o "a["
expect "a folder" aset thumb "a "
expect "notes.txt" aset scene gears -o no
expect "" aset render --grid ""

# The words for values are taken by the tool: status 2 says that they are wrong.
n_words=0
words_work() { # COMMAND OPTION SCENE
    local word status
    for word in $(_aset_value "$1:$2" | sed -n 's/^words //p'); do
        status=0
        "$aset" "$1" "$3" "$2" "$word" -o none.ppm >/dev/null 2>said </dev/null || status=$?
        if grep -q 'there is no option -o' said; then
            status=0
            "$aset" "$1" "$3" "$2" "$word" >/dev/null 2>said </dev/null || status=$?
        fi
        [ $status -ne 2 ] || grep -q 'drafts of' said || fail "$1 $2 $word: $(cat said)"
        n_words=$((n_words + 1))
    done
}
for command in $commands; do
    for option in $(_aset_options "$command"); do
        words_work "$command" "$option" none.stl
    done
done
for scene in $_aset_scenes; do
    "$aset" scene "$scene" --size 1 -o scene.nff 2>said || fail "scene $scene: $(cat said)"
done
[ $n_words -ge 30 ] || fail "only $n_words words for values"
[ $bad = 0 ] && echo "completion: $(echo "$commands" | wc -l) commands with their options, $n_words words that the tool takes"
exit $bad
