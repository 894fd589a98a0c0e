#include "report.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static bool progress_drawn;         /* the cursor stands on a progress line */
static struct timespec progress_at; /* when it was drawn last */

void report_progress_end(void) {
    if (progress_drawn) {
        /* carriage return, then "erase to the end of the line" */
        fputs("\r\033[K", stderr);
        fflush(stderr);
        progress_drawn = false;
    }
}

void report_error(const char *format, ...) {
    char line[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    for (char *c = line; *c != '\0'; ++c) {
        if ((unsigned char)*c < 0x20 || *c == 0x7f) {
            *c = '?';
        }
    }
    report_progress_end();
    fflush(stdout);
    fprintf(stderr, "asttrack: %s\n", line);
}

void report_progress(const char *name, int32_t done, int32_t total, const char *state) {
    struct timespec now;
    if (!isatty(STDERR_FILENO) || clock_gettime(CLOCK_MONOTONIC, &now) != 0) return;
    const double since = (double)(now.tv_sec - progress_at.tv_sec) + 1e-9 * (double)(now.tv_nsec - progress_at.tv_nsec);
    if (progress_drawn && since < 0.1 && done < total) return;
    fprintf(stderr, "\r\033[K%.40s %d/%d %d%% %s", name, (int)done, (int)total, (int)(100 * (int64_t)done / total), state);
    fflush(stderr);
    progress_drawn = true;
    progress_at = now;
}
