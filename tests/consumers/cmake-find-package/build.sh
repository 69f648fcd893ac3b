# Installed by CMake, static and shared; found by find_package, and by pkg-config in what CMake has installed.
needs cmake pkg-config "$CXX"
for shared in OFF ON; do
    cmake -S "$ROOT" -B library-$shared -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=$shared -DCMAKE_INSTALL_PREFIX="$PWD/prefix-$shared"
    cmake --build library-$shared
    cmake --install library-$shared
    cmake -S . -B build-$shared -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$PWD/prefix-$shared"
    cmake --build build-$shared
    check build-$shared/picture
    check build-$shared/picture-sources
    flags=$(PKG_CONFIG_PATH=$PWD/prefix-$shared/lib/pkgconfig pkg-config --cflags --libs libaset)
    # shellcheck disable=SC2086
    $CC -std=c99 -DWITH_SOURCES picture.c $flags -Wl,-rpath,"$PWD/prefix-$shared/lib" -o picture-pc-$shared
    check picture-pc-$shared
    exports prefix-$shared/lib/libaset*
done
DESTDIR=$PWD/stage cmake --install library-ON --prefix /usr
test -e stage/usr/lib/cmake/aset/aset-config.cmake
# Other switches travel with the package.
cmake -S "$ROOT" -B library-double -DCMAKE_BUILD_TYPE=Release -DASET_SWITCHES='ASET_REAL_BITS=64;ASET_WITH_CONES=0' \
    -DCMAKE_INSTALL_PREFIX="$PWD/prefix-double"
cmake --build library-double
cmake --install library-double
cmake -S . -B build-double -DCMAKE_PREFIX_PATH="$PWD/prefix-double"
cmake --build build-double
./build-double/picture > /dev/null
# Under another prefix than it was configured for, pkg-config finds it from where its file lies.
cmake --install library-ON --prefix "$PWD/elsewhere"
flags=$(PKG_CONFIG_PATH=$PWD/elsewhere/lib/pkgconfig pkg-config --cflags --libs libaset)
# shellcheck disable=SC2086
$CC -std=c99 -DWITH_SOURCES picture.c $flags -Wl,-rpath,"$PWD/elsewhere/lib" -o picture-elsewhere
readelf -d picture-elsewhere | grep -q "$PWD/elsewhere/lib"
check picture-elsewhere
