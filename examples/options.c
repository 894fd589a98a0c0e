#include "options.h"

#include "report.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void option_start(option_reader *reader, int argc, char **argv, const option *table) {
    memset(reader, 0, sizeof *reader);
    reader->argc = argc;
    reader->argv = argv;
    reader->next = 1;
    reader->table = table;
}

/* The row whose name is the first length characters of argument, or -1. */
static int find(const option *table, const char *argument, size_t length) {
    for (int row = 0; row < OPTION_MAX && table[row].name != NULL; ++row) {
        if (strlen(table[row].name) == length && memcmp(table[row].name, argument, length) == 0) return row;
    }
    return -1;
}

int option_next(option_reader *reader, const char **value) {
    *value = NULL;
    if (reader->next >= reader->argc) return OPTION_END;
    const char *argument = reader->argv[reader->next++];
    if (!reader->only_values && strcmp(argument, "--") == 0) {
        reader->only_values = true;
        if (reader->next >= reader->argc) return OPTION_END;
        argument = reader->argv[reader->next++];
    }
    if (reader->only_values || argument[0] != '-' || argument[1] == '\0') {
        *value = argument;
        return OPTION_POSITIONAL;
    }
    if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) return OPTION_HELP;
    const size_t length = strcspn(argument, "=");
    const int row = find(reader->table, argument, length);
    if (row < 0) {
        report_error("%s: unknown option (--help lists them)", argument);
        return OPTION_ERROR;
    }
    const option *o = &reader->table[row];
    if (reader->seen[row] && !o->repeats) {
        report_error("%s: given more than once", o->name);
        return OPTION_ERROR;
    }
    reader->seen[row] = true;
    if (o->value == NULL) {
        if (argument[length] == '=') {
            report_error("%s: takes no value", o->name);
            return OPTION_ERROR;
        }
        return o->id;
    }
    if (argument[length] == '=') {
        *value = argument + length + 1;
    } else if (reader->next < reader->argc && strncmp(reader->argv[reader->next], "--", 2) != 0) {
        *value = reader->argv[reader->next++];
    }
    if (*value == NULL || **value == '\0') {
        report_error("%s: needs %s after it", o->name, o->value);
        return OPTION_ERROR;
    }
    return o->id;
}

int option_read(int argc, char **argv, const option *table, option_take *take, void *to) {
    option_reader reader;
    option_start(&reader, argc, argv, table);
    for (;;) {
        const char *value;
        const int id = option_next(&reader, &value);
        if (id == OPTION_END || id == OPTION_HELP || id == OPTION_ERROR) return id;
        if (!take(to, id, value)) return OPTION_ERROR;
    }
}

void option_print(const option *table) {
    for (const option *o = table; o->name != NULL; ++o) {
        char left[64];
        snprintf(left, sizeof left, "%s%s%s", o->name, o->value != NULL ? " " : "", o->value != NULL ? o->value : "");
        printf("  %-26s %s\n", left, o->help);
    }
    printf("  %-26s %s\n", "--help", "this text");
}

/* strtod reads hexadecimal numbers and words, too, and neither the Python package nor whoever writes numbers for people does. */
static bool is_decimal(const char *text) {
    text += *text == '+' || *text == '-';
    return (isdigit((unsigned char)text[0]) || text[0] == '.') && !(text[0] == '0' && (text[1] == 'x' || text[1] == 'X'));
}

bool option_parse_integer(const char **text, long *value) {
    char *end;
    if (isspace((unsigned char)**text)) return false;
    errno = 0;
    const long number = strtol(*text, &end, 10);
    if (end == *text || errno != 0) return false;
    *text = end;
    *value = number;
    return true;
}

bool option_parse_decimal(const char **text, double *value) {
    char *end;
    if (!is_decimal(*text)) return false;
    const double number = strtod(*text, &end);
    if (end == *text) return false;
    *text = end;
    *value = number;
    return true;
}

bool option_parse_real(const char **text, double *value) {
    const char *at = *text;
    double number;
    if (!option_parse_decimal(&at, &number) || fabs(number) > (double)FLT_MAX) return false;
    *text = at;
    *value = number;
    return true;
}

bool option_integer(const char *name, const char *text, int32_t minimum, int32_t maximum, int32_t *value) {
    const char *at = text;
    long number;
    if (!option_parse_integer(&at, &number) || *at != '\0' || number < minimum || number > maximum) {
        report_error("%s %s: not an integer from %d to %d", name, text, (int)minimum, (int)maximum);
        return false;
    }
    *value = (int32_t)number;
    return true;
}

bool option_seed(const char *name, const char *text, uint64_t *value) {
    const bool hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    char *end = NULL;
    errno = 0;
    /* strtoull would take a sign and turn -1 into a large number */
    const unsigned long long number = isdigit((unsigned char)text[0]) ? strtoull(text, &end, hexadecimal ? 16 : 10) : 0;
    if (end == NULL || *end != '\0' || errno != 0 || number > UINT64_MAX) {
        report_error("%s %s: not a number from 0 to 2^64 - 1", name, text);
        return false;
    }
    *value = number;
    return true;
}

bool option_box(const char *name, const char *text, ast_box *box) {
    double number[4];
    const char *at = text;
    bool good = true;
    for (int i = 0; i < 4 && good; ++i) {
        good = option_parse_real(&at, &number[i]) && *at == (i < 3 ? ',' : '\0');
        ++at;
    }
    /* as a float: a side may vanish in it */
    if (!good || !((float)number[2] > 0.0f) || !((float)number[3] > 0.0f)) {
        report_error("%s %s: not a box x,y,w,h in pixels", name, text);
        return false;
    }
    box->x = (float)number[0];
    box->y = (float)number[1];
    box->w = (float)number[2];
    box->h = (float)number[3];
    return true;
}

bool option_size(const char *name, const char *text, int32_t minimum, int32_t maximum, int32_t *width, int32_t *height) {
    const char *at = text;
    long w = 0, h = 0;
    bool good = option_parse_integer(&at, &w) && *at == 'x';
    if (good) {
        ++at;
        good = option_parse_integer(&at, &h) && *at == '\0';
    }
    if (!good || w < minimum || w > maximum || h < minimum || h > maximum) {
        report_error("%s %s: not a size WxH with sides from %d to %d", name, text, (int)minimum, (int)maximum);
        return false;
    }
    *width = (int32_t)w;
    *height = (int32_t)h;
    return true;
}
