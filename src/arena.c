#include "arena.h"

#include <stdint.h>

ast_memory ast_arena_take(struct ast_arena *arena, size_t count, size_t size) {
    const size_t bytes = (count * size + AST_ALIGNMENT - 1) / AST_ALIGNMENT * AST_ALIGNMENT;
    void *place = arena->base == NULL ? NULL : arena->base + arena->used;
    arena->used += bytes;
    return place;
}

unsigned char *ast_align(void *block) {
    unsigned char *bytes = (unsigned char *)block;
    const size_t past = (size_t)((uintptr_t)bytes % AST_ALIGNMENT);
    return past == 0 ? bytes : bytes + (AST_ALIGNMENT - past);
}
