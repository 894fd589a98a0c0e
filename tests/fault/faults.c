/* Faults on demand, linked in front of the command for tests: the k-th call of a kind fails, as AST_FAULT=KIND:K asks, and at the
 * end a line in the file AST_FAULT_REPORT says how many calls there were. Kinds: allocation, open, write, close, rename, read;
 * "short:1" makes every read and write move one byte, or as few as there may be.
 *
 * The linker sends the command's own calls here (--wrap). Allocations are taken over for the whole process, those of libjpeg and of
 * the C library included, but for a sanitizer's builds, whose allocator must stay: there, too, it is the command's own calls. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum kind { ALLOCATION, OPEN, WRITE, CLOSE, RENAME, READ, SHORT, KINDS };

static const char *const names[KINDS] = {"allocation", "open", "write", "close", "rename", "read", "short"};
static long calls[KINDS], failing[KINDS]; /* 0: none fails */
static int armed;                         /* after the libraries have begun, which is not the command's concern */

/* Counts a call; whether it is the one that fails. */
static int fails(enum kind kind) {
    return armed && ++calls[kind] == failing[kind];
}

__attribute__((constructor)) static void arm(void) {
    const char *fault = getenv("AST_FAULT"), *colon = fault != NULL ? strchr(fault, ':') : NULL;
    for (int kind = 0; kind < KINDS && colon != NULL; kind++)
        if (strlen(names[kind]) == (size_t)(colon - fault) && memcmp(names[kind], fault, (size_t)(colon - fault)) == 0)
            failing[kind] = strtol(colon + 1, NULL, 10);
    armed = 1;
}

int __real_open(const char *path, int flags, ...);
ssize_t __real_write(int file, const void *bytes, size_t count);

__attribute__((destructor)) static void tell(void) {
    char line[256];
    int used = 0;
    armed = 0;
    const char *path = getenv("AST_FAULT_REPORT");
    if (path == NULL) return;
    for (int kind = 0; kind < KINDS; kind++)
        used += snprintf(line + used, sizeof line - (size_t)used, "%s=%ld\n", names[kind], calls[kind]);
    const int file = __real_open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0) (void)!__real_write(file, line, (size_t)used);
}

/* ---- Files ---- */

int __real_close(int file);
int __real_rename(const char *from, const char *to);
size_t __real_fread(void *place, size_t size, size_t count, FILE *stream);
FILE *__real_fopen(const char *path, const char *mode);
int __real_ferror(FILE *stream);

static int broken_stream; /* the last fread failed */

int __wrap_open(const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const unsigned mode = flags & O_CREAT ? va_arg(arguments, unsigned) : 0;
    va_end(arguments);
    if (fails(OPEN)) return errno = EMFILE, -1;
    return __real_open(path, flags, mode);
}

FILE *__wrap_fopen(const char *path, const char *mode) {
    if (fails(OPEN)) return errno = EMFILE, NULL;
    return __real_fopen(path, mode);
}

ssize_t __wrap_write(int file, const void *bytes, size_t count) {
    if (fails(WRITE)) return errno = ENOSPC, -1;
    return __real_write(file, bytes, failing[SHORT] && count > 4096 ? 4096 : failing[SHORT] && count > 1 ? 1 + count / 3 : count);
}

int __wrap_close(int file) {
    const int outcome = __real_close(file);
    if (fails(CLOSE)) return errno = EIO, -1;
    return outcome;
}

int __wrap_rename(const char *from, const char *to) {
    if (fails(RENAME)) return errno = EACCES, -1;
    return __real_rename(from, to);
}

size_t __wrap_fread(void *place, size_t size, size_t count, FILE *stream) {
    if (fails(READ)) {
        broken_stream = 1;
        return errno = EIO, 0;
    }
    return __real_fread(place, size, failing[SHORT] && count > 100 ? 100 : count, stream);
}

int __wrap_ferror(FILE *stream) {
    if (!broken_stream) return __real_ferror(stream);
    broken_stream = 0;
    errno = EIO;
    return 1;
}

/* ---- Memory ---- */

#ifdef FAULT_WRAPS_ALLOCATION

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *place, size_t size);
#define malloc __wrap_malloc
#define calloc __wrap_calloc
#define realloc __wrap_realloc

#else

/* The C library's own, under names that it keeps for those who take malloc over. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *place, size_t size);
#define __real_malloc __libc_malloc
#define __real_calloc __libc_calloc
#define __real_realloc __libc_realloc

#endif

void *malloc(size_t size) {
    if (fails(ALLOCATION)) return errno = ENOMEM, NULL;
    return __real_malloc(size);
}

void *calloc(size_t count, size_t size) {
    if (fails(ALLOCATION)) return errno = ENOMEM, NULL;
    return __real_calloc(count, size);
}

void *realloc(void *place, size_t size) {
    if (fails(ALLOCATION)) return errno = ENOMEM, NULL;
    return __real_realloc(place, size);
}
