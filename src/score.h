/* Distances of candidates to the bag. A candidate is the history plus one patch; there are two ways to the same numbers, each a row
 * of function pointers, chosen by the configuration. */
#ifndef AST_SCORE_H
#define AST_SCORE_H

#include "arena.h"
#include "asttrack.h"
#include "bag.h"
#include "history.h"
#include "linalg.h"
#include "metric.h"

/* Candidates are scored in tiles of this many patches, so that memory does not grow with particles x patch length. */
enum { AST_TILE = 32 };

/* What every candidate of a frame shares. Only the bag's lead columns and the work are written. */
struct ast_scene {
    const ast_config *cfg;
    const struct ast_linalg *la;
    const struct ast_history *history; /* at least one patch */
    struct ast_bag *bag;               /* at least one model */
    int background;                    /* vectors of the background, which lie at the end of the bag's lead behind their mean */
    ast_real *work;                    /* ast_subspace_work(la, dim, history + 1) elements, free for the call's duration */
    size_t work_count;
};

/* Scratch of the literal scoring. */
struct ast_literal {
    int dim;
    ast_real *values; /* singular values of a set: P + 1 */
    ast_real *models; /* the bag's bases in ast_real: dim x (k n) */
    ast_real *cross;  /* U_i'U_j: n x n */
    ast_real *small;  /* workspace for its decomposition */
    size_t small_count;
    float *mean;       /* mu_i: dim */
    float *difference; /* mu_i - mu_j: dim */
};

/* Scratch of the Gram scoring. r <= P is the rank of the history; column l of the lead is its basis vector Q_l. */
struct ast_gram {
    int dim;
    int rank;                  /* r */
    ast_real *spectrum;        /* squared singular values of the history about its origin: P */
    ast_real *offset;          /* Q'(reference - origin): P */
    ast_real history_square;   /* sum of the history's squared norms */
    ast_real reference_square; /* |reference|^2 */
    ast_real *gap_square;      /* |mu_j - reference|^2: k */
    ast_real *basis_gap;       /* U_j'(mu_j - reference): k x n */
    ast_real *factor;          /* Cholesky factors of the bases' inner products: k x n x n; unused in the identity */
    ast_real origin_square;    /* |reference - m_b|^2 */
    struct ast_metric metric;
    float *inner;          /* inner products of a tile with the bag's columns: columns x AST_TILE */
    float *shared;         /* the same of the lead with the bag's columns: columns x lead */
    ast_real *square;      /* squared norms of a tile: AST_TILE */
    ast_real *basis_cross; /* [Q e]'U_j of one candidate: (P + 1) x n, and Q'(mu_j - reference) */
    ast_real *matrix;      /* eigen-problem of a candidate: (P + 1) x (P + 1) */
    ast_real *vectors;     /* its eigenvectors */
    ast_real *values;      /* its eigenvalues: P + 1 */
    ast_real *cross;       /* U_i'U_j: n x n */
    ast_real *small;       /* its Gram matrix: n x n */
};

union ast_scratch {
    struct ast_gram gram;
    struct ast_literal literal;
};

struct ast_scoring {
    /* Columns that it wants in front of the bag's. */
    int (*lead)(const ast_config *cfg);
    /* Takes its scratch from the arena. */
    void (*layout)(union ast_scratch *scratch, const ast_config *cfg, const struct ast_linalg *la, int dim,
                   struct ast_arena *arena);
    /* Once a frame, then for each tile. 0, or the backend's failure. */
    int (*prepare)(union ast_scratch *scratch, const struct ast_scene *scene);
    /* patches: count <= AST_TILE columns of the bag's stride, destroyed. distance: count x bag->count, row-major. */
    int (*tile)(union ast_scratch *scratch, const struct ast_scene *scene, float *patches, int count, float *distance);
};

extern const struct ast_scoring ast_scoring_gram;
extern const struct ast_scoring ast_scoring_literal;

const struct ast_scoring *ast_scoring_of(const ast_config *cfg);

#endif
