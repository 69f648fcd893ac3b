#!/bin/bash
# Installs what `make firmware-test` and `make size` want and the machine lacks: cross compilers with their C libraries, QEMU.
set -eu
missing=""
have() { command -v "$1" > /dev/null 2>&1; }
have arm-none-eabi-gcc && echo '#include <math.h>' | arm-none-eabi-gcc -E - > /dev/null 2>&1 || missing="$missing arm-compiler"
have qemu-system-arm || missing="$missing arm-qemu"
have riscv64-unknown-elf-gcc && echo '#include <math.h>' | riscv64-unknown-elf-gcc --specs=picolibc.specs -E - > /dev/null 2>&1 ||
    missing="$missing riscv-compiler"
have qemu-system-riscv32 || missing="$missing riscv-qemu"
if [ -z "$missing" ]; then
    echo "deps-firmware: compilers and QEMU for Arm and RISC-V are here; nothing to do"
    exit 0
fi
echo "deps-firmware: missing:$missing"
packages=""
for need in $missing; do
    case "$need" in
    arm-compiler) packages="$packages gcc-arm-none-eabi libnewlib-arm-none-eabi" ;;
    arm-qemu) packages="$packages qemu-system-arm" ;;
    riscv-compiler) packages="$packages gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf" ;;
    riscv-qemu) packages="$packages qemu-system-misc" ;;
    esac
done
if ! have apt-get; then
    echo "deps-firmware: this script knows apt alone; please install what Debian calls:$packages" >&2
    exit 1
fi
as_root=""
if [ "$(id -u)" != 0 ] && have sudo; then as_root=sudo; fi
$as_root apt-get update -qq
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $packages
echo "deps-firmware: done"
