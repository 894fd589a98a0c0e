/* The tracker: everything it remembers between frames, then everything it needs within one. */
#ifndef AST_TRACKER_H
#define AST_TRACKER_H

#include "asttrack.h"
#include "background.h"
#include "bag.h"
#include "confidence.h"
#include "decision.h"
#include "feature.h"
#include "guard.h"
#include "history.h"
#include "particles.h"
#include "random.h"
#include "score.h"
#include "view.h"
#include "workers.h"

/* What a worker needs for itself, to describe candidates and to score them. */
struct ast_desk {
    struct ast_features_scratch features;
    union ast_tile_scratch scoring;
    float *tile;    /* AST_TILE vectors; the first desk's: or history + 1 where that is more */
    ast_real *work; /* for decompositions */
};

struct ast_tracker {
    ast_config cfg;
    const struct ast_linalg *la;
    const struct ast_kernels *kernels;
    const struct ast_scoring *scoring;
    void *owned; /* the block, when ast_init allocated it */
    int dim;     /* D: floats in a feature vector */
    int stride;  /* floats from one vector to the next: at least D, and a multiple of AST_ALIGNMENT bytes */

    /* State, saved by ast_save. Changed only when a call succeeds. */
    int started;
    uint32_t frame;               /* frames since the start */
    uint32_t since_model;         /* frames since the bag last took a model */
    float box_width, box_height;  /* the object's box at scale 1, pixels */
    struct ast_state estimate;    /* of the last frame */
    float velocity_x, velocity_y; /* smoothed, pixels a frame */
    struct ast_random random;
    struct ast_confidence confidence;
    struct ast_guard guard;
    struct ast_cloud cloud;
    struct ast_history history;
    struct ast_bag bag;
    struct ast_background background; /* columns of the bag's lead */
    float *anchor;                    /* mean of the patches given at the start: dim */

    /* Scratch of one call. */
    struct ast_cloud proposal;
    struct ast_view view;
    struct ast_features features;
    union ast_scratch scoring_scratch;
    struct ast_desk *desk;   /* one for each worker; all but the tiles is done at the first */
    float *distance;         /* scored particles x models of the last step */
    int models;              /* columns of distance; 0 before the first step */
    int scored;              /* rows of it */
    struct ast_voice *voice; /* what each model said at the last step: bag_size */
    float *direction;  /* in which what is seen at a glance comes nearer to the models; NULL without a shortlist, as the next two */
    float *promise;    /* along it, of each particle */
    float *heap;       /* to choose among them: shortlist */
    float *mean;       /* of a set being fitted: dim */
    float *basis;      /* of it: basis_size columns */
    size_t work_count; /* elements of a desk's work */
    struct ast_workers *workers;
};

/* As ast_init, with another linear-algebra backend than the build's: for tests of the seam. */
int ast_init_backend(ast_tracker **out, const ast_config *cfg, const struct ast_linalg *la, void *mem, size_t mem_size);
size_t ast_mem_size_backend(const ast_config *cfg, const struct ast_linalg *la);

#endif
