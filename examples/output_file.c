#include "output_file.h"

#include "path.h"
#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Names to try beside the target when a stale temporary file of an equal process number is in the way. */
#define TEMPORARY_NAMES 16

/* Whatever is left is closed, removed and released. */
void output_discard(output_file *output) {
    if (output->stream != NULL) {
        (void)fclose(output->stream);
        if (output->descriptor >= 0) (void)close(output->descriptor);
    }
    if (output->temporary != NULL) (void)unlink(output->temporary);
    free(output->bytes);
    free(output->path);
    free(output->target);
    free(output->temporary);
    memset(output, 0, sizeof *output);
}

static bool fail(output_file *output, int cause) {
    report_error("%s: cannot write: %s", output->path != NULL ? output->path : "output", strerror(cause));
    output_discard(output);
    return false;
}

/* The standard stream that writes to this file, or -1: `--csv /dev/stdout > file` must not rename over that file, nor overwrite
 * what the stream has written there. */
static int standard_stream(const struct stat *target) {
    for (int descriptor = STDOUT_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        struct stat stream;
        if (fstat(descriptor, &stream) == 0 && stream.st_dev == target->st_dev && stream.st_ino == target->st_ino) {
            return descriptor;
        }
    }
    return -1;
}

/* A new file beside the target; its descriptor, or -1 with errno set. */
static int open_temporary(output_file *output, mode_t mode) {
    const size_t size = strlen(output->target) + 40;
    output->temporary = malloc(size);
    if (output->temporary == NULL) {
        errno = ENOMEM;
        return -1;
    }
    int descriptor = -1;
    for (int i = 0; i < TEMPORARY_NAMES; ++i) {
        snprintf(output->temporary, size, "%s.tmp%ld.%d", output->target, (long)getpid(), i);
        descriptor = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL, mode);
        if (descriptor >= 0 || errno != EEXIST) break;
    }
    if (descriptor < 0) {
        const int cause = errno;
        free(output->temporary); /* not ours to remove */
        output->temporary = NULL;
        errno = cause;
    }
    return descriptor;
}

/* Opens the file on disk; its descriptor, or -1 with errno set. */
static int open_target(output_file *output) {
    struct stat status;
    if (stat(output->path, &status) != 0) {
        /* a link to nothing, such as /dev/stdout with that stream closed, must not be replaced either */
        if (lstat(output->path, &status) == 0) return -1;
        output->target = strdup(output->path);
        return output->target != NULL ? open_temporary(output, 0666) : -1;
    }
    const int standard = standard_stream(&status);
    if (standard >= 0) return dup(standard);
    if (!S_ISREG(status.st_mode)) return open(output->path, O_WRONLY);
    output->target = path_resolve(output->path);
    /* a rename would go through where the file itself is write-protected */
    if (output->target == NULL || access(output->target, W_OK) != 0) return -1;
    return open_temporary(output, status.st_mode & 0777);
}

bool output_open(output_file *output, const char *path) {
    memset(output, 0, sizeof *output);
    output->descriptor = -1;
    output->path = strdup(path);
    output->stream = open_memstream(&output->bytes, &output->size);
    if (output->path == NULL || output->stream == NULL) return fail(output, ENOMEM);
    output->descriptor = open_target(output);
    return output->descriptor >= 0 || fail(output, errno);
}

void output_print(output_file *output, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    output->lost = vfprintf(output->stream, format, arguments) < 0 || output->lost;
    va_end(arguments);
}

void output_bytes(output_file *output, const void *bytes, size_t size) {
    output->lost = fwrite(bytes, 1, size, output->stream) != size || output->lost;
}

/* 0, or errno. */
static int write_all(int descriptor, const char *bytes, size_t size) {
    while (size > 0) {
        const ssize_t written = write(descriptor, bytes, size);
        if (written < 0 && errno != EINTR) return errno;
        if (written > 0) {
            bytes += written;
            size -= (size_t)written;
        }
    }
    return 0;
}

bool output_commit(output_file *output) {
    if (fflush(output->stream) != 0 || ferror(output->stream) || output->lost) return fail(output, ENOMEM);
    int cause = write_all(output->descriptor, output->bytes, output->size);
    if (close(output->descriptor) != 0 && cause == 0) cause = errno;
    output->descriptor = -1;
    if (cause != 0) return fail(output, cause);
    if (output->temporary != NULL) {
        if (rename(output->temporary, output->target) != 0) return fail(output, errno);
        free(output->temporary); /* it is the target now */
        output->temporary = NULL;
    }
    output_discard(output);
    return true;
}
