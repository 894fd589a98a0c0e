#include "subspace.h"

static size_t values_count(int count) {
    return (size_t)count;
}

size_t ast_subspace_work(const struct ast_linalg *la, int dim, int count) {
    return (size_t)dim * (size_t)count + la->svd_work(dim, count) + values_count(count);
}

ast_real ast_images_norm(const struct ast_images *images) {
    ast_real sum = 0;
    for (int j = 0; j < images->count; j++)
        for (int d = 0; d < images->dim; d++) sum += (ast_real)images->column[j][d] * (ast_real)images->column[j][d];
    return ast_sqrt(sum);
}

void ast_images_mean(const struct ast_images *images, float *mean) {
    for (int d = 0; d < images->dim; d++) {
        ast_real sum = 0;
        for (int j = 0; j < images->count; j++) sum += (ast_real)images->column[j][d];
        mean[d] = (float)(sum / (ast_real)images->count);
    }
}

int ast_images_svd(const struct ast_linalg *la, const struct ast_images *images, const float *origin, ast_real *values,
                   ast_real *work, size_t work_count) {
    const size_t elements = (size_t)images->dim * (size_t)images->count;
    if (work_count < elements) return -1;
    for (int j = 0; j < images->count; j++) {
        ast_real *column = work + (size_t)j * (size_t)images->dim;
        for (int d = 0; d < images->dim; d++)
            column[d] = (ast_real)images->column[j][d] - (origin == NULL ? 0 : (ast_real)origin[d]);
    }
    return la->svd(images->dim, images->count, work, 1, values, work + elements, work_count - elements);
}

int ast_rank(const ast_real *values, int count, int n, ast_real norm) {
    int rank = 0;
    while (rank < count && rank < n && values[rank] > AST_RANK_TOLERANCE * norm) rank++;
    return rank;
}

int ast_subspace_of(const struct ast_linalg *la, const struct ast_images *images, int centred, const float *origin, int n,
                    float *mean, float *basis, int stride, int *rank, ast_real *work, size_t work_count) {
    const int count = images->count < images->dim ? images->count : images->dim;
    const size_t reserved = values_count(images->count);
    if (work_count < reserved) return -1;
    ast_real *values = work + (work_count - reserved);

    ast_images_mean(images, mean);
    const int failed = ast_images_svd(la, images, centred ? mean : origin, values, work, work_count - reserved);
    if (failed) return failed;
    *rank = ast_rank(values, count, n, ast_images_norm(images));
    for (int l = 0; l < n; l++) {
        float *out = basis + (size_t)l * (size_t)stride;
        for (int d = 0; d < images->dim; d++) out[d] = l < *rank ? (float)work[(size_t)l * (size_t)images->dim + (size_t)d] : 0.0f;
    }
    return 0;
}
