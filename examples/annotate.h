/* A frame as a picture to look at: the particle cloud, the tracked box, the ground truth and the status drawn in. */
#ifndef ANNOTATE_H
#define ANNOTATE_H

#include "image.h"

typedef struct annotation {
    const image *frame; /* grey */
    const char *name;   /* of the sequence */
    int32_t number;     /* of the frame, from 1 */
    ast_box box;        /* the tracker's */
    float score;
    int32_t status;          /* AST_TRACKING, AST_UNCERTAIN, AST_LOST */
    ast_particles particles; /* count 0: none */
    const ast_box *truth;    /* NULL: none */
} annotation;

/* Draws onto canvas, which becomes width x height with the frame scaled to fill it. False when out of memory. */
bool annotate(image *canvas, int32_t width, int32_t height, const annotation *a);

#endif
