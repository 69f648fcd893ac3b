# The files for ESP-IDF, Zephyr, PlatformIO and Arduino. Of the first two only what they ask of CMake is here; PlatformIO's rule (all
# of srcDir, includeDir and srcDir for includes) and Arduino's (all of src/, no flags) are followed by hand.
needs cmake "$CXX"
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DROOT="$ROOT"
cmake --build build
check build/picture-idf
printf 'macro(idf_component_register)\nreturn()\nendmacro()\nset(ESP_PLATFORM ON)\ninclude("%s/CMakeLists.txt")\n' "$ROOT" > script.cmake
cmake -P script.cmake
check build/picture-zephyr
exports build/*/lib*.a

field() { sed -n "s/.*\"$1\": \"\(.*\)\".*/\1/p" "$ROOT/library.json"; }
# shellcheck disable=SC2046
$CC -std=c99 -O2 $(field flags) -I"$ROOT/$(field includeDir)" -I"$ROOT/$(field srcDir)" -DWITH_SOURCES picture.c \
    $(find "$ROOT/$(field srcDir)" -name '*.c') -lm -o picture-platformio
check picture-platformio

make -C "$ROOT" BUILD="$BUILD" arduino
cp -r "$BUILD/arduino/libaset" .
test -s libaset/library.properties
test -e "libaset/src/$(sed -n 's/^includes=//p' libaset/library.properties)"
cp picture.c sketch.cpp
$CC -std=gnu11 -Os -c libaset/src/aset.c -o arduino.o
$CXX -std=gnu++11 -Os -DAMALGAMATED -Ilibaset/src sketch.cpp arduino.o -lm -o picture-arduino
check picture-arduino
