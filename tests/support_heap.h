/* ast_init as two other builds of the library would have it: one compiled with AST_NO_HEAP, one whose malloc has nothing left. */
#ifndef SUPPORT_HEAP_H
#define SUPPORT_HEAP_H

#include "asttrack.h"

int no_heap_init(ast_tracker **out, const ast_config *cfg, void *mem, size_t mem_size);
void no_heap_free(ast_tracker *t);
int full_heap_init(ast_tracker **out, const ast_config *cfg, void *mem, size_t mem_size);
void full_heap_free(ast_tracker *t);

#endif
