#!/bin/bash
# The pages aset(1) and libaset(3) say what there is and no more: man.sh ASET DIRECTORY CC
#   aset(1)      its commands and options are those of the help texts, and these are those that the tool's sources take
#   libaset(3)   its functions, methods and macros are those that the compiler sees in the public headers
# and both pass mandoc -Tlint, or man --warnings, where there is one. Checks the help texts of all commands on the way.
set -u
aset=$1
dir=$2
cc=$3
export LC_ALL=C
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
bad=0
fail() {
    echo "man: $*"
    bad=1
}
# Two lists of words: a description, the file that is right, the file that is looked at.
same() {
    sort -u "$2" >"$work/a"
    sort -u "$3" >"$work/b"
    local left right
    [ -s "$work/a" ] || fail "$1: nothing found to compare with"
    left=$(comm -23 "$work/a" "$work/b" | tr '\n' ' ')
    right=$(comm -13 "$work/a" "$work/b" | tr '\n' ' ')
    [ -z "$left" ] || fail "$1: missing: $left"
    [ -z "$right" ] || fail "$1: too much: $right"
}
# The text of a page, its escapes undone.
plain() { sed -e 's/\\f[BIR]//g' -e 's/\\-/-/g' -e 's/\\&//g' -e 's/\\e/\\/g' "$1"; }
# Options in a text: those at the start of a line or behind a blank or bracket.
options() { grep -oE -e '(^|[ ([|])-(-[a-z][a-z-]*|[a-z]\b)' | tr -d ' ([|' | grep -v -e '^-$'; }
# Heads of items: up to where two blanks stand, in lines that begin with blanks and an option.
heads() { sed -n 's/^ \{2,6\}\(-.*\)/\1/p' | sed 's/   *[^ -].*//' | tr ',' ' ' | options; }

plain "$dir/aset.1" >"$work/aset.1"
"$aset" --help >"$work/help" || fail "aset --help fails"
sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' "$work/help" >"$work/commands"
sed -n 's/^\.SS aset //p' "$work/aset.1" >"$work/sections"
same "aset(1): commands" "$work/commands" "$work/sections"
sed -n 's/^    {"\([a-z]*\)", "[^"]*", command_[a-z]*},/\1/p' tools/aset.c >"$work/table"
same "aset --help: commands" "$work/table" "$work/commands"
for command in $(cat "$work/commands"); do
    "$aset" "$command" --help >"$work/help" || fail "aset $command --help fails"
    heads <"$work/help" >"$work/of_help"
    awk -v want=".SS aset $command" '/^\.S[SH]/ { on = $0 == want } on' "$work/aset.1" >"$work/section"
    awk 'item { print } { item = $0 == ".TP" }' "$work/section" | grep -e '^-' | tr ',' ' ' | options >"$work/of_page"
    same "aset(1), $command" "$work/of_help" "$work/of_page"
    { # and those that several commands share
        cat "tools/$command.c"
        for shared in $(grep -oE 'SETTINGS_[A-Z]+_OPTIONS?' "tools/$command.c"); do
            awk -v name="$shared" '$2 == name { on = 1 } on { print; on = /\\$/ }' tools/prepare.h
        done
    } | grep -oE '\{"[a-z-]+", (required|no|optional)_argument' | sed 's/{"\([^"]*\).*/--\1/' >"$work/of_code"
    grep -e '^--' "$work/of_help" >"$work/long"
    same "aset $command --help and tools/$command.c" "$work/of_code" "$work/long"
    # every word of the help is on the page
    tr -s ' \n' '\n\n' <"$work/help" | sort -u >"$work/words"
    tr -s ' \n' '\n\n' <"$work/section" | sort -u >"$work/page_words"
    lost=$(comm -23 "$work/words" "$work/page_words" | grep -vE '^(\(?Options:|Scenes:|[^a-zA-Z]*)$' | sed 's/[:,.]*$//' |
        while read -r word; do grep -qF -e "$word" "$work/section" || printf '%s ' "$word"; done)
    [ -z "$lost" ] || fail "aset(1), $command: words of the help are missing: $lost"
done
version=$("$aset" --version)
for page in aset.1 libaset.3; do
    head -n 1 "$dir/$page" | grep -qF "\"lib$version\"" || fail "$page is not of $version: $(head -n 1 "$dir/$page")"
done

plain "$dir/libaset.3" >"$work/libaset.3"
printf '#include <aset/%s.h>\n' aset load procedural >"$work/all.c"
$cc -std=c99 -Iinclude -E -P "$work/all.c" 2>/dev/null | sed 's/__\(32\|64\)_[01]*//g' | tr '\n' ' ' >"$work/seen"
grep -oE '\baset_[a-z0-9_]+\(' "$work/seen" | tr -d '(' >"$work/functions"
grep -oE '\bextern const aset_method [^;]*' "$work/seen" | grep -oE 'aset_[a-z]+' | grep -v '^aset_method$' >>"$work/functions"
# of the page: in declarations, which are indented by its requests; not in prose
awk '/^\.in \+4n/ { on = 1; next } /^\.in$/ { on = 0 } on' "$work/libaset.3" >"$work/declared"
{
    grep -oE '\baset_[a-z0-9_]+\(' "$work/declared" | tr -d '('
    sed -n 's/^extern const aset_method//p' "$work/declared" | grep -oE 'aset_[a-z]+'
} >"$work/of_page"
same "libaset(3): functions" "$work/functions" "$work/of_page"
macros() { $cc -std=c99 -Iinclude -dM -E "$1" | sed -n 's/^#define \(ASET_[A-Za-z0-9_]*\).*/\1/p' | grep -v '_H$'; }
macros "$work/all.c" >"$work/macros"
sed -n 's/^#define \(ASET_[A-Z0-9_]*\).*/\1/p' "$work/declared" >"$work/of_page"
same "libaset(3): macros" "$work/macros" "$work/of_page"
# Names that prose mentions are there: of functions, types, constants, fields' structs.
cat include/aset/*.h | grep -oE '\b(aset|ASET)_[A-Za-z0-9_]+' | sort -u >"$work/names"
grep -oE '\b(aset|ASET)_[A-Za-z0-9_]+' "$work/libaset.3" | sort -u | comm -13 "$work/names" - >"$work/unknown"
[ ! -s "$work/unknown" ] || fail "libaset(3): no header has $(tr '\n' ' ' <"$work/unknown")"

linted=
for page in aset.1 libaset.3; do
    if command -v mandoc >/dev/null; then
        linted="mandoc -Tlint"
        mandoc -Tlint -Wwarning "$dir/$page" >"$work/lint" 2>&1 || fail "$page: $(head -n 1 "$work/lint")"
    elif man --version >/dev/null 2>&1 && man --help 2>/dev/null | grep -q -e --warnings; then
        linted="man --warnings"
        man --warnings -E UTF-8 -l "$dir/$page" 2>"$work/lint" >/dev/null
        [ ! -s "$work/lint" ] || fail "$page: $(head -n 1 "$work/lint")"
    fi
done
[ $bad = 0 ] && echo "man: $(wc -l <"$work/commands") commands, $(sort -u "$work/functions" | wc -l) functions and methods," \
    "$(sort -u "$work/macros" | wc -l) macros; ${linted:-no mandoc and no man --warnings here, so not linted}"
exit $bad
