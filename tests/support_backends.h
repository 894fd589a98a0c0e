/* Every linear-algebra backend that is linked into the tests: builtin always, lapacke where AST_TEST_LAPACKE says so. */
#ifndef SUPPORT_BACKENDS_H
#define SUPPORT_BACKENDS_H

#include "linalg.h"

#ifdef AST_TEST_LAPACKE
enum { BACKENDS = 2 };
#else
enum { BACKENDS = 1 };
#endif

extern const struct ast_linalg *const backends[BACKENDS];

/* Prepares them all; 0 when all agree. */
int backends_prepare(void);

#endif
