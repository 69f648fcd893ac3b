#!/bin/bash
# Three scenes that no generator of ours makes, with uneven sizes and shapes: odd-scenes.sh DIRECTORY writes
#   cluster.nff   777 spheres and cones in five heaps, some of glass, some mirrors, 317 x 211
#   corridor.nff  a corridor of polygons, 1 : 40 : 3, with mirrors along it, 211 x 389
#   field.nff     5000 tiny triangles in two patches of a huge ground, 401 x 301
# The numbers are pseudo-random by a generator written out here, so that every awk gives the same files.
set -eu
dir=$1
mkdir -p "$dir"
random='function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
function between(a, b) { return a + (b - a) * random() }
function heap() { return random() + random() + random() - 1.5 }
BEGIN { seed = 4711 }'

awk "$random"'
BEGIN {
    print "v\nfrom 9 -11 6\nat 0.5 0.3 0.2\nup 0 0 1\nangle 41\nhither 1\nresolution 317 211"
    print "b 0.1 0.2 0.35\nl 20 -15 30\nl -12 -20 14"
    print "f 0.7 0.6 0.5 0.9 0.1 5 0 1\np 4\n-14 -14 -2.1\n14 -14 -2.1\n14 14 -2.1\n-14 14 -2.1"
    for (i = 0; i < 777; i++) {
        if (i % 37 == 0) {
            t = i % 5 == 1 ? 0.7 : 0; ks = i % 3 == 0 ? 0.5 : 0.1
            printf "f %.3f %.3f %.3f %.2f %.2f 20 %.1f 1.3\n", random(), random(), random(), (t > 0 ? 0.2 : 0.7), ks, t
        }
        k = i % 5; w = 0.6 + 0.35 * k
        x = 3.5 * cos(2.1 * k) * (k > 0) + w * heap(); y = 3.5 * sin(2.1 * k) * (k > 0) + w * heap(); z = w * heap()
        r = 0.02 + 0.13 * random() * random()
        if (i % 4 == 3)
            printf "c\n%.4f %.4f %.4f %.4f\n%.4f %.4f %.4f %.4f\n", x, y, z, r, x + heap() / 2, y + heap() / 2, z + 0.5, (i % 8 == 3 ? 0 : r / 2)
        else
            printf "s %.4f %.4f %.4f %.4f\n", x, y, z, r
    }
}' > "$dir/cluster.nff"

awk "$random"'
function wall(x, y0, y1, z0, z1) { printf "p 4\n%g %g %g\n%g %g %g\n%g %g %g\n%g %g %g\n", x, y0, z0, x, y1, z0, x, y1, z1, x, y0, z1 }
function tile(x0, x1, y0, y1, z) { printf "p 4\n%g %g %g\n%g %g %g\n%g %g %g\n%g %g %g\n", x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z }
BEGIN {
    print "v\nfrom 0.45 0.3 1.7\nat 0.52 40 1.2\nup 0 0 1\nangle 63\nhither 0.01\nresolution 211 389"
    print "b 0.6 0.75 0.9\nl 0.5 8 2.8\nl 0.4 31 2.7"
    print "f 0.8 0.8 0.75 0.9 0 1 0 1"
    for (y = 0; y < 40; y++) for (x = 0; x < 4; x++) if ((x + y) % 2) tile(x / 4, (x + 1) / 4, y, y + 1, 0)
    print "f 0.3 0.25 0.2 0.8 0.15 10 0 1"
    for (y = 0; y < 40; y++) for (x = 0; x < 4; x++) if ((x + y) % 2 == 0) tile(x / 4, (x + 1) / 4, y, y + 1, 0)
    print "f 0.85 0.9 0.85 1 0 1 0 1"
    tile(0, 1, 0, 40, 3); printf "p 4\n0 40 0\n1 40 0\n1 40 3\n0 40 3\n"
    for (y = 0; y < 40; y++) { wall(0, y, y + 0.4, 0, 3); wall(1, y, y + 0.4, 0, 3) }
    print "f 0.9 0.95 1 0.15 0.8 60 0 1"
    for (y = 0; y < 40; y++) { wall(0, y + 0.4, y + 1, 0.2, 2.8); wall(1, y + 0.4, y + 1, 0.2, 2.8) }
    print "f 0.8 0.3 0.2 0.8 0.2 12 0 1"
    for (i = 0; i < 300; i++) {
        x = between(0.05, 0.95); y = between(1, 40); z = between(0, 2.6)
        printf "p %d\n", 3 + i % 4
        for (k = 0; k < 3 + i % 4; k++) {
            a = 6.2831853 * k / (3 + i % 4)
            printf "%.5f %.5f %.5f\n", x + 0.05 * cos(a), y, z + 0.05 * sin(a)
        }
    }
}' > "$dir/corridor.nff"

awk "$random"'
BEGIN {
    print "v\nfrom -310 -470 95\nat -250 -300 0\nup 0 0 1\nangle 7.7\nhither 1\nresolution 401 301"
    print "b 0.5 0.6 0.8\nl 300 -700 800"
    print "f 0.45 0.55 0.3 1 0 1 0 1\np 4\n-900 -900 0\n900 -900 0\n900 900 0\n-900 900 0"
    for (i = 0; i < 5000; i++) {
        if (i % 500 == 0) printf "f %.3f %.3f %.3f 0.75 %.2f 15 0 1\n", random(), random(), random(), (i % 1000 == 0 ? 0.3 : 0)
        x = (i % 3 ? -252 : -240) + 11 * heap(); y = (i % 3 ? -302 : -260) + 11 * heap(); z = 2.5 * random()
        printf "p 3\n"
        for (k = 0; k < 3; k++) printf "%.4f %.4f %.4f\n", x + 0.9 * heap(), y + 0.9 * heap(), z + 0.9 * random()
    }
}' > "$dir/field.nff"
