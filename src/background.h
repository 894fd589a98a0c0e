/* What the object's surroundings look like: feature vectors of displaced boxes, and their mean. */
#ifndef AST_BACKGROUND_H
#define AST_BACKGROUND_H

#include "arena.h"
#include "asttrack.h"
#include "random.h"

/* Rate of the mean's update for each vector that is drawn anew. */
#define AST_BACKGROUND_RATE 0.002f

struct ast_background {
    int dim, stride;
    int size;               /* vectors; 0: the configuration has no background */
    float *mean;            /* a column */
    float *set;             /* size columns behind it */
    unsigned char *changed; /* the bag's marks of mean and set */
};

/* A displaced box of the object's: moved by 0.4 to 1.5 times its sides in a random direction, its size varied by 5 %. */
ast_box ast_background_box(const ast_box *object, struct ast_random *random);
/* Sets the mean to the set's. */
void ast_background_average(struct ast_background *b);
/* Replaces vector slot and moves the mean a little. */
void ast_background_replace(struct ast_background *b, int slot, const float *vector);

#endif
