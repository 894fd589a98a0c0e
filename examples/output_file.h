/* Files that appear whole or not at all: written under a temporary name beside the target, then renamed over it.
 * Functions that return false have reported why. */
#ifndef OUTPUT_FILE_H
#define OUTPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>

#if defined(__GNUC__)
#define OUTPUT_FORMAT __attribute__((format(printf, 2, 3)))
#else
#define OUTPUT_FORMAT
#endif

/* The bytes gather in memory until output_commit writes them, so that the cause of a failure is known exactly and no buffered
 * stream can lose it. */
typedef struct output_file {
    FILE *stream;    /* of what is printed */
    bool lost;       /* a part of it: there was no memory */
    char *bytes;     /* what has been printed */
    size_t size;     /* of it */
    char *path;      /* the name the caller gave */
    char *target;    /* what the temporary file replaces: path with its symbolic links resolved */
    char *temporary; /* NULL: written in place (a device or a pipe, which a rename would replace) */
    int descriptor;  /* of the file on disk */
} output_file;

/* Makes the temporary file at once: what cannot be written shows before the work is done. */
bool output_open(output_file *output, const char *path);
/* Print, without a look at errors: output_commit reports them. A stream in memory notes no failure, so that who prints to it
 * otherwise must. */
void output_print(output_file *output, const char *format, ...) OUTPUT_FORMAT;
void output_bytes(output_file *output, const void *bytes, size_t size);
/* Writes the bytes and puts the file in its place; true only when every one has been written. Ends output either way. */
bool output_commit(output_file *output);
/* Removes the temporary file: an existing target stays as it was. Fine on a zeroed or ended output. */
void output_discard(output_file *output);

#endif
