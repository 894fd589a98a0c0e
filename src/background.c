#include "background.h"

#include <string.h>

#include "real.h"

ast_box ast_background_box(const ast_box *object, struct ast_random *random) {
    const float angle = 6.28318531f * ast_random_uniform(random);
    const float distance = 0.4f + 1.1f * ast_random_uniform(random);
    const float growth = ast_expf(0.05f * ast_random_normal(random));
    const float w = object->w * growth, h = object->h * growth;
    const float x = object->x + 0.5f * object->w + distance * object->w * ast_cosf(angle);
    const float y = object->y + 0.5f * object->h + distance * object->h * ast_sinf(angle);
    const ast_box box = {x - 0.5f * w, y - 0.5f * h, w, h};
    return box;
}

void ast_background_average(struct ast_background *b) {
    for (int d = 0; d < b->dim; d++) {
        ast_real sum = 0;
        for (int z = 0; z < b->size; z++) sum += (ast_real)b->set[(size_t)z * (size_t)b->stride + (size_t)d];
        b->mean[d] = (float)(sum / (ast_real)b->size);
    }
    memset(b->changed, 1, 1 + (size_t)b->size);
}

void ast_background_replace(struct ast_background *b, int slot, const float *vector) {
    for (int d = 0; d < b->dim; d++) b->mean[d] += AST_BACKGROUND_RATE * (vector[d] - b->mean[d]);
    memcpy(b->set + (size_t)slot * (size_t)b->stride, vector, (size_t)b->dim * sizeof *vector);
    b->changed[0] = b->changed[1 + slot] = 1;
}
