#include "sequence.h"

#include "path.h"
#include "report.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- Names in natural order ---- */

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Compares two names; runs of digits compare as numbers of any length, with leading zeros of no account, all else byte by byte. The
 * extension is left out: 7.pgm and 07.jpg are the same frame twice. The Python package has the same rule (natural_order.py). */
static int compare_natural(const char *a, const char *b) {
    const char *end_a = strrchr(a, '.'), *end_b = strrchr(b, '.');
    while (a < end_a && b < end_b) {
        if (is_digit(*a) && is_digit(*b)) {
            a += strspn(a, "0");
            b += strspn(b, "0");
            const size_t digits_a = strspn(a, "0123456789"), digits_b = strspn(b, "0123456789");
            if (digits_a != digits_b) return digits_a < digits_b ? -1 : 1;
            const int order = memcmp(a, b, digits_a);
            if (order != 0) return order;
            a += digits_a;
            b += digits_b;
        } else if (*a != *b) {
            return (unsigned char)*a < (unsigned char)*b ? -1 : 1;
        } else {
            ++a;
            ++b;
        }
    }
    return (a < end_a) - (b < end_b);
}

static int compare_names(const void *a, const void *b) {
    const char *name_a = *(char *const *)a, *name_b = *(char *const *)b;
    const int order = compare_natural(name_a, name_b);
    return order != 0 ? order : strcmp(name_a, name_b);
}

static bool is_numbered_frame(const char *name) {
    static const char *const extensions[] = {".pgm", ".ppm", ".jpg", ".jpeg"};
    const char *dot = strrchr(name, '.');
    if (name[0] == '.' || dot == NULL || dot == name || !is_digit(dot[-1])) return false;
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; ++i) {
        if (path_has_extension(name, extensions[i])) return true;
    }
    return false;
}

void sequence_free_names(char **names, int32_t count) {
    for (int32_t i = 0; i < count; ++i) {
        free(names[i]);
    }
    free(names);
}

/* Adds a copy of name; false when out of memory. */
static bool append(char ***names, int32_t *count, int32_t *capacity, const char *name) {
    if (*count == *capacity) {
        const int32_t larger = *capacity == 0 ? 256 : 2 * *capacity;
        char **more = larger > 0 ? realloc(*names, (size_t)larger * sizeof *more) : NULL;
        if (more == NULL) return false;
        *names = more;
        *capacity = larger;
    }
    char *copy = strdup(name);
    if (copy == NULL) return false;
    (*names)[(*count)++] = copy;
    return true;
}

static bool read_directory(DIR *stream, const char *directory, char ***names, int32_t *count) {
    int32_t capacity = 0;
    for (;;) {
        errno = 0;
        const struct dirent *entry = readdir(stream);
        if (entry == NULL) {
            if (errno != 0) {
                report_error("%s: cannot read the directory: %s", directory, strerror(errno));
            }
            return errno == 0;
        }
        if (is_numbered_frame(entry->d_name) && !append(names, count, &capacity, entry->d_name)) {
            report_error("%s: out of memory", directory);
            return false;
        }
    }
}

bool sequence_list(const char *directory, char ***names, int32_t *count) {
    *names = NULL;
    *count = 0;
    DIR *stream = opendir(directory);
    if (stream == NULL) {
        report_error("%s: cannot open the directory: %s", directory, strerror(errno));
        return false;
    }
    bool good = read_directory(stream, directory, names, count);
    (void)closedir(stream);
    if (good && *count > 0) {
        qsort(*names, (size_t)*count, sizeof **names, compare_names);
    }
    for (int32_t i = 1; i < *count && good; ++i) {
        if (compare_natural((*names)[i - 1], (*names)[i]) == 0) {
            report_error("%s: %s and %s have the same number", directory, (*names)[i - 1], (*names)[i]);
            good = false;
        }
    }
    if (!good) {
        sequence_free_names(*names, *count);
        *names = NULL;
        *count = 0;
    }
    return good;
}

/* ---- Sequences ---- */

static bool out_of_memory(const char *path) {
    report_error("%s: out of memory", path);
    return false;
}

