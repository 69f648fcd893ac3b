# amalgamate.awk - makes two files of the library: aset.h of the public headers, aset.c of all the rest.
#   awk -f tools/amalgamate.awk -v out=DIRECTORY LICENSE include/aset/*.h lib/*/*.h lib/base/*.c ... lib/procedural/*.c
#
# In one file all names meet. So what a file declares for itself is told from what others mean by the same word:
#   - functions that private headers declare become static there, and so wherever they are defined;
#   - a name that a file (or a private header, for those who include it) keeps to itself, and that any other file uses for
#     anything, gets the file's name in front: cell in mount.c becomes mount_cell. Members of structs are left alone;
#   - macros of a .c file are undefined at its end.
# That is read off the house's layout: what stands at file scope begins in the first column. It is no parser of C; what it gets
# wrong does not compile, and tests/consumers/amalgamation compiles it in many ways and looks at its symbols.
#
# ASET_PREFIX renames every public function and constant, by a list made here from the public headers.

function fail(text) {
    print "amalgamate: " text > "/dev/stderr"
    failed = 1
    exit 1
}

FNR == 1 {
    files[++n_files] = FILENAME
}
{
    line[FILENAME, FNR] = $0
    lines[FILENAME] = FNR
}

# --- what a file is ---

function is_public(file) { return file ~ /^include\// }
function is_header(file) { return file ~ /^lib\/.*\.h$/ }
function is_source(file) { return file ~ /\.c$/ }
function room_of(file) { sub(/^lib\//, "", file); sub(/\/.*/, "", file); return file }

# The file that an #include in file names, "" for a system header and for lines that are none.
function included(file, text) {
    if (text !~ /^#include "/) {
        return ""
    }
    gsub(/^#include "|".*$/, "", text)
    if (text ~ /^aset\//) {
        return "include/" text
    }
    if (text !~ /\//) {
        sub(/[^\/]*$/, "", file)
        return file text
    }
    return "lib/" text
}

# sees[file, header]: file includes it, directly or through others.
function find_seen(file, by,    i, name) {
    for (i = 1; i <= lines[file]; i++) {
        name = included(file, line[file, i])
        if (name != "" && !((by, name) in sees)) {
            if (!(name in lines)) {
                fail(file ":" i ": " name " is not among the files")
            }
            sees[by, name] = 1
            find_seen(name, by)
        }
    }
}

# --- words: identifiers outside of comments and texts ---

# Splits a line into words, which stand in word[] from at[] on, with what stands before and after; returns how many.
# in_comment goes on from line to line.
function split_words(text,    n, offset, token, before) {
    n = offset = 0
    before = ""
    while (text != "") {
        if (in_comment) {
            if (!match(text, /\*\//)) {
                return n
            }
            in_comment = 0
            offset += RSTART + 1
            text = substr(text, RSTART + 2)
            continue
        }
        if (!match(text, /[A-Za-z_][A-Za-z_0-9]*|[0-9][A-Za-z_0-9.]*|\/\*|"(\\.|[^"\\])*"|'(\\.|[^'\\])*'/)) {
            break
        }
        token = substr(text, RSTART, RLENGTH)
        before = before substr(text, 1, RSTART - 1)
        if (token == "/*") {
            in_comment = 1
        } else if (token ~ /^[A-Za-z_]/) {
            word[++n] = token
            at[n] = offset + RSTART
            sub(/[ \t]+$/, "", before)
            before_word[n] = before
            after_word[n] = substr(text, RSTART + RLENGTH)
            before = ""
        } else {
            before = ""
        }
        offset += RSTART + RLENGTH - 1
        text = substr(text, RSTART + RLENGTH)
    }
    return n
}

# Word i of the line just split belongs to a struct: it is asked for by . or ->, or (in a struct's body) it is declared here.
function is_member(i, in_struct) {
    return before_word[i] ~ /(->|\.)$/ || (in_struct && after_word[i] ~ /^ *[;,:\[)]/)
}

function opens_struct(text) { return text ~ /^(typedef |static const )?(struct|union)( [a-z_0-9]+)? \{$/ }

function find_words(file,    i, k, n, in_struct) {
    in_comment = in_struct = 0
    for (i = 1; i <= lines[file]; i++) {
        if (line[file, i] ~ /^#include/) {
            continue
        }
        n = split_words(line[file, i])
        for (k = 1; k <= n; k++) {
            if (!is_member(k, 0) && !((file, word[k]) in has)) {
                has[file, word[k]] = 1
                users[word[k]] = users[word[k]] " " file
            }
        }
    }
    if (in_comment) {
        fail(file ": a comment does not end")
    }
}

# --- names that a file declares for itself ---

function own_name(file, name) {
    if (name != "" && name !~ /^aset_/ && !((file, name) in own)) {
        own[file, name] = 1
        names_of[file] = names_of[file] " " name
    }
}

function last_name(text) {
    sub(/^.*[^A-Za-z_0-9]/, "", text)
    return text
}

function find_names(file,    i, text, enumerators, in_enum) {
    in_enum = 0
    for (i = 1; i <= lines[file]; i++) {
        text = line[file, i]
        if (text ~ /^#define [A-Za-z_0-9]+/) {
            sub(/^#define /, "", text)
            sub(/[^A-Za-z_0-9].*/, "", text)
            if (is_header(file)) {
                own_name(file, text)
            } else if (!((file, text) in is_macro)) {
                is_macro[file, text] = 1
                macros_of[file] = macros_of[file] " " text
            }
        } else if (text ~ /^(typedef )?enum( [a-z_0-9]+)? *\{/) {
            in_enum = 1
        } else if (text ~ /^(typedef )?(struct|union) [a-z_0-9]+ \{/) {
            own_name(file, text ~ /^typedef/ ? "" : last_name(substr(text, 1, index(text, " {") - 1)))
        } else if (text ~ /^(static|FUSED) .*\(/ && text !~ /^static [^(]*=/) {
            own_name(file, last_name(substr(text, 1, index(text, "(") - 1)))
        } else if (text ~ /^static / && text !~ /\{$/) {
            sub(/ *[=;\[,].*/, "", text)
            own_name(file, last_name(text))
        } else if (text ~ /^static .*[=\[]/) {
            sub(/ *[=\[].*/, "", text)
            own_name(file, last_name(text))
        } else if (text ~ /^\} [a-z_0-9]+/) {
            text = substr(text, 3)
            sub(/[^a-z_0-9].*/, "", text)
            own_name(file, text)
        } else if (text ~ /^typedef [^(]*;$/) {
            own_name(file, last_name(substr(text, 1, length(text) - 1)))
        } else if (text ~ /^typedef [^(]*\(\*?[a-z_0-9]+\)/) {
            sub(/^typedef [^(]*\(\*?/, "", text)
            sub(/\).*/, "", text)
            own_name(file, text)
        }
        if (in_enum) {
            enumerators = enumerators line[file, i]
            if (line[file, i] ~ /\}/) {
                in_enum = 0
                own_enumerators(file, enumerators)
                enumerators = ""
            }
        }
    }
}

function own_enumerators(file, text,    n, i, parts) {
    if (match(text, /\} *[a-z_0-9]+;/)) {
        own_name(file, last_name(substr(text, RSTART, RLENGTH - 1)))
    }
    gsub(/\/\*[^*]*\*\//, "", text)
    sub(/^[^{]*\{/, "", text)
    sub(/\}.*/, "", text)
    n = split(text, parts, ",")
    for (i = 1; i <= n; i++) {
        if (parts[i] !~ /[()#]/) {
            sub(/=.*/, "", parts[i])
            gsub(/[ \t]/, "", parts[i])
            own_name(file, parts[i])
        }
    }
}

# Does a file use the name without meaning this one's?
function is_contested(file, name,    n, i, list) {
    n = split(users[name], list, " ")
    for (i = 1; i <= n; i++) {
        if (list[i] != file && !(is_header(file) && ((list[i], file) in sees))) {
            return 1
        }
    }
    return 0
}

function base_name(file) {
    sub(/^.*\//, "", file)
    sub(/\.[ch]$/, "", file)
    return file
}

function choose_names(file,    n, i, list, name, new) {
    n = split(names_of[file], list, " ")
    for (i = 1; i <= n; i++) {
        name = list[i]
        if (!is_contested(file, name)) {
            continue
        }
        new = base_name(file) "_" name
        if (name ~ /^[A-Z_0-9]+$/) {
            new = toupper(new)
        }
        while (new in users || new in taken) {
            new = new "_"
        }
        taken[new] = 1
        renamed[file, name] = new
    }
}

# What a file calls name in the amalgamation: its own, or that of a header which it includes.
function new_name(file, name,    i) {
    if ((file, name) in renamed) {
        return renamed[file, name]
    }
    for (i = 1; i <= n_headers; i++) {
        if (((headers[i], name) in renamed) && ((file, headers[i]) in sees)) {
            return renamed[headers[i], name]
        }
    }
    return name
}

# --- writing ---

function is_prototype(text) {
    return text ~ /^[a-z][a-z_0-9]* [^=]*[a-z_0-9]\(/ && text !~ /^(static|typedef|enum|struct|union|extern) /
}

# Where a function or constant of a private header is declared or defined: it becomes static, and stays so.
function is_internal(file, text,    name) {
    if (text ~ /^const (struct )?[a-z_]+ [a-z_0-9]+(\[| = )/) {
        name = text
        sub(/(\[| = ).*/, "", name)
        return last_name(name) in internal
    }
    if (!is_prototype(text)) {
        return 0
    }
    name = last_name(substr(text, 1, index(text, "(") - 1))
    if (is_header(file)) {
        internal[name] = 1
    }
    return name in internal
}

function emit(file, target,    i, k, n, text, from, in_struct) {
    print "\n/* --- " file " --- */\n" > target
    in_comment = in_struct = 0
    for (i = 1; i <= lines[file]; i++) {
        text = line[file, i]
        if (text ~ /^#include "/) {
            continue
        }
        if (opens_struct(text)) {
            in_struct = 1
        } else if (text ~ /^\}/) {
            in_struct = 0
        }
        if (is_header(file) && text ~ /^ +aset_status aset_[a-z_]+##/) { # declared by a macro, one for each of a list
            sub(/^ +/, "    static ", text)
        }
        n = split_words(text)
        from = 1
        if (is_header(file) && text ~ /^extern /) {
            printf "static" > target
            from = 7
            sub(/[\[;].*/, "", text)
            internal[last_name(text)] = 1
            text = line[file, i]
        } else if (is_internal(file, text)) {
            printf "static " > target
        }
        for (k = 1; k <= n; k++) {
            if (at[k] >= from && !is_member(k, in_struct) && text !~ /^#include/) {
                printf "%s%s", substr(text, from, at[k] - from), new_name(file, word[k]) > target
                from = at[k] + length(word[k])
            }
        }
        print substr(text, from) > target
    }
    n = split(macros_of[file], undefined, " ")
    if (is_source(file)) {
        for (i = 1; i <= n; i++) {
            print "#undef " undefined[i] > target
        }
    }
    emitted[file] = 1
}

# A header after those that it includes.
function emit_header(file, target,    i, name) {
    if (file in emitted) {
        return
    }
    emitted[file] = 1
    for (i = 1; i <= lines[file]; i++) {
        name = included(file, line[file, i])
        if (name != "" && is_public(name) == is_public(file)) {
            emit_header(name, target)
        }
    }
    emit(file, target)
}

function emit_license(target, what,    i) {
    printf "/*\n * libaset %s in two files, aset.h and aset.c: %s\n * Made by `make amalgamation`; change the sources, not this.\n *\n", version, what > target
    for (i = 1; i <= lines[files[1]]; i++) {
        print (line[files[1], i] == "" ? " *" : " * " line[files[1], i]) > target
    }
    print " */" > target
}

# The names that ASET_PREFIX changes: functions and constants of the public headers; those with the layout's switches keep them.
function emit_prefix(target,    i, k, n, file, text, list, name) {
    print "\n/* --- names of another prefix: -DASET_PREFIX=my_, for aset.c and for all that includes aset.h --- */\n" > target
    print "#ifdef ASET_PREFIX\n#define ASET_RENAMED_PASTE(prefix, name) prefix##name" > target
    print "#define ASET_RENAMED_EXPAND(prefix, name) ASET_RENAMED_PASTE(prefix, name)" > target
    print "#define ASET_RENAMED(name) ASET_RENAMED_EXPAND(ASET_PREFIX, name)" > target
    for (i = 1; i <= lines["include/aset/config.h"]; i++) {
        text = line["include/aset/config.h", i]
        if (text ~ /^#define aset_[a-z_0-9]+ ASET_LAYOUT\(/) {
            split(text, list, " ")
            has_layout[list[2]] = 1
        }
    }
    for (k = 1; k <= n_files; k++) {
        file = files[k]
        for (i = 1; is_public(file) && i <= lines[file]; i++) {
            text = line[file, i]
            n = 0
            if (is_prototype(text)) {
                n = split(last_name(substr(text, 1, index(text, "(") - 1)), list, " ")
            } else if (text ~ /^extern const .*;$/) {
                gsub(/^extern const [a-z_]+ |;$|,/, "", text)
                n = split(text, list, " ")
            }
            for (name = 1; name <= n; name++) {
                emit_renamed(target, list[name])
            }
        }
    }
    print "#endif" > target
}

function emit_renamed(target, name,    short) {
    if (name !~ /^aset_/) {
        fail(name " is public and does not begin with aset_")
    }
    short = substr(name, 6)
    if (name in has_layout) {
        printf "#undef %s\n#define %s ASET_LAYOUT(ASET_RENAMED(%s))\n", name, name, short > target
    } else {
        printf "#define %s ASET_RENAMED(%s)\n", name, short > target
    }
}

function emit_rooms(target, wanted,    i) {
    for (i = 1; i <= n_files; i++) {
        if (is_header(files[i]) && index(wanted, " " room_of(files[i]) " ")) {
            emit_header(files[i], target)
        }
    }
    for (i = 1; i <= n_files; i++) {
        if (is_source(files[i]) && index(wanted, " " room_of(files[i]) " ")) {
            emit(files[i], target)
        }
    }
}

END {
    if (failed) {
        exit 1
    }
    header = out "/aset.h"
    source = out "/aset.c"
    for (i = 1; i <= lines["include/aset/config.h"]; i++) {
        if (line["include/aset/config.h", i] ~ /^#define ASET_VERSION "/) {
            split(line["include/aset/config.h", i], parts, "\"")
            version = parts[2]
        }
    }
    for (f = 1; f <= n_files; f++) {
        if (is_header(files[f])) {
            headers[++n_headers] = files[f]
        }
        if (files[f] ~ /\.[ch]$/) {
            find_seen(files[f], files[f])
            find_words(files[f])
        }
    }
    for (f = 1; f <= n_files; f++) {
        if (files[f] ~ /^lib\//) {
            find_names(files[f])
        }
    }
    for (f = 1; f <= n_files; f++) {
        choose_names(files[f])
    }

    emit_license(header, "what a program includes.")
    print "#ifndef ASET_AMALGAMATION_H\n#define ASET_AMALGAMATION_H" > header
    emit_header("include/aset/config.h", header)
    emit_prefix(header)
    emit_header("include/aset/aset.h", header)
    emit_header("include/aset/load.h", header)
    emit_header("include/aset/procedural.h", header)
    print "\n#endif" > header

    emit_license(source, "what is compiled, as C99 and with -ffp-contract=off.\n * ASET_AMALGAMATION_LOAD=1 adds the readers of load.h, " \
        "ASET_AMALGAMATION_PROCEDURAL=1 the scenes of procedural.h.")
    print "#include \"aset.h\"" > source
    print "\n/* What the switches leave without a caller is static here. */" > source
    print "#if defined(__GNUC__) || defined(__clang__)\n#pragma GCC diagnostic ignored \"-Wunused-function\"\n#endif" > source
    emit_rooms(source, " base scene space approx trace ")
    print "\n#if defined(ASET_AMALGAMATION_LOAD) && ASET_AMALGAMATION_LOAD" > source
    emit_rooms(source, " load ")
    print "\n#endif\n\n#if defined(ASET_AMALGAMATION_PROCEDURAL) && ASET_AMALGAMATION_PROCEDURAL" > source
    emit_rooms(source, " procedural ")
    print "\n#endif" > source
    for (f = 2; f <= n_files; f++) {
        if (!(files[f] in emitted)) {
            fail(files[f] " is in no room")
        }
    }
}
