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
