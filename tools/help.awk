# help.awk - a text of `aset --help` or `aset COMMAND --help` as records, one a line, fields separated by tabs, for the man
# page, the completion and their tests:
#
#     usage  SYNOPSIS  TEXT      the first paragraph, up to its first colon and behind it
#     item   HEAD  TEXT          an option, a scene, a key: two spaces or more stand between the two
#     part   TITLE               a line of a title and a colon
#     text   TEXT                any other paragraph

function flush() {
    if (kind != "") {
        print kind "\t" (kind == "item" ? head "\t" : "") text
    }
    kind = ""
}

function add(words) {
    text = text == "" ? words : text " " words
}

NR == 1 {
    colon = index($0, ": ")
    kind = "usage\t" substr($0, 1, colon - 1)
    text = substr($0, colon + 2)
    next
}
/^$/ { flush(); next }
/^[A-Z][a-z]*:$/ { flush(); print "part\t" substr($0, 1, length($0) - 1); next }
/^        / && kind == "item" { sub(/^ +/, ""); add($0); next }
/^  +[^ ].*  +[^ ]/ {
    flush()
    sub(/^ +/, "")
    kind = "item"
    at = match($0, /   *[^ ]/)
    head = substr($0, 1, at - 1)
    text = substr($0, at)
    sub(/^ +/, "", text)
    next
}
{
    if (kind == "item") {
        flush()
    }
    if (kind == "") {
        kind = "text"
        text = ""
    }
    add($0)
}
END { flush() }
