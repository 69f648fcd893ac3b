# The library's files become a repository here, so that nothing is fetched from afar; then the same with the folder itself.
needs cmake git
mkdir repository
(cd "$ROOT" && tar cf - CMakeLists.txt include lib) | tar xf - -C repository
git -C repository init -q
git -C repository add -A
git -C repository -c user.name=consumer -c user.email=consumer@localhost commit -qm "libaset"
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DREPOSITORY="file://$PWD/repository" -DREVISION="$(git -C repository rev-parse HEAD)"
cmake --build build
check build/picture
check build/picture-sources

cmake -S . -B build-source -DCMAKE_BUILD_TYPE=Release -DFETCHCONTENT_SOURCE_DIR_ASET="$ROOT"
cmake --build build-source
check build-source/picture
exports build-source/_deps/aset-build/libaset*.a

if grep -E '^(ASET_|BUILD_SHARED_LIBS)' build/CMakeCache.txt; then
    echo "options of libaset appear in a project that takes it in"
    exit 1
fi
# Nor is anything of it installed with the program.
cmake --install build --prefix "$PWD/prefix"
test ! -e prefix/include/aset
