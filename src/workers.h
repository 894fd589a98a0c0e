/* The threads that share a step's work: made by ast_init, asleep between their tasks, ended by ast_free. */
#ifndef AST_WORKERS_H
#define AST_WORKERS_H

#include "arena.h"
#include "build.h"

/* Work in parts 0 .. parts - 1. A part is done by worker number 0 .. count - 1, where parts that are done at the same time have
 * different workers; 0, or a failure. */
struct ast_task {
    int (*part)(void *shared, int worker, int part);
    void *shared;
    int parts;
    int more; /* 1: another task comes at once, which is worth staying awake for */
};

struct ast_workers;

/* Room for count workers, of which the caller's thread is one. NULL for one worker, who needs none and whom NULL stands for below;
 * and while the arena counts. */
struct ast_workers *ast_workers_layout(int count, struct ast_arena *arena);
/* Starts their threads. 0, or a failure, after which there are none. */
int ast_workers_start(struct ast_workers *workers);
/* Ends them; also when they were never started. */
void ast_workers_end(struct ast_workers *workers);

/* Says that a task comes soon: those who sleep take tens of microseconds to wake. */
void ast_workers_wake(struct ast_workers *workers);
/* Has all parts done, each once, in any order, and returns when they are. 0, or a part's failure, after which parts that nobody has
 * begun are left out. */
int ast_workers_share(struct ast_workers *workers, const struct ast_task *task);

#endif
