#!/bin/bash
# The shared library's interface against that of the last tag, or of another revision: abi.sh BUILD [REVISION]
# Functions may be added. Anything else that changes what a compiled program knows of the library (a function that is gone, a
# struct of another size) needs another ASET_ABI in include/aset/config.h.
set -eu
build=$1
revision=${2:-$(git describe --tags --abbrev=0 2> /dev/null || true)}
dir=$build/abi
for tool in abidw abidiff; do
    command -v $tool > /dev/null 2>&1 || { echo "abi: skipped, $tool is not here (make deps-consumers)"; exit 0; }
done
if [ -z "$revision" ]; then
    echo "abi: skipped, there is no tag to compare with (make check-abi ARGS=REVISION names another)"
    exit 0
fi
rm -rf "$dir"
mkdir -p "$dir/then"
git archive "$revision" | tar xf - -C "$dir/then"
library=libaset.so.$(sed -n 's/^#define ASET_VERSION "\(.*\)"/\1/p' "$dir/then/include/aset/config.h")
make -C "$dir/then" BUILD=build CFLAGS="-O1 -g" "build/$library" > "$dir/log" 2>&1 || { tail -n 5 "$dir/log"; exit 1; }

describe() { # HEADERS LIBRARY OUT
    abidw --headers-dir "$1" --drop-private-types --no-corpus-path --no-comp-dir-path --no-show-locs --out-file "$3" "$2"
}
abi_of() { sed -n 's/^#define ASET_ABI \([0-9]*\)$/\1/p' "$1/include/aset/config.h"; }
describe "$dir/then/include" "$dir/then/build/$library" "$dir/then.abi"
describe include "$(ls "$build"/libaset.so.*.*.*)" "$dir/now.abi"

# The SONAME is compared by number, below.
sed -i "1s/ soname='[^']*'//" "$dir/then.abi" "$dir/now.abi"
status=0
abidiff --no-added-syms "$dir/then.abi" "$dir/now.abi" > "$dir/difference" || status=$?
then=$(abi_of "$dir/then")
now=$(abi_of .)
if [ $status = 0 ]; then
    echo "abi: programs compiled with $revision work with this library"
elif [ "$then" != "$now" ]; then
    echo "abi: changed since $revision, and so is its number: ${then:-none}, now $now"
else
    cat "$dir/difference"
    echo "abi: changed since $revision, but ASET_ABI is $now as before"
    exit 1
fi
