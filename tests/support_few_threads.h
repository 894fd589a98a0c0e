/* ast_init and the workers as they are where the system gives only a few threads, or no more locks. */
#ifndef SUPPORT_FEW_THREADS_H
#define SUPPORT_FEW_THREADS_H

#include "asttrack.h"

/* From now on the system gives this many threads, then none. */
void few_threads_left(int threads);
/* From now on it gives this many locks and conditions, then none; negative: as many as are wanted. */
void few_threads_locks_left(int locks);
/* Threads that were given and have not been joined, locks and conditions that were given and have not been destroyed. */
int few_threads_held(void);

int few_threads_init(ast_tracker **out, const ast_config *cfg, void *mem, size_t mem_size);
void few_threads_free(ast_tracker *t);

#endif
