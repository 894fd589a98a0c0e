/* The bag of models: the last k affine subspaces of the object (paper section 2.3). */
#ifndef AST_BAG_H
#define AST_BAG_H

#include "arena.h"
#include "asttrack.h"
#include "real.h"

/* All vectors of the bag are columns of one matrix, so that one product compares a patch with every model: first `lead` columns
 * that belong to the scoring (scratch), then for each model its n basis vectors and its mean. */
struct ast_bag {
    float *columns;
    int dim, stride; /* floats in a column, floats from one to the next */
    int lead;
    int n;                  /* basis vectors of a model */
    int capacity;           /* k */
    int count;              /* models held, in slots 0 .. count - 1 */
    int keep_first;         /* slot 0 is never replaced */
    int oldest;             /* slot of the oldest model that may be replaced */
    int *rank;              /* capacity: basis vectors present */
    ast_real *basis_mean;   /* capacity x n: U'mu, kept because it changes only with the model */
    float *say;             /* capacity: each model's share in the last winner's weight, 0 .. 1; all 0 where no shortlist asks */
    unsigned char *changed; /* a mark for each column that was written since the scoring last looked */
};

void ast_bag_layout(struct ast_bag *bag, int dim, int stride, int lead, int n, int capacity, int keep_first,
                    struct ast_arena *arena);
void ast_bag_clear(struct ast_bag *bag);
/* Marks all columns as changed. */
void ast_bag_mark(struct ast_bag *bag);
/* Columns of the product: the lead and the models held. */
int ast_bag_columns(const struct ast_bag *bag);
float *ast_bag_basis(const struct ast_bag *bag, int slot);
float *ast_bag_mean(const struct ast_bag *bag, int slot);
/* The slot that the next model takes: a free one, else the oldest's. */
int ast_bag_next(const struct ast_bag *bag);
/* Puts a model (basis dim x n, stride floats a column) into the next slot. */
void ast_bag_add(struct ast_bag *bag, const float *mean, const float *basis, int rank);
/* Recomputes what is derived from a slot's vectors. */
void ast_bag_derive(struct ast_bag *bag, int slot);
/* Slot of model index, 0 = oldest. */
int ast_bag_slot(const struct ast_bag *bag, int index);

#endif
