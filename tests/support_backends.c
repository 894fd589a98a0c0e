#include "support_backends.h"

const struct ast_linalg *const backends[BACKENDS] = {
    &ast_linalg_builtin,
#ifdef AST_TEST_LAPACKE
    &ast_linalg_lapacke,
#endif
};

int backends_prepare(void) {
    int failed = 0;
    for (int b = 0; b < BACKENDS; b++) failed |= backends[b]->prepare();
    return failed;
}
