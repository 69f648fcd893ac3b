# The two files of make amalgamation: no warning in any set of switches, and no names but the shared library's.
needs "$CXX"
cp "$BUILD/amalgamation/aset.c" "$BUILD/amalgamation/aset.h" .
make
for program in picture picture-sources picture-cxx picture-prefix; do
    check $program
done

nm -D --defined-only "$BUILD"/libaset.so.* | awk '{ print $3 }' | sort -u > public.txt
nm -g --defined-only aset-all.o | awk '{ print $3 }' | sort | diff - public.txt
nm -g --defined-only aset-my.o | awk '{ print $3 }' | sort > my.txt
sed 's/^aset_/my_/' public.txt | sort | diff my.txt -

for cc in gcc clang; do
    command -v $cc > /dev/null 2>&1 || continue
    for switches in "" -DASET_REAL_BITS=64 -DASET_WITH_DRAFTS=0 -DASET_WITH_APPROXIMATION=0 \
        "-DASET_WITH_SPHERES=0 -DASET_WITH_CONES=0 -DASET_WITH_REFLECTION=0 -DASET_WITH_REFRACTION=0" \
        "-DASET_WITH_POLYGONS=0 -DASET_WITH_PATCHES=0"; do
        # shellcheck disable=SC2086
        $cc -std=c99 -Wall -Wextra -pedantic -Wconversion -Wshadow -Werror -DASET_AMALGAMATION_LOAD=1 \
            -DASET_AMALGAMATION_PROCEDURAL=1 $switches -O1 -c aset.c -o switches.o
    done
done
