#include "json.h"

#include <math.h>

static void write_text(FILE *stream, const char *text) {
    (void)fputc('"', stream);
    for (; *text != '\0'; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            (void)fprintf(stream, "\\%c", c);
        else if (c < ' ')
            (void)fprintf(stream, "\\u%04x", c);
        else
            (void)fputc(c, stream);
    }
    (void)fputc('"', stream);
}

/* The comma, the line and the key in front of a value. */
static void member(struct json *j, const char *key) {
    if (j->filled[j->depth]) (void)fputc(',', j->stream);
    j->filled[j->depth] = true;
    (void)fprintf(j->stream, "\n%*s", j->depth + 1, "");
    if (key == NULL) return;
    write_text(j->stream, key);
    (void)fputs(": ", j->stream);
}

static void open_level(struct json *j, char opening, char closing) {
    (void)fputc(opening, j->stream);
    j->closing[j->depth] = closing;
    j->filled[j->depth] = false;
}

static void nest(struct json *j, const char *key, char opening, char closing) {
    member(j, key);
    j->depth++;
    open_level(j, opening, closing);
}

void json_start(struct json *j, FILE *stream) {
    j->stream = stream;
    j->depth = 0;
    open_level(j, '{', '}');
}

void json_object(struct json *j, const char *key) {
    nest(j, key, '{', '}');
}

void json_array(struct json *j, const char *key) {
    nest(j, key, '[', ']');
}

void json_end(struct json *j) {
    if (j->filled[j->depth]) (void)fprintf(j->stream, "\n%*s", j->depth, "");
    (void)fputc(j->closing[j->depth], j->stream);
    if (j->depth == 0)
        (void)fputc('\n', j->stream);
    else
        j->depth--;
}

void json_text(struct json *j, const char *key, const char *text) {
    member(j, key);
    if (text == NULL)
        (void)fputs("null", j->stream);
    else
        write_text(j->stream, text);
}

void json_number(struct json *j, const char *key, double value) {
    member(j, key);
    if (isfinite(value))
        (void)fprintf(j->stream, "%.9g", value);
    else
        (void)fputs("null", j->stream);
}

void json_bool(struct json *j, const char *key, bool value) {
    member(j, key);
    (void)fputs(value ? "true" : "false", j->stream);
}

void json_spread(struct json *j, const char *key, const struct spread *s, double unit) {
    json_object(j, key);
    json_number(j, "least", s->least * unit);
    json_number(j, "median", s->median * unit);
    json_number(j, "greatest", s->greatest * unit);
    json_number(j, "count", s->count);
    json_end(j);
}
