#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* pthread_sigmask */
#endif
#include "workers.h"

#include "asttrack.h"

static int do_alone(const struct ast_task *task) {
    int failed = 0;
    for (int part = 0; part < task->parts && !failed; part++) failed = task->part(task->shared, 0, part);
    return failed;
}

#ifndef AST_NO_THREADS

#include <pthread.h>
#include <sched.h>
#include <signal.h>

/* How often who waits for a short time looks, and lets others run, before it sleeps: as long, about, as it takes to wake. */
enum { LOOKS = 100 };

struct ast_worker {
    struct ast_workers *all;
    int number;
    pthread_t thread;
};

struct ast_workers {
    int count;
    int running; /* threads that were started */
    struct ast_worker *worker;
    /* All below is read and written under the lock alone. */
    pthread_mutex_t lock;
    pthread_cond_t begun; /* a task is there, or the end */
    pthread_cond_t done;  /* nobody is at a part any more */
    struct ast_task task;
    int next; /* the first part that nobody has begun */
    int busy; /* workers at a part */
    int failed;
    int expecting; /* a task comes soon */
    int ending;
};

/* What AST_MEM_SIZE counts on. */
typedef char ast_workers_within_bound[sizeof(struct ast_workers) <= AST_MEM_CREW_ ? 1 : -1];
typedef char ast_worker_within_bound[sizeof(struct ast_worker) <= AST_MEM_WORKER_ ? 1 : -1];

struct ast_workers *ast_workers_layout(int count, struct ast_arena *arena) {
    if (count < 2) return NULL;
    struct ast_workers *w = ast_arena_take(arena, 1, sizeof *w);
    struct ast_worker *worker = ast_arena_take(arena, (size_t)count, sizeof *worker);
    if (w == NULL) return NULL;
    w->count = count;
    w->running = 0;
    w->worker = worker;
    w->task.parts = w->next = w->busy = w->failed = w->expecting = w->ending = 0;
    return w;
}

/* Does parts until none is left. With the lock held, before and after. */
static void take_parts(struct ast_workers *w, int number) {
    while (w->next < w->task.parts) {
        const int part = w->next++;
        w->busy++;
        (void)pthread_mutex_unlock(&w->lock);
        const int failed = w->task.part(w->task.shared, number, part);
        (void)pthread_mutex_lock(&w->lock);
        w->busy--;
        if (failed == 0) continue;
        w->failed = failed;
        w->next = w->task.parts;
    }
}

/* With the lock held, before and after. */
static void look_away(struct ast_workers *w) {
    (void)pthread_mutex_unlock(&w->lock);
    (void)sched_yield();
    (void)pthread_mutex_lock(&w->lock);
}

/* Until there is a part to do, or the end. With the lock held, before and after. */
static void await_task(struct ast_workers *w) {
    int looks = 0;
    while (!w->ending && w->next >= w->task.parts) {
        if (w->expecting && looks++ < LOOKS) {
            look_away(w);
        } else {
            (void)pthread_cond_wait(&w->begun, &w->lock);
            looks = 0;
        }
    }
}

/* Until nobody is at a part. With the lock held, before and after. */
static void await_others(struct ast_workers *w) {
    for (int looks = 0; w->busy > 0; looks++) {
        if (looks < LOOKS)
            look_away(w);
        else
            (void)pthread_cond_wait(&w->done, &w->lock);
    }
}

static void *serve(void *argument) {
    struct ast_worker *self = (struct ast_worker *)argument;
    struct ast_workers *w = self->all;
    (void)pthread_mutex_lock(&w->lock);
    while (!w->ending) {
        take_parts(w, self->number);
        if (w->busy == 0) (void)pthread_cond_signal(&w->done);
        await_task(w);
    }
    (void)pthread_mutex_unlock(&w->lock);
    return NULL;
}

/* The program's signals are for its own threads: the new ones inherit a mask that lets none through. */
static int start_thread(struct ast_worker *worker) {
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&worker->thread, NULL, serve, worker);
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return failed;
}

int ast_workers_start(struct ast_workers *w) {
    if (w == NULL) return 0;
    int failed = pthread_mutex_init(&w->lock, NULL);
    if (failed) return failed;
    failed = pthread_cond_init(&w->begun, NULL);
    if (failed) {
        (void)pthread_mutex_destroy(&w->lock);
        return failed;
    }
    failed = pthread_cond_init(&w->done, NULL);
    if (failed) {
        (void)pthread_cond_destroy(&w->begun);
        (void)pthread_mutex_destroy(&w->lock);
        return failed;
    }
    w->running = 1; /* the caller's */
    while (w->running < w->count && !failed) {
        struct ast_worker *worker = &w->worker[w->running];
        worker->all = w;
        worker->number = w->running;
        failed = start_thread(worker);
        if (!failed) w->running++;
    }
    if (failed) ast_workers_end(w);
    return failed;
}

void ast_workers_end(struct ast_workers *w) {
    if (w == NULL || w->running == 0) return;
    (void)pthread_mutex_lock(&w->lock);
    w->ending = 1;
    (void)pthread_cond_broadcast(&w->begun);
    (void)pthread_mutex_unlock(&w->lock);
    while (w->running > 1) (void)pthread_join(w->worker[--w->running].thread, NULL);
    w->running = 0;
    (void)pthread_cond_destroy(&w->done);
    (void)pthread_cond_destroy(&w->begun);
    (void)pthread_mutex_destroy(&w->lock);
}

void ast_workers_wake(struct ast_workers *w) {
    if (w == NULL) return;
    (void)pthread_mutex_lock(&w->lock);
    w->expecting = 1;
    (void)pthread_cond_broadcast(&w->begun);
    (void)pthread_mutex_unlock(&w->lock);
}

int ast_workers_share(struct ast_workers *w, const struct ast_task *task) {
    if (w == NULL || task->parts < 2) return do_alone(task);
    (void)pthread_mutex_lock(&w->lock);
    w->task = *task;
    w->next = w->failed = 0;
    w->expecting = task->more;
    (void)pthread_cond_broadcast(&w->begun);
    take_parts(w, 0);
    await_others(w);
    const int failed = w->failed;
    (void)pthread_mutex_unlock(&w->lock);
    return failed;
}

#else

struct ast_workers *ast_workers_layout(int count, struct ast_arena *arena) {
    (void)count;
    (void)arena;
    return NULL;
}

int ast_workers_start(struct ast_workers *w) {
    (void)w;
    return 0;
}

void ast_workers_end(struct ast_workers *w) {
    (void)w;
}

void ast_workers_wake(struct ast_workers *w) {
    (void)w;
}

int ast_workers_share(struct ast_workers *w, const struct ast_task *task) {
    (void)w;
    return do_alone(task);
}

#endif
