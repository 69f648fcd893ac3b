/*
 * font.h - a small font of our own, for the words on pictures: printable ASCII, all characters equally wide.
 */
#ifndef ASET_TOOLS_FONT_H
#define ASET_TOOLS_FONT_H

#include <stdbool.h>

/*
 * A character's cell in dots. The blank between characters (the last column) and between lines (the last row) belongs to
 * it; the base line lies under row 6.
 */
#define FONT_WIDTH 6u
#define FONT_HEIGHT 10u

/* True if the font can draw it: ASCII 32 to 126. */
bool font_has(char character);
/* Is the dot at column x from the left, row y from the top, black? False for what the font does not have. */
bool font_dot(char character, unsigned x, unsigned y);

#endif
