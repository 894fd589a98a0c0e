/* The linear-algebra table that this build uses (AST_LINALG, set by the build). */
#ifndef AST_BACKEND_H
#define AST_BACKEND_H

#include "linalg.h"

const struct ast_linalg *ast_default_linalg(void);

#endif
