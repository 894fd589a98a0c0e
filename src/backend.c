#include "backend.h"

#ifndef AST_LINALG
#define AST_LINALG ast_linalg_builtin
#endif

const struct ast_linalg *ast_default_linalg(void) {
    return &AST_LINALG;
}
