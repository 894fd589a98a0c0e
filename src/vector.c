#include "vector.h"

#include "kernels.h"

ast_real ast_dot(const float *x, const float *y, int n) {
    return ast_kernels()->dot(x, y, n);
}
