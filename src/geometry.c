/* The geometry of affine subspaces as public functions, beyond tracking. */
#include "arena.h"
#include "asttrack.h"
#include "backend.h"
#include "distance.h"
#include "subspace.h"

/* Workspace of both functions: the decomposition of the fit, or two bases, their product and the means' difference. */
static size_t work_elements(int32_t dim, int32_t count) {
    const struct ast_linalg *la = ast_default_linalg();
    const size_t fit = ast_subspace_work(la, dim, count);
    const size_t n = (size_t)count;
    const size_t distance = 2 * (size_t)dim * n + n * n + la->svd_work((int)count, (int)count) + (size_t)dim;
    return fit > distance ? fit : distance;
}

/* LAPACK's decomposition may never return from a NaN. */
static int is_finite(const float *columns, int32_t dim, int32_t stride, int32_t count) {
    for (int32_t j = 0; j < count; j++) {
        const float *column = columns + (size_t)j * (size_t)stride;
        for (int32_t d = 0; d < dim; d++)
            if (!(column[d] - column[d] == 0.0f)) return 0;
    }
    return 1;
}

size_t ast_subspace_work_size(int32_t dim, int32_t count) {
    if (dim < 1 || count < 1 || count > AST_MAX_HISTORY + 1) return 0;
    return work_elements(dim, count) * sizeof(ast_real) + AST_ALIGNMENT - 1;
}

int ast_subspace_fit(const float *images, int32_t dim, int32_t stride, int32_t count, int basis_kind, int32_t n, float *mean,
                     float *basis, ast_subspace *out, void *work, size_t work_size) {
    if (images == NULL || mean == NULL || basis == NULL || out == NULL || work == NULL) return AST_E_NULL;
    if (dim < 1 || stride < dim || count < 1 || count > AST_MAX_HISTORY + 1 || n < 1 || n > AST_MAX_BASIS) return AST_E_RANGE;
    if (basis_kind != AST_BASIS_CENTRED && basis_kind != AST_BASIS_RAW) return AST_E_RANGE;
    if (work_size < ast_subspace_work_size(dim, count)) return AST_E_BUFFER;
    if (!is_finite(images, dim, stride, count)) return AST_E_RANGE;

    const float *column[AST_MAX_HISTORY + 1];
    const struct ast_images set = {column, count, dim};
    int rank = 0;
    for (int32_t j = 0; j < count; j++) column[j] = images + (size_t)j * (size_t)stride;
    if (ast_subspace_of(ast_default_linalg(), &set, basis_kind == AST_BASIS_CENTRED, NULL, n, mean, basis, dim, &rank,
                        (ast_real *)(void *)ast_align(work), work_elements(dim, count)) != 0)
        return AST_E_BACKEND;
    out->mean = mean;
    out->basis = basis;
    out->dim = dim;
    out->stride = dim;
    out->n = n;
    out->rank = rank;
    return AST_OK;
}

static int subspace_is_legal(const ast_subspace *s) {
    return s->dim >= 1 && s->stride >= s->dim && s->n >= 1 && s->n <= AST_MAX_BASIS && s->rank >= 0 && s->rank <= s->n &&
           is_finite(s->mean, s->dim, s->dim, 1) && is_finite(s->basis, s->dim, s->stride, s->rank);
}

/* The present basis vectors in ast_real, packed. */
static void widen(const ast_subspace *s, ast_real *out) {
    for (int32_t l = 0; l < s->rank; l++)
        for (int32_t d = 0; d < s->dim; d++)
            out[(size_t)l * (size_t)s->dim + (size_t)d] = (ast_real)s->basis[(size_t)l * (size_t)s->stride + (size_t)d];
}

int ast_subspace_distance(const ast_subspace *a, const ast_subspace *b, float alpha, ast_distance *out, void *work,
                          size_t work_size) {
    if (a == NULL || b == NULL || out == NULL || work == NULL) return AST_E_NULL;
    if (a->mean == NULL || a->basis == NULL || b->mean == NULL || b->basis == NULL) return AST_E_NULL;
    if (!subspace_is_legal(a) || !subspace_is_legal(b) || a->dim != b->dim || a->n != b->n) return AST_E_RANGE;
    if (!(alpha >= 0.0f && alpha <= 1e6f)) return AST_E_RANGE;
    if (work_size < ast_subspace_work_size(a->dim, a->n)) return AST_E_BUFFER;

    const struct ast_linalg *la = ast_default_linalg();
    const int dim = a->dim, n = a->n;
    const size_t area = (size_t)dim * (size_t)n;
    ast_real *basis_a = (ast_real *)(void *)ast_align(work), *basis_b = basis_a + area, *cross = basis_b + area;
    ast_real *difference = cross + (size_t)n * (size_t)n, *svd_work = difference + dim;
    ast_real cosines[AST_MAX_BASIS], angles[AST_MAX_BASIS], along_a[AST_MAX_BASIS], along_b[AST_MAX_BASIS];
    ast_real square = 0;

    widen(a, basis_a);
    widen(b, basis_b);
    for (int d = 0; d < dim; d++) {
        difference[d] = (ast_real)a->mean[d] - (ast_real)b->mean[d];
        square += difference[d] * difference[d];
    }
    int failed = 0;
    if (a->rank > 0 && b->rank > 0) {
        failed = la->product_real(a->rank, b->rank, dim, basis_a, dim, basis_b, dim, cross, a->rank);
        if (!failed) failed = la->svd(a->rank, b->rank, cross, 0, cosines, svd_work, la->svd_work(n, n));
    }
    if (!failed && a->rank > 0) failed = la->product_real(a->rank, 1, dim, basis_a, dim, difference, dim, along_a, a->rank);
    if (!failed && b->rank > 0) failed = la->product_real(b->rank, 1, dim, basis_b, dim, difference, dim, along_b, b->rank);
    if (failed) return AST_E_BACKEND;

    ast_principal_angles(cosines, a->rank, b->rank, n, angles);
    const ast_real arc = ast_geodesic(angles, n), mean_term = ast_mahalanobis(square, along_a, a->rank, along_b, b->rank);
    for (int l = 0; l < AST_MAX_BASIS; l++) out->angle[l] = l < n ? (float)angles[l] : 0.0f;
    out->geodesic = (float)arc;
    out->mahalanobis = (float)mean_term;
    out->distance = (float)(arc + (ast_real)alpha * mean_term);
    return AST_OK;
}
