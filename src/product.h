/* The library's own matrix product: c = a' b, a depth x rows (lda), b depth x cols (ldb), c rows x cols (ldc), column-major. An
 * element of c has the same bits wherever it stands in whatever product, on every processor. */
#ifndef AST_PRODUCT_H
#define AST_PRODUCT_H

void ast_product(int rows, int cols, int depth, const float *a, int lda, const float *b, int ldb, float *c, int ldc);

#endif
