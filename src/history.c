#include "history.h"

#include <string.h>

void ast_history_layout(struct ast_history *history, int dim, int stride, int capacity, struct ast_arena *arena) {
    history->dim = dim;
    history->stride = stride;
    history->capacity = capacity;
    history->patches = ast_arena_take(arena, (size_t)stride * (size_t)capacity, sizeof *history->patches);
    ast_history_clear(history);
}

void ast_history_clear(struct ast_history *history) {
    history->count = 0;
    history->oldest = 0;
}

static float *slot(const struct ast_history *history, int index) {
    return history->patches + (size_t)((history->oldest + index) % history->capacity) * (size_t)history->stride;
}

void ast_history_push(struct ast_history *history, const float *patch) {
    if (history->count < history->capacity)
        history->count++;
    else
        history->oldest = (history->oldest + 1) % history->capacity;
    memcpy(slot(history, history->count - 1), patch, (size_t)history->dim * sizeof *patch);
}

const float *ast_history_patch(const struct ast_history *history, int index) {
    return slot(history, index);
}
