# completion.awk - records of help.awk, each with its command in front, as what bash completes: lines of a case for
# `COMMAND)` with the options, and of one for `COMMAND:OPTION)` with what follows it. Values by their names in the help:
# FILE, FOLDER and DIR are names of files; small letters are words; the rest is in words below.

function add(command, option) {
    if (!(command in options)) {
        order[++n_commands] = command
    }
    options[command] = options[command] " " option
}

function values(command, option, value) {
    if (command == "render" && option ~ /^(-m|--method)$/) {
        return "words mset aset set grid octree arts excell brute"
    }
    if (command == "trade" && option ~ /^(-m|--methods)$/) {
        return "words all mset aset set grid octree arts excell brute"
    }
    if (command == "plan" && option ~ /^(-m|--method)$/) {
        return "words mset aset set grid brute"
    }
    if (option == "--approx") {
        return "words all none primary shadow reflected refracted"
    }
    if (option == "--cells") {
        return "words flat normal plane"
    }
    if (option == "--curtail-when") {
        return "words less more"
    }
    if (value == "FILE" || option ~ /^(-o|--output)$/ && value == "F") {
        return "files"
    }
    if (value ~ /^(FOLDER|DIR)$/) {
        return "folders"
    }
    if (value ~ /^[a-z|]+$/) {
        gsub(/\|/, " ", value)
        return "words " value
    }
    return "nothing"
}

BEGIN { FS = "\t" }
$2 != "item" || $3 !~ /^-/ { next }
{
    n = split($3, word, " ")
    n_waiting = 0
    for (i = 1; i <= n; i++) {
        joined = word[i] ~ /,$/
        sub(/,$/, "", word[i])
        if (word[i] ~ /^-/) {
            add($1, word[i])
            waiting[++n_waiting] = word[i]
            if (!joined && (i == n || word[i + 1] ~ /^-/)) {
                n_waiting = 0
            }
            continue
        }
        for (k = 1; k <= n_waiting; k++) {
            follows[++n_follows] = "    " $1 ":" waiting[k] ") echo " values($1, waiting[k], word[i]) " ;;"
        }
        n_waiting = 0
    }
}
END {
    print "_aset_options() {\n    case $1 in"
    for (i = 1; i <= n_commands; i++) {
        print "    " order[i] ") echo \"" substr(options[order[i]], 2) "\" ;;"
    }
    print "    esac\n}\n"
    print "# What follows an option of a command: words, files, folders, nothing in particular; or it takes no value: no."
    print "_aset_value() {\n    case $1 in"
    for (i = 1; i <= n_follows; i++) {
        print follows[i]
    }
    print "    *) echo no ;;\n    esac\n}"
}
