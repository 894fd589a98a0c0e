/* How sure the tracker is: a score of the winner, and a status with hysteresis made from it. */
#ifndef AST_CONFIDENCE_H
#define AST_CONFIDENCE_H

#include "asttrack.h"
#include "bag.h"

struct ast_confidence {
    int32_t status; /* AST_TRACKING, AST_UNCERTAIN, AST_LOST */
    int32_t low;    /* consecutive frames below score_lost */
};

/* Likeness of the winning patch to the object as known: the mean of its normalised correlation with the first model (anchor, dim
 * floats) and with the model of the bag that is most like it, clipped to [0, 1]. The first model cannot drift, and the bag knows
 * the appearances since. */
float ast_confidence_score(const float *patch, const float *anchor, const struct ast_bag *bag);
/* What tells whether the winner is the object. */
struct ast_evidence {
    float start;  /* cosine to the object's looks at the start, about the background's mean */
    float spread; /* of the cloud, object sizes */
    float inside; /* share of the winner's box inside the frame: a lost cloud mostly comes to rest at a border */
};
/* With a guard: the probability that the winner's box covers the object (overlap 0.2 at least), by a logistic regression over
 * sequences with ground truth, each with the same weight (`make calibrate`). 0 .. 1. */
float ast_confidence_probability(const struct ast_evidence *evidence);
/* Status after a frame with this score. LOST needs lost_after low frames in a row and lasts until a score of score_uncertain. */
struct ast_confidence ast_confidence_next(struct ast_confidence last, const ast_config *cfg, float score);

#endif
