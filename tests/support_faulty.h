/* A linear-algebra backend that hands everything on to another, and fails when it is told to. */
#ifndef SUPPORT_FAULTY_H
#define SUPPORT_FAULTY_H

#include "linalg.h"

extern const struct ast_linalg faulty_linalg;

/* From now on `behind` does the work, but for call number fail_at (1 is the first; 0: all succeed), which writes NaN and fails.
 * Calls are those that compute: products and decompositions. */
void faulty_arm(const struct ast_linalg *behind, int fail_at);
/* Calls since then. */
int faulty_calls(void);
/* Whether prepare fails. */
void faulty_prepare_fails(int fails);

#endif
