# A copy of the library in subprojects/, static and shared; then libaset installed by Meson and found by the same line.
needs meson ninja pkg-config
mkdir -p subprojects/aset
(cd "$ROOT" && tar cf - meson.build meson_options.txt include lib) | tar xf - -C subprojects/aset
for kind in static shared; do
    meson setup build-$kind --buildtype=release -Ddefault_library=$kind
    meson compile -C build-$kind
    check build-$kind/picture
    check build-$kind/picture-sources
    meson setup library-$kind subprojects/aset --buildtype=release -Ddefault_library=$kind --prefix="$PWD/prefix-$kind" --libdir=lib
    meson compile -C library-$kind
    meson install -C library-$kind
    exports prefix-$kind/lib/libaset*
    mkdir alone-$kind
    cp meson.build picture.c alone-$kind
    sed -i '/get_variable/d' alone-$kind/meson.build
    (
        cd alone-$kind
        PKG_CONFIG_PATH=$OLDPWD/prefix-$kind/lib/pkgconfig meson setup build --buildtype=release
        meson compile -C build
        check build/picture-sources
    )
done
