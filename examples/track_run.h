/* Tracks one sequence and writes what was asked for. */
#ifndef TRACK_RUN_H
#define TRACK_RUN_H

#include "sequence.h"

typedef struct track_job {
    const sequence *frames;
    const ast_config *config;
    const ast_box *box;   /* the first box; NULL: from the ground truth */
    bool init_sequence;   /* the first `history` boxes are given, by the ground truth: the paper's initialisation */
    const char *csv;      /* file for the track, or NULL */
    const char *annotate; /* directory for a picture of each frame, or NULL */
    const char *sheet;    /* file for a contact sheet, or NULL */
} track_job;

/* Ends with the result line on stdout. False after reporting what failed.
 * A frame that cannot be read, or that the library refuses, is reported and counted, and tracking goes on with the next. Not so a
 * frame whose box is given: without it there is nothing to track. */
bool track_run(const track_job *job);

#endif
