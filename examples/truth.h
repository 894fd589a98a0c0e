/* Ground truth files: one line "x,y,w,h" a frame, in pixels, 0-based top-left corner; "nan,nan,nan,nan" where there is no box, or
 * "0,0,0,0", which some annotators write. */
#ifndef TRUTH_H
#define TRUTH_H

#include "output_file.h"

#include <asttrack.h>

#include <stdbool.h>

typedef struct ground_truth {
    ast_box *boxes; /* nan sides where there is none */
    int32_t count;  /* lines */
} ground_truth;

/* Reads a file whose numbers are parted by a comma, by tabs and spaces, or by both; a comma may end a line. Numbers are decimal and
 * within a float. False after reporting file, line and reason. */
bool truth_read(ground_truth *t, const char *path);
void truth_free(ground_truth *t);
/* The box of a frame (from 0), or NULL where the file has none for it. */
const ast_box *truth_box(const ground_truth *t, int32_t frame);
/* The same, with the gaps between two boxes filled linearly: some annotators give every fifth frame only. False where no box lies
 * at or after the frame, or none at or before it. */
bool truth_interpolate(const ground_truth *t, int32_t frame, ast_box *box);
/* Writes the line of one frame; NULL: no box. */
void truth_write_line(output_file *output, const ast_box *box);

#endif
