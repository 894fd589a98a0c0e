#include "backends.h"

const struct ast_linalg *const backends[BACKENDS] = {
    &ast_linalg_builtin,
#ifdef AST_BENCH_LAPACKE
    &ast_linalg_lapacke,
#endif
};
