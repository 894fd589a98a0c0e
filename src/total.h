/* The total of eight sums, which a compiler can hold side by side, in the one order that each such total is taken in. */
#ifndef AST_TOTAL_H
#define AST_TOTAL_H

#include "real.h"

static inline ast_real total_of_eight(const ast_real *sum) {
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

#endif
