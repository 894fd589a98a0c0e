#include "truth.h"

#include "options.h"
#include "report.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Far longer than four numbers are. The Python reader has the same limit, and gives the same reasons. */
#define MOST_BYTES 511

static const char *skip_blanks(const char *at) {
    return at + strspn(at, " \t");
}

/* What parts two numbers: a comma, blanks, or both. Two commas have a field between them that was left empty. */
static const char *skip_separator(const char *at) {
    at = skip_blanks(at);
    return *at == ',' ? skip_blanks(at + 1) : at;
}

static bool is_nan(const char **at) {
    static const char name[] = "nan";
    for (size_t i = 0; i < 3; ++i) {
        const char c = (*at)[i];
        if (c != name[i] && c != name[i] - 'a' + 'A') return false;
    }
    *at += 3;
    return true;
}

/* NULL, or why the line is not a box. */
static const char *parse_line(const char *line, ast_box *box) {
    static const char no_box[] = "not four numbers x,y,w,h";
    double number[4];
    int nans = 0;
    bool beyond = false;
    const char *at = skip_blanks(line);
    for (int i = 0; i < 4; ++i) {
        if (is_nan(&at)) {
            ++nans;
        } else if (option_parse_decimal(&at, &number[i])) {
            beyond = beyond || fabs(number[i]) > (double)FLT_MAX;
        } else {
            return no_box;
        }
        const char *next = skip_separator(at);
        if (i < 3 && next == at) return no_box;
        at = next;
    }
    if (*at != '\0') return no_box;
    if (beyond) return "a number larger than a float holds";
    if (nans != 0 && nans != 4) return "nan in part of a box";
    if (nans == 4 || (number[0] == 0.0 && number[1] == 0.0 && number[2] == 0.0 && number[3] == 0.0)) {
        const ast_box none = {NAN, NAN, NAN, NAN};
        *box = none;
        return NULL;
    }
    const ast_box read = {(float)number[0], (float)number[1], (float)number[2], (float)number[3]};
    if (!(read.w > 0.0f) || !(read.h > 0.0f)) {
        return "a box without area (nan,nan,nan,nan stands for no box)";
    }
    *box = read;
    return NULL;
}

static bool append(ground_truth *t, int32_t *capacity, const ast_box *box) {
    if (t->count == *capacity) {
        const int32_t larger = *capacity == 0 ? 1024 : 2 * *capacity;
        ast_box *boxes = larger > 0 ? realloc(t->boxes, (size_t)larger * sizeof *boxes) : NULL;
        if (boxes == NULL) return false;
        t->boxes = boxes;
        *capacity = larger;
    }
    t->boxes[t->count++] = *box;
    return true;
}

/* Reads one line without its end ("\n" or "\r\n"). 1 for a line, 0 at the end of the file, -1 when it is too long. */
static int read_line(FILE *stream, char *line) {
    size_t length = 0;
    int c;
    while ((c = getc(stream)) != EOF && c != '\n') {
        if (length == MOST_BYTES) return -1;
        if (c == '\0') {
            c = '?'; /* no part of a number either, and no end of the text */
        }
        line[length++] = (char)c;
    }
    if (length > 0 && line[length - 1] == '\r') {
        --length;
    }
    line[length] = '\0';
    return c == EOF && length == 0 ? 0 : 1;
}

/* What some editors put before a text. */
static const char byte_order_mark[] = "\xef\xbb\xbf";

static bool read_stream(ground_truth *t, const char *path, FILE *stream) {
    char line[MOST_BYTES + 1];
    int32_t capacity = 0, blank = 0; /* blank: line number of an empty line, fine where only empty lines follow */
    for (int32_t number = 1;; ++number) {
        const int got = read_line(stream, line);
        if (got == 0) break;
        if (got > 0 && number == 1 && strncmp(line, byte_order_mark, strlen(byte_order_mark)) == 0) {
            memmove(line, line + strlen(byte_order_mark), strlen(line) + 1 - strlen(byte_order_mark));
        }
        if (got > 0 && skip_blanks(line)[0] == '\0') {
            blank = blank == 0 ? number : blank;
            continue;
        }
        if (blank != 0) {
            report_error("%s:%d: an empty line before the end", path, (int)blank);
            return false;
        }
        ast_box box;
        const char *reason = got < 0 ? "too long for four numbers x,y,w,h" : parse_line(line, &box);
        if (reason != NULL) {
            report_error("%s:%d: %s", path, (int)number, reason);
            return false;
        }
        if (!append(t, &capacity, &box)) {
            report_error("%s: out of memory", path);
            return false;
        }
    }
    if (ferror(stream)) {
        report_error("%s: cannot read: %s", path, strerror(errno));
        return false;
    }
    if (t->count == 0) {
        report_error("%s: the file is empty", path);
        return false;
    }
    return true;
}

bool truth_read(ground_truth *t, const char *path) {
    memset(t, 0, sizeof *t);
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        report_error("%s: cannot open: %s", path, strerror(errno));
        return false;
    }
    const bool good = read_stream(t, path, stream);
    (void)fclose(stream);
    if (!good) {
        truth_free(t);
    }
    return good;
}

void truth_free(ground_truth *t) {
    free(t->boxes);
    memset(t, 0, sizeof *t);
}

const ast_box *truth_box(const ground_truth *t, int32_t frame) {
    return frame >= 0 && frame < t->count && !isnan(t->boxes[frame].w) ? &t->boxes[frame] : NULL;
}

/* In double precision, where the difference of no two floats is infinite. */
static float between(float a, float b, double part) {
    return (float)((double)a + part * ((double)b - (double)a));
}

bool truth_interpolate(const ground_truth *t, int32_t frame, ast_box *box) {
    int32_t before = frame, after = frame;
    while (before >= 0 && truth_box(t, before) == NULL) {
        --before;
    }
    while (after < t->count && truth_box(t, after) == NULL) {
        ++after;
    }
    const ast_box *a = truth_box(t, before), *b = truth_box(t, after);
    if (a == NULL || b == NULL) return false;
    const double part = after == before ? 0.0 : (double)(frame - before) / (double)(after - before);
    box->x = between(a->x, b->x, part);
    box->y = between(a->y, b->y, part);
    box->w = between(a->w, b->w, part);
    box->h = between(a->h, b->h, part);
    return true;
}

void truth_write_line(output_file *output, const ast_box *box) {
    if (box == NULL) {
        output_print(output, "nan,nan,nan,nan\n");
    } else {
        output_print(output, "%.2f,%.2f,%.2f,%.2f\n", (double)box->x, (double)box->y, (double)box->w, (double)box->h);
    }
}
