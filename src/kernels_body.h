/* All kernels of one instruction set: included by one file each, which says how (AST_KERNELS, AST_KERNELS_NAME, AST_VECTOR_BYTES,
 * AST_PANEL_COLUMNS, AST_PANEL_VECTORS) and aims the compiler at it. */
#include "kernels.h"

#include "product_kernel.h"

#include "vector_kernel.h"

#include "decision_kernel.h"

#include "eigen_kernel.h"

#include "resample_kernel.h"

#include "patch_kernel.h"

#ifndef AST_NO_GRADIENT
#include "gradient_kernel.h"
#endif

#include "score_kernel.h"

const struct ast_kernels AST_KERNELS = {
    .name = AST_KERNELS_NAME,
    .pack = pack,
    .panel_product = panel_product,
    .dot = dot,
    .exponentials = exponentials,
    .depart = depart,
    .solve = solve,
    .eigen = eigen,
    .eigenvalues = eigenvalues,
    .axis = axis,
    .rows = rows,
    .normalise = normalise,
#ifndef AST_NO_GRADIENT
    .maps = maps,
    .cells = cells,
#endif
    .project = project,
    .decompose = decompose,
    .pair = pair,
};
