/*
 * hp9000_snow.c - Snow at 100, 50 and 30 divisions, as in the paper's figures 3 to 5, each in a static arena of exactly the
 * bytes that its Table 3 gives for ASET. hp9000_snow [DIRECTORY]
 */
#include "hp9000.h"

static ASET_ARENA_BLOCK(block, 7488824); /* the largest of the three */

int main(int argc, char **argv) {
    static const panel panels[] = {
        {"MSET", 0, 0},
        {"ASET for the primary rays (figure 3)", ASET_PRIMARY, 0},
        {"ASET from the second level on (figure 4)", ASET_ALL_KINDS, 1},
        {"ASET for the shadow rays (figure 5)", ASET_SHADOW, 0},
    };
    static const sheet sheets[] = {
        {"snow", "snow-100", 0, 100, 5808708, 7488824, 7488824, panels, 4},
        {"snow", "snow-50", 0, 50, 906864, 1146980, 1146980, panels, 4},
        {"snow", "snow-30", 0, 30, 311362, 390404, 390404, panels, 4},
    };
    for (int i = 0; i < 3; i++) {
        draw_sheet(&sheets[i], block, argc > 1 ? argv[1] : ".");
    }
    return 0;
}
