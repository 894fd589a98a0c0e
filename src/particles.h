/* The particle cloud: Condensation's resampling and random walk (paper section 2.1). */
#ifndef AST_PARTICLES_H
#define AST_PARTICLES_H

#include "asttrack.h"
#include "random.h"

/* Where the object may be: the centre of its box, and its scale relative to the first box. */
struct ast_state {
    float x, y; /* pixels */
    float scale;
};

/* Structure of arrays, count particles. */
struct ast_cloud {
    float *x, *y, *scale;
    float *weight; /* sum 1 */
    int count;
};

/* Puts particle i on a state. */
void ast_cloud_set(struct ast_cloud *cloud, int i, struct ast_state state);
/* All particles on one state with equal weights. */
void ast_cloud_gather(struct ast_cloud *cloud, const struct ast_state *state);
/* Systematic resampling: to[i] is a copy of a particle of from, chosen with probability its weight, by one uniform draw. Leaves
 * to's weights alone. */
void ast_cloud_resample(const struct ast_cloud *from, struct ast_cloud *to, struct ast_random *random);
/* The nearest state whose centre lies in the frame and whose scale is within its limits. */
struct ast_state ast_state_within(struct ast_state state, const ast_config *cfg, const ast_frame *frame);
/* Moves all particles by the same step, pixels. */
void ast_cloud_shift(struct ast_cloud *cloud, float x, float y);
/* Gaussian random walk: additive in x and y, multiplicative in scale; the centre is clamped to the frame, the scale to its
 * limits. */
void ast_cloud_diffuse(struct ast_cloud *cloud, const ast_config *cfg, const ast_frame *frame, struct ast_random *random);
/* Root of the weighted variance of the centres, pixels. */
float ast_cloud_spread(const struct ast_cloud *cloud);
/* Effective sample size 1 / sum w^2. */
float ast_cloud_effective(const struct ast_cloud *cloud);

#endif
