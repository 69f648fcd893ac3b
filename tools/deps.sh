#!/bin/bash
# Installs what libaset's build and tests need and the machine lacks, through the system's package manager: deps.sh [consumers | cluster]
# consumers: what make consumers and make check-abi want besides; cluster: what examples/cluster wants besides.
set -eu

missing=""
have() { command -v "$1" >/dev/null 2>&1; }
have cc || have gcc || have clang || missing="$missing compiler"
have make || missing="$missing make"
have pkg-config || missing="$missing pkg-config"
if have pkg-config; then
    pkg-config --exists libpng || missing="$missing libpng"
    pkg-config --exists cmocka || missing="$missing cmocka"
else
    missing="$missing libpng cmocka"
fi
if [ "${1:-}" = consumers ]; then
    have c++ || have g++ || have clang++ || missing="$missing c++"
    have cmake || missing="$missing cmake"
    have meson || missing="$missing meson"
    have ninja || missing="$missing ninja"
    have git || missing="$missing git"
    have x86_64-w64-mingw32-g++ || ! have apt-get || missing="$missing mingw"
    have abidiff || ! { have apt-get || have dnf; } || missing="$missing abigail"
fi
if [ "${1:-}" = cluster ]; then
    have parallel || missing="$missing parallel"
    { have mpicc && have mpirun; } || missing="$missing mpi"
fi
if [ -z "$missing" ]; then
    echo "deps: everything asked for is here; nothing to do"
    exit 0
fi
echo "deps: missing:$missing"

# The package of each need, for the manager at hand: apt, dnf, pacman, apk, brew.
package() {
    case "$1:$2" in
    apt:c++ | apk:c++) echo g++ ;; dnf:c++) echo gcc-c++ ;; pacman:c++ | brew:c++) echo gcc ;;
    apt:mpi) echo libopenmpi-dev openmpi-bin ;; dnf:mpi) echo openmpi-devel ;; pacman:mpi) echo openmpi ;;
    apk:mpi) echo openmpi openmpi-dev ;; brew:mpi) echo open-mpi ;;
    apt:ninja | dnf:ninja) echo ninja-build ;; apt:mingw) echo g++-mingw-w64-x86-64 ;; apt:abigail) echo abigail-tools ;; *:abigail) echo libabigail ;;
    apt:compiler) echo gcc libc6-dev ;; apt:libpng) echo libpng-dev ;; apt:cmocka) echo libcmocka-dev ;;
    dnf:compiler) echo gcc ;; dnf:libpng) echo libpng-devel ;; dnf:cmocka) echo libcmocka-devel ;; dnf:pkg-config) echo pkgconf ;;
    pacman:compiler) echo gcc ;; pacman:pkg-config) echo pkgconf ;;
    apk:compiler) echo gcc musl-dev ;; apk:libpng) echo libpng-dev ;; apk:cmocka) echo cmocka-dev ;; apk:pkg-config) echo pkgconf ;;
    brew:compiler) echo gcc ;;
    *) echo "$2" ;;
    esac
}
packages() { for need in $missing; do package "$1" "$need"; done; }

as_root=""
if [ "$(id -u)" != 0 ] && have sudo; then as_root=sudo; fi
run() { echo "deps: $*"; "$@"; }
if have apt-get; then
    run $as_root apt-get update -qq
    # shellcheck disable=SC2046
    run $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $(packages apt)
elif have dnf; then run $as_root dnf install -y $(packages dnf)
elif have pacman; then run $as_root pacman -S --noconfirm --needed $(packages pacman)
elif have apk; then run $as_root apk add $(packages apk)
elif have brew; then run brew install $(packages brew)
else
    echo "deps: no package manager that this script knows (apt, dnf, pacman, apk, brew); please install:$missing" >&2
    exit 1
fi
echo "deps: done"
