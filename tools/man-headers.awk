# man-headers.awk - the public headers as a page for man: each header's prose, then its declarations, each with its own, in
# the headers' order. What is private there is named and not shown.

function quote(text) {
    gsub(/\\/, "\\e", text)
    return text
}

# One line of a comment's text; what stands indented there stays as it is.
function prose(line) {
    if (line ~ /^  /) {
        if (!drawn) {
            print ".PP\n.nf"
        }
        drawn = 1
        print "\\&" quote(line)
        return
    }
    if (drawn) {
        print ".fi"
        drawn = 0
        open = 0
    }
    if (line ~ /^ *$/) {
        open = 0
        return
    }
    sub(/^ +/, "", line)
    if (!open) {
        print ".PP"
        open = 1
    }
    line = quote(line)
    gsub(/^[.']/, "\\\\\\&&", line)
    print line
}

function end_prose() {
    if (drawn) {
        print ".fi"
    }
    drawn = 0
    open = 0
}

function flush_comment(    i) {
    for (i = 1; i <= n_comment; i++) {
        prose(comment[i])
    }
    end_prose()
    n_comment = 0
}

function declaration(line) {
    if (!shown) {
        print ".PP\n.nf\n.in +4n"
    }
    shown = 1
    print "\\&" quote(line)
}

function end_declaration() {
    if (shown) {
        print ".in\n.fi"
    }
    shown = 0
}

# A macro: all of it if it is short, else its head.
function macro(    i) {
    for (i = 1; i <= (n_macro > 5 ? 1 : n_macro); i++) {
        declaration(macro_lines[i] (n_macro > 5 ? " ..." : ""))
    }
    n_macro = 0
}

function take_comment(line) {
    sub(/^\/\* ?/, "", line)
    sub(/ *\*\/ *$/, "", line)
    sub(/^ \* ?/, "", line)
    sub(/^ \*$/, "", line)
    comment[++n_comment] = line
}

FNR == 1 {
    end_declaration()
    name = FILENAME
    sub(/.*\//, "", name)
    heading = 1
    private = 0
    n_skipped = 0
}

# ---- comments ----
in_comment || /^\/\*/ {
    if (!in_comment) {
        end_declaration()
        if (/^\/\* ---.*private/) {
            private = !/end of private/
            if (!private && n_skipped > 0) {
                print ".PP"
                print "To be held by your program, their fields being private:" names "."
            }
            names = ""
            n_skipped = private ? 0 : n_skipped
            next
        }
    }
    in_comment = !/\*\//
    if (!/^\/\*$/ && !/^ \*\/$/) {
        take_comment($0)
    }
    if (!in_comment && heading) {
        title = comment[1]
        sub(/^[a-z]+\.h - /, "", title)
        print ".SH \"aset/" name "\""
        comment[1] = toupper(substr(title, 1, 1)) substr(title, 2)
        heading = 0
        open = 1 # no blank line below a section's title
        flush_comment()
    }
    next
}

# ---- what is no declaration ----
/^#(include|ifndef|ifdef|if|else|elif|endif|error|undef)/ || /^extern "C"/ || /^#define ASET_[A-Z]+_H$/ { hidden = 0
    if (!/^#(ifndef|ifdef|if)/) { flush_comment() }
    next }
/^#define aset_/ { n_comment = 0; next }
/^#define ASET_CATEGORY_ENUM/ { next }
/^}$/ && !in_struct { next }
/^ *$/ { if (!in_struct) { flush_comment(); end_declaration() } next }

# ---- declarations ----
/^#define/ || in_macro {
    if (!in_macro) {
        flush_comment()
    }
    line = $0
    in_macro = line ~ /\\$/
    sub(/ *\\$/, "", line)
    macro_lines[++n_macro] = line
    if (!in_macro) {
        macro()
    }
    next
}
{
    if (!in_struct && /^typedef (struct|enum) aset_[a-z_]+ \{/) {
        is_private = private || (n_comment > 0 && comment[1] ~ /^Private/)
        struct_name = $3
        if (private) {
            names = names (names == "" ? " " : ", ") struct_name
            n_skipped++
            n_comment = 0
        }
    }
    starts = !in_struct
    if (/\{$/ && /^typedef/) {
        in_struct = 1
    }
    if (in_struct && is_private) {
        if (/^\}/) {
            in_struct = 0
            if (!private) {
                flush_comment()
                declaration("typedef struct " struct_name " " struct_name ";")
            }
        }
        next
    }
    if (starts) {
        flush_comment()
    }
    declaration($0)
    if (/^\}/) {
        in_struct = 0
        is_private = 0
    }
}
END { end_declaration() }
