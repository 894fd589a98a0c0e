/* Names of files and directories. */
#ifndef PATH_H
#define PATH_H

#include <stdbool.h>

/* "directory/name" in memory of its own (release with free), NULL when out of memory. */
char *path_join(const char *directory, const char *name);
/* The directory part of path ("." where it has none), in memory of its own. NULL when out of memory. */
char *path_directory(const char *path);
/* The absolute path without symbolic links, in memory of its own; NULL with errno set. */
char *path_resolve(const char *path);
/* The part after the last slash; points into path. */
const char *path_base(const char *path);
/* Whether the name ends in this extension (".jpg"), in any case. */
bool path_has_extension(const char *path, const char *extension);
bool path_is_directory(const char *path);
/* Both exist and are the same file or directory, whatever their names. */
bool path_same(const char *a, const char *b);
/* Makes one directory; fine where it exists already. False after reporting why not. */
bool path_make_directory(const char *path);

#endif
