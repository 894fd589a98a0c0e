/* Counts every allocation and release of the process, those in shared libraries and mappings of memory included.
 *
 * To be included by one file of a test program: it replaces malloc and its kin for that program alone. Under a sanitizer, which has
 * an allocator of its own, it counts by the sanitizer's hooks, and mappings are not seen. The including file must define
 * _GNU_SOURCE before anything else. */
#ifndef SUPPORT_ALLOCATION_H
#define SUPPORT_ALLOCATION_H

#include <stddef.h>

#include "support_watched.h"

static long allocation_count; /* changed by any thread */

static inline void allocation_tick(void) {
    (void)__atomic_add_fetch(&allocation_count, 1, __ATOMIC_SEQ_CST);
}

static inline long allocations(void) {
    return __atomic_load_n(&allocation_count, __ATOMIC_SEQ_CST);
}

#if SANITIZED

/* Part of every sanitizer that has an allocator; its header is not installed with every compiler. */
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void *, size_t),
                                              void (*on_free)(const volatile void *));

static void allocation_hook(const volatile void *place, size_t size) {
    (void)place;
    (void)size;
    allocation_tick();
}

static void release_hook(const volatile void *place) {
    if (place != NULL) allocation_tick();
}

static void allocations_watch(void) {
    (void)__sanitizer_install_malloc_and_free_hooks(allocation_hook, release_hook);
}

enum { ALLOCATION_SEES_MAPPINGS = 0 };

#else

#include <dlfcn.h>
#include <string.h>
#include <sys/mman.h>

enum { ALLOCATION_SEES_MAPPINGS = 1 };

static void *(*next_malloc)(size_t), *(*next_calloc)(size_t, size_t), *(*next_realloc)(void *, size_t);
static void *(*next_aligned_alloc)(size_t, size_t), *(*next_mmap)(void *, size_t, int, int, int, off_t);
static int (*next_posix_memalign)(void **, size_t, size_t);
static void (*next_free)(void *);

/* dlsym may allocate before it has found what allocates; that little comes from here and stays. */
static union {
    unsigned char bytes[16384];
    long double aligned;
} early;
static size_t early_used;

static void *early_take(size_t size) {
    const size_t at = early_used;
    early_used += (size + 31) / 32 * 32;
    return early_used <= sizeof early.bytes ? early.bytes + at : NULL;
}

static int is_early(const void *place) {
    return (const unsigned char *)place >= early.bytes && (const unsigned char *)place < early.bytes + sizeof early.bytes;
}

static void find(void *function, const char *name) {
    void *place = dlsym(RTLD_NEXT, name);
    memcpy(function, &place, sizeof place);
}

static void find_all(void) {
    static int begun;
    if (begun) return;
    begun = 1;
    find(&next_calloc, "calloc");
    find(&next_malloc, "malloc");
    find(&next_realloc, "realloc");
    find(&next_aligned_alloc, "aligned_alloc");
    find(&next_posix_memalign, "posix_memalign");
    find(&next_mmap, "mmap");
    find(&next_free, "free");
}

void *malloc(size_t size) {
    find_all();
    allocation_tick();
    return next_malloc != NULL ? next_malloc(size) : early_take(size);
}

void *calloc(size_t count, size_t size) {
    find_all();
    allocation_tick();
    return next_calloc != NULL ? next_calloc(count, size) : early_take(count * size);
}

void *realloc(void *place, size_t size) {
    find_all();
    allocation_tick();
    if (!is_early(place)) return next_realloc(place, size);
    void *moved = next_malloc(size);
    if (moved != NULL) memcpy(moved, place, size); /* reads on in `early`, never beyond it: it is the larger */
    return moved;
}

void *aligned_alloc(size_t alignment, size_t size) {
    find_all();
    allocation_tick();
    return next_aligned_alloc(alignment, size);
}

int posix_memalign(void **place, size_t alignment, size_t size) {
    find_all();
    allocation_tick();
    return next_posix_memalign(place, alignment, size);
}

void *mmap(void *address, size_t size, int protection, int flags, int file, off_t offset) {
    find_all();
    allocation_tick();
    return next_mmap(address, size, protection, flags, file, offset);
}

void free(void *place) {
    find_all();
    if (place == NULL || is_early(place)) return;
    allocation_tick();
    next_free(place);
}

static void allocations_watch(void) {
    find_all();
}

#endif

#endif
