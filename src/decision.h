/* From distances to weights and a winner (paper section 2.4, eq. 6 to 9). */
#ifndef AST_DECISION_H
#define AST_DECISION_H

#include "asttrack.h"
#include "particles.h"
#include "real.h"

/* What a model says of a particle at distance v: share exp(-(v - least) rate). */
struct ast_voice {
    float least;       /* of its distances to the particles */
    ast_real contrast; /* by how much their mean exceeds it */
    ast_real rate;
    ast_real share;
};

/* Where the winner is expected before it is seen: the prior p(A_t | A_t-1) about the last estimate, a Gaussian in x and y. */
struct ast_expectation {
    float x, y;  /* pixels */
    float reach; /* standard deviation, pixels; 0: anywhere alike, as in the paper */
};

/* distance: count x models, row-major. weight (count) receives p(A_i | bag) = sum over j of the configured likelihoods, each
 * normalised over the particles, times the model's vote (cfg->vote); the votes, and so the weights, sum to 1. voice (models): what
 * was added up. */
void ast_weigh(const float *distance, int count, int models, const ast_config *cfg, float *weight, struct ast_voice *voice);
/* The index of the greatest weight times prior among the first `count` particles, the lowest on a tie. */
int ast_winner(const struct ast_cloud *cloud, int count, const struct ast_expectation *expected);
/* say (models): the share of each in the weight of the particle with these distances (models); sum 1, or all 0. */
void ast_attribute(const float *distance, const struct ast_voice *voice, int models, float *say);

#endif
