/* Reads a command line against a table of options: "--name value", "--name=value", flags, and positional arguments; "--" ends the
 * options. Functions that return false, or OPTION_ERROR, have reported which argument is wrong. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <asttrack.h>

#include <stdbool.h>

#define OPTION_MAX 32 /* rows that a table may have */

typedef struct option {
    const char *name;  /* with its dashes; NULL ends the table */
    const char *value; /* what follows, as the help shows it; NULL for a flag */
    bool repeats;      /* may be given more than once */
    int id;            /* what option_next returns, >= 0 */
    const char *help;  /* one line */
} option;

typedef struct option_reader {
    int argc;
    char **argv;
    int next;         /* the argument to read next */
    bool only_values; /* "--" has been read */
    const option *table;
    bool seen[OPTION_MAX];
} option_reader;

enum { OPTION_END = -1, OPTION_POSITIONAL = -2, OPTION_ERROR = -3, OPTION_HELP = -4 };

/* Starts after argv[0]. */
void option_start(option_reader *reader, int argc, char **argv, const option *table);
/* The next option's id with *value its value (NULL for a flag), OPTION_POSITIONAL with *value the argument, or another of the
 * above. --help and -h need no row in the table. */
int option_next(option_reader *reader, const char **value);
/* Reads all arguments and hands each to take with `to`: the option's id or OPTION_POSITIONAL, and the value. take returns false
 * after reporting what is wrong. OPTION_END when all is read; OPTION_HELP or OPTION_ERROR otherwise. */
typedef bool option_take(void *to, int id, const char *value);
int option_read(int argc, char **argv, const option *table, option_take *take, void *to);
/* The table as help text, on stdout. */
void option_print(const option *table);

/* Values. name is the option, for the report; numbers must fill the whole text. */
bool option_integer(const char *name, const char *text, int32_t minimum, int32_t maximum, int32_t *value);
bool option_seed(const char *name, const char *text, uint64_t *value); /* decimal, or hexadecimal after 0x */
bool option_box(const char *name, const char *text, ast_box *box);     /* x,y,w,h */
bool option_size(const char *name, const char *text, int32_t minimum, int32_t maximum, int32_t *width, int32_t *height); /* WxH */

/* The parsers underneath, silent: the decimal number at the start of *text, which moves past it. False where there is none, or none
 * that a long or a finite float can hold. No leading white space is taken. */
bool option_parse_integer(const char **text, long *value);
bool option_parse_real(const char **text, double *value);
/* The same of any size: infinite where a double cannot hold it. */
bool option_parse_decimal(const char **text, double *value);

#endif
