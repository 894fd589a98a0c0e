/* The geometry functions once more, under other names, with the backend that fails when it is told to. */
#include "support_faulty.h"

#define ast_default_linalg faulty_default_linalg
#define ast_subspace_work_size faulty_subspace_work_size
#define ast_subspace_fit faulty_subspace_fit
#define ast_subspace_distance faulty_subspace_distance
const struct ast_linalg *faulty_default_linalg(void);
#include "geometry.c"

const struct ast_linalg *faulty_default_linalg(void) {
    return &faulty_linalg;
}
