/* hp9000_gears.c - gears of size 2 (the paper's figure 8) in a static arena of 390,404 bytes. hp9000_gears [DIRECTORY] */
#include "hp9000.h"

static ASET_ARENA_BLOCK(block, 390404);

int main(int argc, char **argv) {
    static const panel panels[] = {{"MSET", 0, 0}, {"ASET from the second level on", ASET_ALL_KINDS, 1}};
    static const sheet gears = {"gears", "gears-15", 2, 15, 0, 0, 390404, panels, 2};
    draw_sheet(&gears, block, argc > 1 ? argv[1] : ".");
    return 0;
}
