# The folders as they are, and a compiler; then the two archives' folders besides.
mkdir -p aset/lib
cp -r "$ROOT/include" aset
(cd "$ROOT/lib" && cp -r base scene space approx trace "$OLDPWD/aset/lib")
make picture
check picture
(cd "$ROOT/lib" && cp -r load procedural "$OLDPWD/aset/lib")
make picture-sources
check picture-sources
$CC -std=c99 -O2 -ffp-contract=off -Iaset/include -Iaset/lib -c aset/lib/*/*.c
exports ./*.o
