/* The last tracked patches: a ring of P vectors. */
#ifndef AST_HISTORY_H
#define AST_HISTORY_H

#include "arena.h"
#include "asttrack.h"

struct ast_history {
    float *patches; /* capacity columns of stride floats */
    int dim, stride;
    int capacity; /* P */
    int count;    /* patches held */
    int oldest;   /* slot of the oldest */
};

void ast_history_layout(struct ast_history *history, int dim, int stride, int capacity, struct ast_arena *arena);
void ast_history_clear(struct ast_history *history);
void ast_history_push(struct ast_history *history, const float *patch);
/* Patch index, 0 = oldest. */
const float *ast_history_patch(const struct ast_history *history, int index);

#endif
