/* All kernels of one instruction set: included by one file each, which says how (AST_KERNELS, AST_VECTOR_BYTES, AST_PANEL_COLUMNS,
 * AST_PANEL_VECTORS) and aims the compiler at it. */
#include "kernels.h"

#include "product_kernel.h"

#include "eigen_kernel.h"

#include "score_kernel.h"

const struct ast_kernels AST_KERNELS = {AST_KERNELS_NAME, pack,    panel_product, depart, solve, eigen,
                                        eigenvalues,      project, decompose,     pair};
