/* Lines of text without printf, which takes a heap for floating-point numbers. */
#ifndef SAY_H
#define SAY_H

#include <stdint.h>

struct line {
    char text[160];
    int used;
};

void say_text(struct line *line, const char *text);
void say_number(struct line *line, int32_t number);
/* Rounded to hundredths; less than 10 million in size. */
void say_hundredths(struct line *line, float number);
void say_hex(struct line *line, uint32_t bits);
/* Sends the line, and empties it. */
void say_end(struct line *line);

#endif
