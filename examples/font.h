/* A small bitmap font for labels: capitals, digits and a few signs. */
#ifndef FONT_H
#define FONT_H

#define FONT_WIDTH 5
#define FONT_HEIGHT 7

/* FONT_HEIGHT strings of FONT_WIDTH characters, blank where the glyph has no dot. Small letters give capitals; a character that the
 * font lacks gives an empty box. */
const char *const *font_glyph(char character);

#endif
