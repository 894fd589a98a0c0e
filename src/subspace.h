/* Affine subspaces of image sets: mean and SVD basis (paper eq. 1, section 2.2). */
#ifndef AST_SUBSPACE_H
#define AST_SUBSPACE_H

#include "linalg.h"

/* A direction whose singular value is at most this fraction of the set's Frobenius norm is absent. */
#define AST_RANK_TOLERANCE ((ast_real)1e-5)

/* A set of images as columns, without copying them. */
struct ast_images {
    const float *const *column; /* count vectors of dim floats */
    int count, dim;
};

/* ast_real elements of workspace for the functions below. */
size_t ast_subspace_work(const struct ast_linalg *la, int dim, int count);

/* Frobenius norm of the set, uncentred. */
ast_real ast_images_norm(const struct ast_images *images);
/* Mean image, dim floats. */
void ast_images_mean(const struct ast_images *images, float *mean);
/* Singular values (min(dim, count), descending) and left singular vectors (dim x min(dim, count), packed, at the start of work) of
 * the images minus origin (dim floats; NULL: as they are). 0, or the backend's failure. */
int ast_images_svd(const struct ast_linalg *la, const struct ast_images *images, const float *origin, ast_real *values,
                   ast_real *work, size_t work_count);
/* Singular values above the rank tolerance, at most n. */
int ast_rank(const ast_real *values, int count, int n, ast_real norm);
/* Mean and basis (dim x n, stride floats a column, absent directions zero) of a set; *rank receives the directions present.
 * centred: the basis of images minus mean, otherwise of the images minus origin (NULL: as they are). */
int ast_subspace_of(const struct ast_linalg *la, const struct ast_images *images, int centred, const float *origin, int n,
                    float *mean, float *basis, int stride, int *rank, ast_real *work, size_t work_count);

#endif
