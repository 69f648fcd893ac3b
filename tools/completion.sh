#!/bin/bash
# Completion of aset's words for bash, from its help texts, on standard output: completion.sh ASET
set -eu
aset=$1
here=$(dirname "$0")
records() { "$aset" "$@" --help | awk -f "$here/help.awk"; }
commands=$(records | awk -F'\t' '$1 == "part" { on = $2 == "Commands" } $1 == "item" && on { print $2 }')
scenes=$(records scene | awk -F'\t' '$1 == "part" { on = $2 == "Scenes" } $1 == "item" && on { printf "%s ", $2 }')

echo "# bash completion of aset $("$aset" --version | sed 's/^aset //'): made by tools/completion.sh from aset COMMAND --help"
for command in $commands; do
    records "$command" | sed "s/^/$command	/"
done | awk -f "$here/completion.awk"
cat <<END

_aset_commands="$(echo "$commands" | tr '\n' ' ' | sed 's/ $//')"
_aset_scenes="${scenes% }"
END
cat <<'END'

# Files that end in one of the words given, and all folders.
_aset_files() {
    local cur=$1 file ending
    shift
    COMPREPLY=()
    while IFS= read -r file; do
        if [ -d "$file" ]; then
            COMPREPLY+=("$file")
            continue
        fi
        for ending in "$@"; do
            case ${file,,} in
            *."$ending") COMPREPLY+=("$file") ;;
            esac
        done
    done < <(compgen -f -- "$cur")
    compopt -o filenames 2>/dev/null || true
}

# All files (-f) or folders (-d); names may hold blanks and what a shell makes names of.
_aset_any() {
    mapfile -t COMPREPLY < <(compgen "$1" -- "$2")
    compopt -o filenames 2>/dev/null || true
}

_aset_operand() {
    case $1 in
    scene) COMPREPLY=($(compgen -W "$_aset_scenes" -- "$2")) ;;
    compare | join | sheet) _aset_files "$2" png ppm ;;
    thumb) _aset_any -d "$2" ;;
    tables) COMPREPLY=() ;;
    render) _aset_files "$2" nff obj stl ply draft ;;
    *) _aset_files "$2" nff obj stl ply ;;
    esac
}

_aset() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} follows
    COMPREPLY=()
    if [ "$COMP_CWORD" = 1 ]; then
        _aset_files "$cur" nff obj stl ply draft
        COMPREPLY+=($(compgen -W "$_aset_commands --help --version" -- "$cur"))
        return 0
    fi
    case " $_aset_commands " in
    *" $command "*) ;;
    *) command=render ;; # a scene: the short form, which takes render's options
    esac
    # bash makes three words of --option=value
    if [ "$cur" = = ]; then
        cur=
    elif [ "$prev" = = ]; then
        prev=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    follows=$(_aset_value "$command:$prev")
    case $follows in
    words*) COMPREPLY=($(compgen -W "${follows#words }" -- "$cur")) ;;
    files) _aset_any -f "$cur" ;;
    folders) _aset_any -d "$cur" ;;
    nothing) ;;
    *)
        case $cur in
        -*) COMPREPLY=($(compgen -W "$(_aset_options "$command")" -- "$cur")) ;;
        *) _aset_operand "$command" "$cur" ;;
        esac
        ;;
    esac
    return 0
}
complete -F _aset aset
END
