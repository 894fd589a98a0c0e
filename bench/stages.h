/* Where a step's time goes, without a line in the library for it: the tracker's two tables of functions (the scoring's and the
 * linear algebra's) are replaced by copies whose entries read the clock and call the real ones. What lies between those calls is
 * the rest of the step: before the first of them the cloud and the view, between tiles the candidates' features, after the last one
 * the decision. What reading the clock takes, some four times a tile, is subtracted. One thread only. */
#ifndef STAGES_H
#define STAGES_H

#include "tracker.h"

enum stage {
    STAGE_VIEW,     /* resampling and moving the cloud, the view, what all its windows share */
    STAGE_HISTORY,  /* what all candidates share: the history's subspace, its products with the bag, the metric */
    STAGE_PATCHES,  /* the candidates' feature vectors */
    STAGE_PRODUCT,  /* the candidates' matrix products, through the linear-algebra seam */
    STAGE_SMALL,    /* the rest of scoring: eigen-problems, angles, distances; of the literal scoring its decompositions, too */
    STAGE_DECISION, /* likelihoods, weights, the winner; learning from it */
    STAGES
};
/* A word or two for tables and files. */
const char *stage_name(enum stage stage);

/* Stays where it is while its tracker lives. */
struct probe {
    const struct ast_linalg *linalg; /* the real ones */
    const struct ast_scoring *scoring;
    struct ast_linalg probed_linalg; /* the copies */
    struct ast_scoring probed_scoring;
    double (*clock)(void);  /* seconds; the processor's time unless it is replaced after probe_linalg */
    double seconds[STAGES]; /* of the last probe_step */
    double mark;            /* when the current stage began */
    double cost;            /* of reading the clock, seconds */
};

/* The table to give to ast_init_backend in place of its real one. */
const struct ast_linalg *probe_linalg(struct probe *p, const struct ast_linalg *linalg);
/* Replaces the scoring of the tracker that was made so. */
void probe_scoring(struct probe *p, struct ast_tracker *t);
/* A step that leaves its stages in p->seconds. */
int probe_step(struct probe *p, struct ast_tracker *t, const ast_frame *frame, ast_result *result);

#endif
