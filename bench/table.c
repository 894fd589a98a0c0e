#include "table.h"

#include <stdarg.h>
#include <stdio.h>

enum { TITLE = 26, CELL = 28 };

void table_begin(const char *title) {
    printf("%-*s", TITLE, title);
}

void table_cell(const char *format, ...) {
    char text[128];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    printf("  %*s", CELL, text);
}

void table_spread(struct spread s, double unit, int digits) {
    if (s.count == 0)
        table_cell("-");
    else
        table_cell("%.*f (%.*f .. %.*f)", digits, s.median * unit, digits, s.least * unit, digits, s.greatest * unit);
}

void table_end(void) {
    printf("\n");
}
