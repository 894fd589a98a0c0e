/* Oriented gradients: cells x cells bins over the window, in each the energy of the image gradient in AST_DIRECTIONS directions. */
#ifndef AST_GRADIENT_H
#define AST_GRADIENT_H

#include "arena.h"
#include "asttrack.h"
#include "kernels.h"

enum { AST_DIRECTIONS = 8 };
/* A response of 1 is one of the local contrast's own size; the blurred ones stay below 255 / AST_GRADIENT_UNIT. */
#define AST_GRADIENT_UNIT 96.0f

struct ast_gradient {
    const struct ast_kernels *kernels;
    int cells;         /* in each axis; 0: no such feature */
    float weight;      /* of the cells in a feature vector */
    int side;          /* most pixels of an image in width and height */
    int width, height; /* of the current maps */
    uint8_t *maps;     /* AST_DIRECTIONS interleaved a pixel, in steps that keep the blurred responses' precision in a byte */
    float *energy;     /* squared gradient, then its local mean: one float a pixel, in the maps' memory while they are made */
    float *row;        /* what is made of a row on its way to the maps: twice AST_DIRECTIONS floats a pixel */
};

static inline int ast_gradient_edge(int i, int count) {
    return i < 0 ? 0 : i < count ? i : count - 1;
}

void ast_gradient_layout(struct ast_gradient *g, const ast_config *cfg, struct ast_arena *arena);
/* Makes the maps of an image, for an object of about this size in it. */
void ast_gradient_prepare(struct ast_gradient *g, const ast_frame *image, float object_width, float object_height);
/* The cells of a window of that image: cells x cells x AST_DIRECTIONS floats of unit norm (an exactly flat window stays small),
 * times the weight. */
void ast_gradient_cells(const struct ast_gradient *g, const ast_box *window, float *out);

#endif
