/* One block of memory, handed out in order. The routine that lays a tracker out runs twice over the same calls: with base == NULL
 * it counts, with a block it binds, so size and layout cannot disagree. */
#ifndef AST_ARENA_H
#define AST_ARENA_H

#include <stddef.h>

#include "dialect.h"

enum { AST_ALIGNMENT = 64 }; /* a cache line, and the widest vector */

struct ast_arena {
    unsigned char *base; /* aligned to AST_ALIGNMENT, or NULL while counting */
    size_t used;         /* bytes handed out */
};

/* count elements of size bytes, aligned; NULL while counting. */
ast_memory ast_arena_take(struct ast_arena *arena, size_t count, size_t size);
/* The first aligned address in a block. */
unsigned char *ast_align(void *block);

#endif
