# Windows, by the cross compiler: the core's folders and the two files; the programs run where Wine is installed.
needs x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++
flags="-O2 -ffp-contract=off -Wall -Wextra -pedantic -Wconversion -Wshadow -Werror"
# shellcheck disable=SC2046,SC2086
x86_64-w64-mingw32-gcc -std=c99 $flags -I"$ROOT/include" -I"$ROOT/lib" -DWITH_SOURCES picture.c $(find "$ROOT/lib" -name '*.c') \
    -o picture-copy.exe
cp "$BUILD/amalgamation/aset.c" "$BUILD/amalgamation/aset.h" .
# shellcheck disable=SC2086
x86_64-w64-mingw32-gcc -std=c99 $flags -DASET_AMALGAMATION_LOAD=1 -DASET_AMALGAMATION_PROCEDURAL=1 -c aset.c
# shellcheck disable=SC2086
x86_64-w64-mingw32-g++ -std=c++11 $flags -DAMALGAMATED -DWITH_SOURCES -x c++ picture.c -x none aset.o -static -o picture-cxx.exe
x86_64-w64-mingw32-nm -g --defined-only aset.o | awk 'NF == 3 && $3 !~ /^aset_/ { print "exported: " $3; bad = 1 } END { exit bad }'
if ! command -v wine > /dev/null 2>&1; then
    echo "compiled and linked, but not run: wine is not here"
    exit 77
fi
export WINEPREFIX=$PWD/wine WINEDEBUG=-all
for program in picture-copy picture-cxx; do
    wine "./$program.exe" > $program.ppm
    cmp $program.ppm "$EXPECTED"
    echo "$program draws the same picture"
done
