# What the consumers' build.sh share: each is run with this before it, in a copy of its folder, and stops at the first failure.
# From run.sh: ROOT is the library's folder, BUILD what make has built there, EXPECTED the picture; CC and CXX the compilers.
set -eu

needs() { # the programs that this consumer cannot do without
    for tool in "$@"; do
        if ! command -v "${tool%% *}" > /dev/null 2>&1; then
            echo "skipped, ${tool%% *} is not here (make deps-consumers)"
            exit 77
        fi
    done
}

check() { # a program draws the same picture
    "./$1" > "$1.ppm"
    cmp "$1.ppm" "$EXPECTED"
    echo "$1 draws the same picture"
}

exports() { # archives, shared libraries, objects: they give other programs names of libaset only
    for file in "$@"; do
        case $file in
        *.so*) names=$(nm -D --defined-only "$file") ;;
        *) continue ;;
        esac
        names=$(echo "$names" | awk 'NF == 3 && $3 !~ /^aset_/ && !seen[$3]++ { print $3 }')
        if [ -n "$names" ]; then
            echo "$file exports names that are not libaset's:" $names
            exit 1
        fi
    done
}
