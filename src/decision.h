/* From distances to weights and a winner (paper section 2.4, eq. 6 to 9). */
#ifndef AST_DECISION_H
#define AST_DECISION_H

#include "asttrack.h"

/* distance: count x models, row-major; models <= AST_MAX_BAG. weight (count) receives p(A_i | bag) = sum over j of the configured
 * likelihoods, each normalised over the particles, times the model's vote (cfg->vote); the votes, and so the weights, sum to 1.
 * Returns the argmax, the lowest index on a tie. */
int ast_decide(const float *distance, int count, int models, const ast_config *cfg, float *weight);

#endif
