#include "confidence.h"

#include "real.h"
#include "vector.h"

/* Correlation coefficient of two vectors; 0 where one of them is flat. */
static ast_real correlation(const float *x, const float *y, int n) {
    ast_real sum_x = 0, sum_y = 0;
    for (int d = 0; d < n; d++) {
        sum_x += (ast_real)x[d];
        sum_y += (ast_real)y[d];
    }
    const ast_real cross = ast_dot(x, y, n) - sum_x * sum_y / (ast_real)n;
    const ast_real xx = ast_dot(x, x, n), yy = ast_dot(y, y, n);
    const ast_real around_x = xx - sum_x * sum_x / (ast_real)n, around_y = yy - sum_y * sum_y / (ast_real)n;
    /* What rounding of the sums leaves of a flat vector's, which in single precision is more than the rest. */
    const ast_real rounding = ast_real_epsilon() * (ast_real)n, flat = (ast_real)1e-9 * (ast_real)n;
    const int varies = around_x > flat && around_y > flat && around_x > rounding * xx && around_y > rounding * yy;
    return varies ? cross / ast_sqrt(around_x * around_y) : 0;
}

float ast_confidence_score(const float *patch, const float *anchor, const struct ast_bag *bag) {
    const ast_real first = correlation(patch, anchor, bag->dim);
    ast_real likest = first;
    for (int j = 0; j < bag->count; j++) {
        const ast_real c = correlation(patch, ast_bag_mean(bag, j), bag->dim);
        if (c > likest) likest = c;
    }
    const ast_real score = (first + likest) / 2;
    return score <= 0 ? 0.0f : score >= 1 ? 1.0f : (float)score;
}

float ast_confidence_probability(const struct ast_evidence *evidence) {
    const float least = 0.01f; /* object sizes: a cloud narrower than that is sure, and its logarithm stays finite */
    const float log_odds = 5.0f * evidence->start - 0.96f * ast_logf(evidence->spread + least) + 14.6f * evidence->inside - 16.3f;
    return 1.0f / (1.0f + ast_expf(-log_odds));
}

struct ast_confidence ast_confidence_next(struct ast_confidence last, const ast_config *cfg, float score) {
    struct ast_confidence next = {AST_TRACKING, 0};
    if (score < cfg->score_lost) next.low = last.low < cfg->lost_after ? last.low + 1 : cfg->lost_after;
    if (score < cfg->score_uncertain)
        next.status = last.status == AST_LOST || next.low == cfg->lost_after ? AST_LOST : AST_UNCERTAIN;
    return next;
}
