#!/bin/bash
# The programs of examples/firmware built for bare metal, run under QEMU, and their pictures, counts and arenas compared with the
# same programs' on the host; RAM and stack against their limits: firmware.sh ASET BUILD CC [MODEL]
# MODEL (.obj, .stl, .ply, .nff) takes the place of the project's own skull. Without the tools it says so and ends well.
set -eu
aset=$(realpath "$1")
build=$2
cc=$3
model=${4:-}
dir=$build/firmware
bad=0
ran=0
fail() { echo "firmware: $1"; bad=1; }
mkdir -p "$dir"
sources="lib/procedural/snow.c lib/procedural/emit.c lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c"
flags="-std=c99 -O2 -ffp-contract=off -ffunction-sections -fdata-sections -Wl,--gc-sections -Iinclude -Ilib -I$dir -Iexamples/firmware"

# The most that a program may take. RAM: all that is written to, with the deepest stack; beside the draft, which is const.
draft_ram=16384 draft_stack=4096 snow_ram=65536 snow_stack=4608 flash=524288

if [ -n "$model" ]; then
    "$aset" bake "$model" --grid "${GRID:-64}" --name model --quiet -o "$dir/model.h"
else
    "$aset" scene skull -o "$dir/skull.nff"
    "$aset" bake "$dir/skull.nff" --grid "${GRID:-40}" --name model --quiet -o "$dir/model.h"
fi

run() { # name, program, command: writes its pictures and what it says into its folder
    name=$1
    program=$2
    shift 2
    if ! (cd "$dir/$name" && timeout 300 "$@" < /dev/null > "$program.txt" 2>&1); then
        fail "$name: $program ends badly"
        cat "$dir/$name/$program.txt"
        return 1
    fi
}

mkdir -p "$dir/host"
rm -f "$dir"/*/*.ppm
for program in snow draft; do
    # shellcheck disable=SC2086
    "$cc" $flags "examples/firmware/$program.c" examples/firmware/board_host.c $sources -o "$dir/host/$program" -lm
    run host $program "./$program"
done

number() { sed -n "s/^$2: \([0-9]*\).*/\1/p" "$1"; }
within() { # board, program, what, limit
    bytes=$(number "$dir/$1/$2.txt" "$3")
    if [ -z "$bytes" ] || [ "$bytes" -gt "$4" ]; then
        fail "$1: $2: $3 of ${bytes:-unknown} bytes, over $4"
    else
        echo "    $3: $bytes bytes of at most $4"
    fi
}
try() { # board, program: after it was run
    for picture in "$dir/host/$2"*.ppm; do
        cmp "$picture" "$dir/$1/$(basename "$picture")" || fail "$1: $(basename "$picture") differs from the host's"
    done
    # rays, and bytes by category: word by word what the host says
    if ! grep -E ' rays$|^(objects|vertices|materials|cells|references|voxels|textures|scratch|arena|draft in flash): ' \
        "$dir/$1/$2.txt" | cmp - "$dir/host/$2.txt"; then
        fail "$1: $2 counts otherwise than on the host"
    fi
    echo "$1: $2: pictures, rays and arena are the host's, byte by byte"
    grep -E ' rays$|, a ray|, unit' "$dir/$1/$2.txt" | paste -sd '~' | sed 's/~[^~]*unit: \([a-z]*\)/ \1/g; s/~\([^~]*, a ray\)/; \1/g; s/~/\n/g' |
        sed 's/^/    /'
    grep -E '^[a-z ]*: [0-9]* bytes$' "$dir/$1/$2.txt" | paste -sd , | sed 's/,/, /g; s/^/    /'
    within "$1" "$2" "flash in all" $flash
    if [ "$2" = draft ]; then
        within "$1" draft "ram with deepest stack" $draft_ram
        within "$1" draft "deepest stack" $draft_stack
    else
        within "$1" snow "ram with deepest stack" $snow_ram
        within "$1" snow "deepest stack" $snow_stack
    fi
}
link() { # board, program, output, compiler and its own flags
    board=$1
    program=$2
    out=$3
    shift 3
    case "$board" in m4) startup=startup_cortex_m.c script=cortex_m4.ld ;; *) startup=startup_riscv.c script=riscv_virt.ld ;; esac
    mkdir -p "$dir/$board"
    # shellcheck disable=SC2086
    "$@" $flags -fno-math-errno "examples/firmware/$program.c" examples/firmware/board_semihosting.c "examples/firmware/$startup" $sources \
        -nostartfiles -Texamples/firmware/$script -o "$dir/$board/$out.elf" -lm
}
has() { # board, what it wants
    board=$1
    shift
    for tool in "$@"; do
        command -v "$tool" > /dev/null 2>&1 || { echo "firmware: $board skipped, $tool is not here (make deps-firmware)"; return 1; }
    done
}

# An instruction takes 1 ns of the board's time with -icount 0; its SysTick has 25 MHz, so a tick is 40 of them.
m4="arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 --specs=nano.specs -DINSTRUCTIONS_A_TICK=40"
m4_run="qemu-system-arm -M mps2-an386 -nographic -semihosting -icount 0 -kernel"
rv="riscv64-unknown-elf-gcc -march=rv32imafc -mabi=ilp32f -mcmodel=medany --specs=picolibc.specs"
rv_run="qemu-system-riscv32 -M virt -m 16M -bios none -nographic -semihosting -icount 0 -kernel"
for board in m4 rv32; do
    # shellcheck disable=SC2086
    case $board in
    m4) has $board arm-none-eabi-gcc qemu-system-arm || continue; compile=$m4 start=$m4_run ;;
    *) has $board riscv64-unknown-elf-gcc qemu-system-riscv32 || continue; compile=$rv start=$rv_run ;;
    esac
    for program in snow draft; do
        # shellcheck disable=SC2086
        link $board $program $program $compile
        # shellcheck disable=SC2086
        run $board $program $start $program.elf && try $board $program
        ran=$((ran + 1))
    done
done
# A stack that is too small is told, not survived by luck: the Cortex-M4's lies where an overflow meets no memory.
if has m4 arm-none-eabi-gcc qemu-system-arm > /dev/null; then
    # shellcheck disable=SC2086
    link m4 draft small $m4 -Wl,--defsym=STACK_BYTES=1024
    # shellcheck disable=SC2086
    if (cd "$dir/m4" && timeout 60 $m4_run small.elf < /dev/null) > "$dir/small.txt" 2>&1 || ! grep -q 'a fault' "$dir/small.txt"; then
        fail "m4: a stack of 1 kB is too small, and nothing was said"
    else
        echo "m4: a stack of 1 kB ends with: $(grep 'a fault' "$dir/small.txt")"
    fi
fi
[ $bad = 0 ] && echo "firmware: $ran programs on bare metal, all equal to the host's"
exit $bad
