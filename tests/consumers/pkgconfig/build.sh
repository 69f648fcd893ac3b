# Installed by make under a prefix, and staged by DESTDIR as packages are made; found by pkg-config.
needs pkg-config "$CXX"
make -C "$ROOT" BUILD="$BUILD" PREFIX="$PWD/prefix" install
PKG_CONFIG_PATH=$PWD/prefix/lib/pkgconfig make
for program in picture picture-sources picture-cxx; do
    LD_LIBRARY_PATH=$PWD/prefix/lib check $program
done
check picture-static

make -C "$ROOT" BUILD="$BUILD" PREFIX=/usr DESTDIR="$PWD/stage" install
rm picture
PKG_CONFIG_LIBDIR=$PWD/stage/usr/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$PWD/stage make picture
LD_LIBRARY_PATH=$PWD/stage/usr/lib check picture
