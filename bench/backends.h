/* The linear-algebra backends that are linked into the bench: builtin always, lapacke where AST_BENCH_LAPACKE says so. */
#ifndef BACKENDS_H
#define BACKENDS_H

#include "linalg.h"

#ifdef AST_BENCH_LAPACKE
enum { BACKENDS = 2 };
#else
enum { BACKENDS = 1 };
#endif

extern const struct ast_linalg *const backends[BACKENDS];

#endif
