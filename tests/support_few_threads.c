#define PREFIX few_threads
#include "support_heap_rename.h"

#include "support_few_threads.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>

static int threads_left, locks_left = -1, held;

void few_threads_left(int threads) {
    threads_left = threads;
}

void few_threads_locks_left(int locks) {
    locks_left = locks;
}

int few_threads_held(void) {
    return held;
}

static int few_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
    if (threads_left == 0) return EAGAIN;
    threads_left--;
    held++;
    return pthread_create(thread, attributes, start, argument);
}
static int few_join(pthread_t thread, void **value) {
    held--;
    return pthread_join(thread, value);
}

static int no_lock(void) {
    if (locks_left == 0) return 1;
    if (locks_left > 0) locks_left--;
    held++;
    return 0;
}
static int few_mutex_init(pthread_mutex_t *mutex, const pthread_mutexattr_t *attributes) {
    return no_lock() ? ENOMEM : pthread_mutex_init(mutex, attributes);
}
static int few_mutex_destroy(pthread_mutex_t *mutex) {
    held--;
    return pthread_mutex_destroy(mutex);
}
static int few_cond_init(pthread_cond_t *condition, const pthread_condattr_t *attributes) {
    return no_lock() ? ENOMEM : pthread_cond_init(condition, attributes);
}
static int few_cond_destroy(pthread_cond_t *condition) {
    held--;
    return pthread_cond_destroy(condition);
}

#define pthread_create few_create
#define pthread_join few_join
#define pthread_mutex_init few_mutex_init
#define pthread_mutex_destroy few_mutex_destroy
#define pthread_cond_init few_cond_init
#define pthread_cond_destroy few_cond_destroy
#define ast_workers_layout few_threads_workers_layout
#define ast_workers_start few_threads_workers_start
#define ast_workers_end few_threads_workers_end
#define ast_workers_share few_threads_workers_share
#define ast_workers_wake few_threads_workers_wake
#include "tracker.c"
#include "workers.c"
