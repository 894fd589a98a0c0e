#include "vector.h"

#include "kernels.h"

ast_real ast_dot(const float *x, const float *y, int n) {
    const struct ast_kernels *kernels = ast_kernels();
    return kernels->dot(x, y, n);
}
