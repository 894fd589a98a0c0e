/* realpath belongs to the X/Open part of POSIX */
#define _XOPEN_SOURCE 700

#include "path.h"

#include "report.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

char *path_join(const char *directory, const char *name) {
    const size_t directory_length = strlen(directory), name_length = strlen(name);
    const bool slash = directory_length > 0 && directory[directory_length - 1] == '/';
    char *joined = malloc(directory_length + name_length + 2);
    if (joined == NULL) return NULL;
    memcpy(joined, directory, directory_length);
    size_t at = directory_length;
    if (!slash) {
        joined[at++] = '/';
    }
    memcpy(joined + at, name, name_length + 1);
    return joined;
}

char *path_directory(const char *path) {
    const char *base = path_base(path);
    if (base == path) return strdup(".");
    size_t length = (size_t)(base - path);
    while (length > 1 && path[length - 1] == '/') {
        --length;
    }
    char *directory = malloc(length + 1);
    if (directory != NULL) {
        memcpy(directory, path, length);
        directory[length] = '\0';
    }
    return directory;
}

char *path_resolve(const char *path) {
    return realpath(path, NULL);
}

const char *path_base(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash == NULL ? path : slash + 1;
}

bool path_has_extension(const char *path, const char *extension) {
    const size_t path_length = strlen(path), extension_length = strlen(extension);
    if (path_length < extension_length) return false;
    const char *tail = path + (path_length - extension_length);
    for (size_t i = 0; i < extension_length; ++i) {
        if (tolower((unsigned char)tail[i]) != extension[i]) return false;
    }
    return true;
}

bool path_is_directory(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

bool path_same(const char *a, const char *b) {
    struct stat status_a, status_b;
    return stat(a, &status_a) == 0 && stat(b, &status_b) == 0 && status_a.st_dev == status_b.st_dev &&
           status_a.st_ino == status_b.st_ino;
}

bool path_make_directory(const char *path) {
    if (mkdir(path, 0777) == 0) return true;
    int cause = errno;
    if (cause == EEXIST) {
        if (path_is_directory(path)) return true;
        cause = ENOTDIR;
    }
    report_error("%s: cannot make the directory: %s", path, strerror(cause));
    return false;
}
