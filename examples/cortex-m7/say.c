#include "say.h"

#include "board.h"

static void say_letter(struct line *line, char letter) {
    if (line->used + 2 < (int)sizeof line->text) line->text[line->used++] = letter; /* room for the end of the line */
}

void say_text(struct line *line, const char *text) {
    while (*text != '\0') say_letter(line, *text++);
}

void say_number(struct line *line, int32_t number) {
    char digits[10];
    int count = 0;
    uint32_t rest = number < 0 ? 0u - (uint32_t)number : (uint32_t)number;
    if (number < 0) say_letter(line, '-');
    do {
        digits[count++] = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    while (count > 0) say_letter(line, digits[--count]);
}

void say_hundredths(struct line *line, float number) {
    const float scaled = number * 100.0f;
    const int32_t whole = scaled < 0.0f ? (int32_t)(scaled - 0.5f) : (int32_t)(scaled + 0.5f);
    if (whole < 0) say_letter(line, '-');
    const int32_t size = whole < 0 ? -whole : whole;
    say_number(line, size / 100);
    say_letter(line, '.');
    say_letter(line, (char)('0' + size / 10 % 10));
    say_letter(line, (char)('0' + size % 10));
}

void say_hex(struct line *line, uint32_t bits) {
    for (int shift = 28; shift >= 0; shift -= 4) say_letter(line, "0123456789abcdef"[bits >> shift & 15u]);
}

void say_end(struct line *line) {
    line->text[line->used++] = '\n';
    line->text[line->used] = '\0';
    board_write(line->text);
    line->used = 0;
}
