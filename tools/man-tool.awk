# man-tool.awk - records of help.awk as a part of a page for man. The records of the tool's own help become the description
# (-v own=1), those of a command a subsection.

function quote(text) {
    gsub(/\\/, "\\e", text)
    return text
}

# Hyphens that a reader may want to copy.
function prose(text) {
    text = quote(text)
    text = gensub_options(text)
    return text ~ /^[.']/ ? "\\&" text : text
}

function gensub_options(text,    out) {
    out = ""
    while (match(text, /(^|[ (])--?[a-z][a-z-]*/)) {
        word = substr(text, RSTART, RLENGTH)
        gsub(/-/, "\\-", word)
        out = out substr(text, 1, RSTART - 1) word
        text = substr(text, RSTART + RLENGTH)
    }
    return out text
}

# Options and words to type in bold, names of values in italics.
function head(text,    n, i, words, word, tail, out) {
    n = split(quote(text), words, " ")
    out = ""
    for (i = 1; i <= n; i++) {
        word = words[i]
        tail = ""
        if (word ~ /,$/ && word != ",") {
            tail = ","
            word = substr(word, 1, length(word) - 1)
        }
        gsub(/-/, "\\-", word)
        gsub(/\./, "\\\\\\&.", word)
        if (word ~ /^\\-/ || word ~ /^[a-z]/) {
            word = "\\fB" word "\\fR"
        } else if (word ~ /^[A-Z]/) {
            word = "\\fI" word "\\fR"
        }
        out = out (i > 1 ? " " : "") word tail
    }
    return out
}

# One sentence a line, as man's sources have it.
function paragraph(text) {
    text = prose(text)
    gsub(/[.] /, ".\n", text)
    gsub(/\n[.]/, "\n\\\\\\&.", text)
    print text
}

BEGIN { FS = "\t" }
$1 == "usage" && own { paragraph($3) }
$1 == "usage" && !own {
    command = $2
    sub(/^aset /, "", command)
    sub(/ .*/, "", command)
    print ".SS aset " command
    print head($2)
    print ".PP"
    paragraph($3)
}
$1 == "item" { print ".TP"; print head($2); paragraph($3) }
$1 == "text" { print ".PP"; paragraph($2) }
$1 == "part" { print ".PP"; print $2 ":" }
