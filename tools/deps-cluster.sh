#!/bin/bash
# Installs what the examples for many machines need and the machine lacks: GNU parallel, Open MPI.
set -eu
have() { command -v "$1" >/dev/null 2>&1; }
missing=""
have parallel || missing="$missing parallel"
{ have mpicc && have mpirun; } || missing="$missing mpi"
if [ -z "$missing" ]; then
    echo "deps: GNU parallel and Open MPI are here; nothing to do"
    exit 0
fi
package() {
    case "$1:$2" in
    apt:mpi) echo libopenmpi-dev openmpi-bin ;; dnf:mpi) echo openmpi-devel ;; pacman:mpi) echo openmpi ;;
    apk:mpi) echo openmpi openmpi-dev ;; brew:mpi) echo open-mpi ;;
    *) echo "$2" ;;
    esac
}
packages() { for need in $missing; do package "$1" "$need"; done; }
as_root=""
if [ "$(id -u)" != 0 ] && have sudo; then as_root=sudo; fi
run() { echo "deps: $*"; "$@"; }
# shellcheck disable=SC2046
if have apt-get; then
    run $as_root apt-get update -qq
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
