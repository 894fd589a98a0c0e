/* Writes JSON to a stream, indented, commas where they belong. A key is NULL inside an array. */
#ifndef JSON_H
#define JSON_H

#include <stdbool.h>
#include <stdio.h>

#include "statistics.h"

enum { JSON_DEPTH = 16 }; /* most levels of nesting */

struct json {
    FILE *stream;
    int depth;
    char closing[JSON_DEPTH]; /* bracket that ends each level */
    bool filled[JSON_DEPTH];  /* whether the level has a member already */
};

/* Begins with the outermost object; json_end as often as something was begun ends it all. */
void json_start(struct json *j, FILE *stream);
void json_object(struct json *j, const char *key);
void json_array(struct json *j, const char *key);
void json_end(struct json *j);

void json_text(struct json *j, const char *key, const char *text); /* NULL: null */
void json_number(struct json *j, const char *key, double value);   /* null where JSON has no such number */
void json_bool(struct json *j, const char *key, bool value);
/* {"least", "median", "greatest", "count"}, each of the three times unit. */
void json_spread(struct json *j, const char *key, const struct spread *s, double unit);

#endif
