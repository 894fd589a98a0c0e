/* A sequence of pictures on disk: a directory of numbered frames, or files in the order given, with its ground truth if any. */
#ifndef SEQUENCE_H
#define SEQUENCE_H

#include "truth.h"

typedef struct sequence {
    char *name;               /* the directory's base name; white space replaced by '_', so that it is one word */
    char **frames;            /* paths */
    int32_t count;            /* at least 1 */
    char *truth_path;         /* NULL without ground truth */
    ground_truth annotations; /* line i belongs to frame i; may be shorter or longer than the sequence */
} sequence;

/* Opens either one directory or one or more files. Of a directory, its sub-directory `img` is taken where that holds numbered
 * frames, otherwise the directory itself; its groundtruth.txt or groundtruth_rect.txt is read if there is one.
 * False after reporting why. */
bool sequence_open(sequence *s, char **inputs, int count);
void sequence_close(sequence *s);

/* The numbered frames (digits before .pgm, .ppm, .jpg or .jpeg) of a directory in natural order: runs of digits compare as numbers
 * of any length, all else byte by byte, without the extension. Two names that are equal so far, such as 7.pgm and 07.jpg, are the
 * same frame twice: a failure. False after reporting why; no frames at all is no failure. *names is an array of *count strings to
 * release with sequence_free_names. */
bool sequence_list(const char *directory, char ***names, int32_t *count);
void sequence_free_names(char **names, int32_t count);

#endif
