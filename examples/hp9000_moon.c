/*
 * hp9000_moon.c - a tetrahedron and a moon (the paper's figure 7) in a static arena of 390,404 bytes. hp9000_moon
 * [DIRECTORY]
 */
#include "hp9000.h"

static ASET_ARENA_BLOCK(block, 390404);

int main(int argc, char **argv) {
    static const panel panels[] = {{"MSET", 0, 0}, {"ASET from the second level on", ASET_ALL_KINDS, 1}};
    static const sheet moon = {"tetra-moon", "tetra-moon-10", 0, 10, 0, 0, 390404, panels, 2};
    draw_sheet(&moon, block, argc > 1 ? argv[1] : ".");
    return 0;
}
