/* Gives every function of tracker.c a name of its own, with the prefix PREFIX: so that it can be compiled once more, otherwise. */
#define JOIN(a, b) a##_##b
#define RENAMED(prefix, name) JOIN(prefix, name)
#define ast_mem_size RENAMED(PREFIX, mem_size)
#define ast_mem_size_backend RENAMED(PREFIX, mem_size_backend)
#define ast_init RENAMED(PREFIX, init)
#define ast_init_backend RENAMED(PREFIX, init_backend)
#define ast_free RENAMED(PREFIX, free)
#define ast_start RENAMED(PREFIX, start)
#define ast_start_sequence RENAMED(PREFIX, start_sequence)
#define ast_step RENAMED(PREFIX, step)
