/* Distances of candidates to the bag. A candidate is the history plus one patch; there are two ways to the same numbers, each a row
 * of function pointers, chosen by the configuration. */
#ifndef AST_SCORE_H
#define AST_SCORE_H

#include "arena.h"
#include "asttrack.h"
#include "bag.h"
#include "history.h"
#include "kernels.h"
#include "linalg.h"
#include "metric.h"

/* Candidates are scored in tiles of this many patches, one in each lane, so that memory does not grow with particles x patch
 * length. */
enum { AST_TILE = AST_LANES };

/* What every candidate of a frame shares. Only the bag's lead columns and marks, the spare columns and the work are written. */
struct ast_scene {
    const ast_config *cfg;
    const struct ast_linalg *la;
    const struct ast_kernels *kernels;
    const struct ast_history *history; /* at least one patch */
    struct ast_bag *bag;               /* at least one model */
    int background;                    /* vectors of the background, which lie at the end of the bag's lead behind their mean */
    float *spare;                      /* AST_TILE columns of the bag's stride, free while a frame is prepared */
    ast_real *work;                    /* ast_subspace_work(la, dim, history + 1) elements, free for the call's duration */
    size_t work_count;
};

/* Scratch of the literal scoring: of a frame, and of a tile. */
struct ast_literal {
    int dim;
    ast_real *models; /* the bag's bases in ast_real: dim x (k n) */
};
struct ast_literal_tile {
    ast_real *values; /* singular values of a set: P + 1 */
    ast_real *cross;  /* U_i'U_j: n x n */
    ast_real *small;  /* workspace for its decomposition */
    size_t small_count;
    float *mean;       /* mu_i: dim */
    float *difference; /* mu_i - mu_j: dim */
};

/* A model as a tile of candidates meets it. */
struct ast_gram_model {
    int first;                 /* its first column in the bag */
    int rank;                  /* directions present */
    const ast_real *factor;    /* Cholesky factor of U_j'MU_j: n x n; NULL in the identity */
    const ast_real *basis_gap; /* U_j'(mu_j - reference): n */
    ast_real gap_square;       /* |mu_j - reference|^2 */
};

/* A tile of candidates, one in each lane. */
struct ast_gram_tile {
    float *inner;         /* inner products d'x with the bag's columns */
    const float *beside;  /* the same, but the residual's (d - Q q) where a lane is apart: inner where none is */
    float *beside_buffer; /* room for them; NULL in a learned metric, where no lane ever is */
    ast_real *square;     /* |d|^2 */
    ast_real *length;     /* the same before the metric: what rounding is relative to */
    ast_real *apart;      /* 1: the inner products with e are computed from the residual itself */
    ast_real *background; /* the likelihood ratio's share of the distance */
    ast_real *q;          /* Q'd: P */
    ast_real *rest;       /* |d - Q q|^2 */
    ast_real *rho;        /* its root; 0 when that is nothing */
    ast_real *matrix;     /* the set's scatter matrix: (P + 1) x (P + 1) */
    ast_real *values;     /* eigenvalues: max(P + 1, n) */
    ast_real *vectors;    /* its eigenvectors, then the coefficients of Q'x and d'x in U_i'x: (P + 1) x (P + 1) */
    ast_real *absent;     /* 1: direction of U_i that is not there: n */
    ast_real *constant;   /* U_i'd: n */
    ast_real *cross;      /* U_i'U_j: n x n */
    ast_real *small;      /* its Gram matrix: n x n */
    ast_real *spare;      /* for its eigenvalues: n + 1 */
    float *fresh;         /* what the metric takes away: background; NULL in the identity */
};

/* Scratch of the Gram scoring. r <= P is the rank of the history; column l of the lead is its basis vector Q_l. */
struct ast_gram {
    int dim;
    int size;                  /* n */
    size_t columns;            /* columns of the bag when it is full */
    int rank;                  /* r */
    ast_real gamma;            /* weight of a candidate in its set's scatter matrix */
    ast_real share;            /* weight of a candidate in its set's mean */
    ast_real alpha;            /* of the Mahalanobis term; below zero: there is none */
    ast_real *spectrum;        /* squared singular values of the history about its origin: P */
    ast_real *offset;          /* Q'(reference - origin): P */
    ast_real *matrix;          /* eigen-problem of the history: P x P */
    ast_real *vectors;         /* its eigenvectors */
    ast_real *values;          /* its eigenvalues: P */
    ast_real history_square;   /* sum of the history's squared norms */
    ast_real reference_square; /* |reference|^2 */
    ast_real *gap_square;      /* |mu_j - reference|^2: k */
    ast_real *basis_gap;       /* U_j'(mu_j - reference): k x n */
    ast_real *factor;          /* Cholesky factors of the bases' inner products: k x n x n; unused in the identity */
    ast_real origin_square;    /* |reference - m_b|^2 */
    struct ast_metric metric;
    ast_real *taken; /* what the metric takes away of an aim: background; NULL without a shortlist */
    float *shared;   /* inner products of [reference Q] with the bag's columns: (P + 1) x columns, row-major */
    float *kept;     /* the same of the background's mean and vectors, kept from frame to frame: (1 + background) x columns */
};

/* Of a frame: written while it is prepared, then read by all tiles. */
union ast_scratch {
    struct ast_gram gram;
    struct ast_literal literal;
};
/* Of a tile: tiles that are scored at the same time have one each. */
union ast_tile_scratch {
    struct ast_gram_tile gram;
    struct ast_literal_tile literal;
};

struct ast_scoring {
    /* Columns that it wants in front of the bag's. */
    int (*lead)(const ast_config *cfg);
    /* Takes its scratch from the arena. */
    void (*layout)(union ast_scratch *scratch, const ast_config *cfg, int dim, struct ast_arena *arena);
    void (*tile_layout)(union ast_tile_scratch *own, const ast_config *cfg, const struct ast_linalg *la, int dim,
                        struct ast_arena *arena);
    /* Once a frame, then for each tile. 0, or the backend's failure. */
    int (*prepare)(union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene);
    /* Once the frame is prepared: the direction along which a patch comes nearer to the models, each of them with its say
     * (bag->count, >= 0), to first order; its first `length` floats. Needs a background; NULL where that is not scored. */
    void (*aim)(const union ast_scratch *scratch, const struct ast_scene *scene, const float *say, int length, float *direction);
    /* patches: count <= AST_TILE columns of the bag's stride, destroyed. distance: count x bag->count, row-major. */
    int (*tile)(const union ast_scratch *scratch, union ast_tile_scratch *own, const struct ast_scene *scene, float *patches,
                int count, float *distance);
};

extern const struct ast_scoring ast_scoring_gram;
extern const struct ast_scoring ast_scoring_literal;

const struct ast_scoring *ast_scoring_of(const ast_config *cfg);

#endif
