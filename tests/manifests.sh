#!/bin/bash
# What other build systems are told is true: the version is that of include/aset/config.h everywhere, every list of sources is
# what lib/ holds, and each public header stands alone in C99 and C++11: manifests.sh BUILD CC CXX
set -eu
dir=$1/manifests
cc=$2
cxx=$3
rm -rf "$dir"
mkdir -p "$dir"
bad=0
fail() { echo "manifests: $1"; bad=1; }

version=$(sed -n 's/^#define ASET_VERSION "\(.*\)"$/\1/p' include/aset/config.h)
numbers=$(sed -n 's/^#define ASET_VERSION_[A-Z]* \([0-9]*\)$/\1/p' include/aset/config.h | paste -sd.)
abi=$(sed -n 's/^#define ASET_ABI \([0-9]*\)$/\1/p' include/aset/config.h)
said() { # FILE, the version that it says
    [ "$2" = "$version" ] || fail "$1 says version '$2', include/aset/config.h '$version'"
}
said "ASET_VERSION_MAJOR, MINOR and PATCH" "$numbers"
said library.json "$(sed -n 's/^  "version": "\(.*\)",$/\1/p' library.json)"
said library.properties "$(sed -n 's/^version=//p' library.properties)"
said idf_component.yml "$(sed -n 's/^version: "\(.*\)"$/\1/p' idf_component.yml)"
said zephyr/module.yml "$(sed -n 's/^# .* version //p' zephyr/module.yml)"
said meson.build "$(sed -n "s/^  version: '\(.*\)',$/\1/p" meson.build)"
said CHANGELOG.md "$(sed -n '/^## /{s/^## \([^ ]*\).*/\1/p;q;}' CHANGELOG.md)"
[ -n "$abi" ] || fail "include/aset/config.h has no ASET_ABI"
grep -q "libaset\.so\.$abi)" include/aset/config.h || fail "include/aset/config.h names another SONAME than ASET_ABI says"

# Sources: meson.build has them one by one; the others take folders whole, so every folder must be named.
diff <(sed -n "s/^  '\(lib\/.*\.c\)',$/\1/p" meson.build | sort) <(ls lib/*/*.c | sort) > "$dir/sources" ||
    { fail "meson.build's sources are not those of lib/:"; cat "$dir/sources"; }
for room in lib/*/; do
    room=$(basename "$room")
    grep -q "lib/$room\b.* INCLUDE_DIRS" CMakeLists.txt || fail "CMakeLists.txt gives ESP-IDF nothing of lib/$room"
    grep -qE "(^foreach\(room|^file\(GLOB).* ?\b$room\b" CMakeLists.txt || fail "CMakeLists.txt knows nothing of lib/$room"
    grep -qE "(^    set\(rooms|APPEND rooms).* $room\b" zephyr/CMakeLists.txt || fail "zephyr/CMakeLists.txt knows nothing of lib/$room"
done
[ -z "$(find lib -mindepth 3 -name '*.c')" ] || fail "a source lies deeper in lib/ than the build files look"

for header in include/aset/*.h; do
    name=aset/$(basename "$header")
    printf '#include <%s>\n#include <%s>\nextern int nothing;\n' "$name" "$name" > "$dir/alone.c"
    $cc -std=c99 -Wall -Wextra -pedantic -Wconversion -Wshadow -Werror -Iinclude -fsyntax-only "$dir/alone.c" ||
        fail "$name does not stand alone in C99"
    if command -v "${cxx%% *}" > /dev/null 2>&1; then
        $cxx -std=c++11 -x c++ -Wall -Wextra -pedantic -Werror -Iinclude -fsyntax-only "$dir/alone.c" ||
            fail "$name does not stand alone in C++11"
    fi
done
if ! command -v "${cxx%% *}" > /dev/null 2>&1; then echo "manifests: C++ skipped, $cxx is not here"; fi
[ $bad = 0 ] && echo "manifests: version $version everywhere, all sources named, headers stand alone in C99 and C++11"
exit $bad