/* The base name of what path resolves to ("." and links included), as one word. */
static bool name_after(sequence *s, const char *path) {
    char *resolved = path_resolve(path);
    if (resolved == NULL) {
        report_error("%s: cannot open: %s", path, strerror(errno));
        return false;
    }
    const char *base = path_base(resolved);
    s->name = strdup(base[0] != '\0' ? base : "root");
    free(resolved);
    if (s->name == NULL) return out_of_memory(path);
    for (char *c = s->name; *c != '\0'; ++c) {
        if (isspace((unsigned char)*c) || iscntrl((unsigned char)*c)) {
            *c = '_';
        }
    }
    return true;
}

/* Whether the directory's own sub-directory `img` holds the frames. */
static bool list_frames(const char *directory, char **frames_directory, char ***names, int32_t *count) {
    char *sub_directory = path_join(directory, "img");
    if (sub_directory == NULL) return out_of_memory(directory);
    *names = NULL;
    *count = 0;
    bool good = !path_is_directory(sub_directory) || sequence_list(sub_directory, names, count);
    if (good && *count > 0) {
        *frames_directory = sub_directory;
        return true;
    }
    free(sub_directory);
    if (!good || !sequence_list(directory, names, count)) return false;
    if (*count == 0) {
        report_error("%s: no numbered .pgm, .ppm, .jpg or .jpeg frames there or in its img/", directory);
        return false;
    }
    *frames_directory = strdup(directory);
    if (*frames_directory == NULL) {
        sequence_free_names(*names, *count);
        return out_of_memory(directory);
    }
    return true;
}

static bool open_truth(sequence *s, const char *directory) {
    static const char *const names[] = {"groundtruth.txt", "groundtruth_rect.txt"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        struct stat status;
        char *path = path_join(directory, names[i]);
        if (path == NULL) return out_of_memory(directory);
        if (stat(path, &status) == 0) {
            s->truth_path = path;
            return truth_read(&s->annotations, path);
        }
        free(path);
    }
    return true;
}

static bool open_directory(sequence *s, const char *directory) {
    char *frames_directory = NULL, **names = NULL;
    int32_t count = 0;
    if (!name_after(s, directory) || !list_frames(directory, &frames_directory, &names, &count)) return false;
    s->frames = calloc((size_t)count, sizeof *s->frames);
    bool good = s->frames != NULL;
    for (int32_t i = 0; i < count && good; ++i) {
        s->frames[i] = path_join(frames_directory, names[i]);
        good = s->frames[i] != NULL;
        s->count += good ? 1 : 0;
    }
    sequence_free_names(names, count);
    free(frames_directory);
    return good ? open_truth(s, directory) : out_of_memory(directory);
}

/* Files are named after their directory, or after the one above it where that is called `img`. */
static bool name_after_file(sequence *s, const char *path) {
    char *directory = path_directory(path);
    if (directory == NULL) return out_of_memory(path);
    bool good = name_after(s, directory);
    if (good && strcmp(s->name, "img") == 0) {
        char *above = path_join(directory, "..");
        free(s->name);
        s->name = NULL;
        good = above != NULL ? name_after(s, above) : out_of_memory(path);
        free(above);
    }
    free(directory);
    return good;
}

static bool open_files(sequence *s, char **files, int count) {
    if (!name_after_file(s, files[0])) return false;
    s->frames = calloc((size_t)count, sizeof *s->frames);
    if (s->frames == NULL) return out_of_memory(files[0]);
    for (int i = 0; i < count; ++i) {
        if (path_is_directory(files[i])) {
            report_error("%s: a directory among files: give one directory, or files only", files[i]);
            return false;
        }
        s->frames[i] = strdup(files[i]);
        if (s->frames[i] == NULL) return out_of_memory(files[i]);
        s->count += 1;
    }
    return true;
}

bool sequence_open(sequence *s, char **inputs, int count) {
    struct stat status;
    memset(s, 0, sizeof *s);
    /* among several files a missing one is a frame to skip; alone it is the whole sequence */
    if (count == 1 && stat(inputs[0], &status) != 0) {
        report_error("%s: cannot open: %s", inputs[0], strerror(errno));
        return false;
    }
    const bool good = count == 1 && path_is_directory(inputs[0]) ? open_directory(s, inputs[0]) : open_files(s, inputs, count);
    if (!good) {
        sequence_close(s);
    }
    return good;
}

void sequence_close(sequence *s) {
    sequence_free_names(s->frames, s->count);
    truth_free(&s->annotations);
    free(s->truth_path);
    free(s->name);
    memset(s, 0, sizeof *s);
}
