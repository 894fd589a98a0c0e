/* The tracker's own random numbers: the same sequence on every machine. */
#ifndef AST_RANDOM_H
#define AST_RANDOM_H

#include <stdint.h>

struct ast_random {
    uint64_t state; /* PCG32 (O'Neill 2014), one stream */
};

void ast_random_seed(struct ast_random *r, uint64_t seed);
uint32_t ast_random_bits(struct ast_random *r);
/* Uniform in the open interval (0, 1): (k + 1/2) / 2^23, exact in single precision. */
float ast_random_uniform(struct ast_random *r);
/* Standard normal. One uniform a draw, through ast_normal_quantile. */
float ast_random_normal(struct ast_random *r);
/* The value below which a standard normal falls with probability p, 0 < p < 1. */
float ast_normal_quantile(float p);

#endif
