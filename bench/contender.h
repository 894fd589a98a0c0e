/* A tracker to measure: a configuration and a backend on a film, its bag full, stepping on for as long as it is asked to. */
#ifndef CONTENDER_H
#define CONTENDER_H

#include "film.h"
#include "stages.h"

#include <stdbool.h>

enum { ROUNDS_MOST = 64 };

struct contender {
    char label[64];
    int preset;
    ast_config config; /* the preset's, and what has been changed of it */
    const struct ast_linalg *linalg;
    const struct film *film;
    ast_tracker *tracker;
    int64_t place; /* of the film: the last frame shown */
    bool probed;   /* its stages are wanted */
    struct probe probe;
    int steps, lost; /* steps measured, and those of them that ended with the object lost */

    /* What measuring leaves: seconds of a step, one sample a round. */
    int rounds;
    double sample[ROUNDS_MOST];
    double stage_sample[STAGES][ROUNDS_MOST];
};

/* Sets a zeroed contender to a preset: label and config may then be changed, and probed set, before it is opened. */
void contender_choose(struct contender *c, const struct film *film, int preset, const struct ast_linalg *linalg);
const char *preset_name(int preset);
/* Makes the tracker, starts it on the film's first frame and steps until its bag is full. False after reporting why; then
 * contender_close is due, too. */
bool contender_open(struct contender *c);
void contender_close(struct contender *c);
/* Tracks the next frame. False after reporting why not. */
bool contender_step(struct contender *c);

#endif
