/* Which particles are scored in full: most are so far from the object that an inner product with the grey patch alone says so. */
#ifndef AST_SHORTLIST_H
#define AST_SHORTLIST_H

#include "asttrack.h"
#include "particles.h"

/* Particles that are scored in full when there is a bag: all, unless there are more than the shortlist's. */
static inline int ast_shortlist_length(const ast_config *cfg) {
    return cfg->shortlist > 0 && cfg->shortlist < cfg->particles ? cfg->shortlist : cfg->particles;
}

/* Brings the `wanted` particles (1 .. count) of the greatest promise to the front of the cloud, in no particular order; of equal
 * ones those with the lower index. promise (cloud->count) is carried along; heap: room for `wanted`. Takes count log(wanted) steps
 * at most. */
void ast_shortlist(struct ast_cloud *cloud, float *promise, int wanted, float *heap);

#endif
