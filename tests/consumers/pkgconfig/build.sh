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
! nm picture-sources | grep -q ' T aset_load_nff' # the shared library's reader, and no copy of it

make -C "$ROOT" BUILD="$BUILD" PREFIX="$PWD/prefix" uninstall
test -z "$(find prefix -path prefix/share/mime -prune -o \( -type f -o -type l \) -print)" # there lies the desktop's own index
# Other switches: all is compiled anew, and what they say goes on to the program.
make -C "$ROOT" BUILD="$PWD/double" CPPFLAGS= PREFIX="$PWD/prefix" install-lib
make -C "$ROOT" BUILD="$PWD/double" CPPFLAGS='-DASET_REAL_BITS=64 -DASET_WITH_DRAFTS=0' PREFIX="$PWD/prefix" install-lib
flags=$(PKG_CONFIG_PATH=$PWD/prefix/lib/pkgconfig pkg-config --cflags --libs libaset)
# shellcheck disable=SC2086
$CC -std=c99 -DWITH_SOURCES picture.c $flags -Wl,-rpath,"$PWD/prefix/lib" -o picture-double
./picture-double > /dev/null
