/* Inner products of float vectors in ast_real, summed in a fixed order. */
#ifndef AST_VECTOR_H
#define AST_VECTOR_H

#include "real.h"

ast_real ast_dot(const float *x, const float *y, int n);

#endif
