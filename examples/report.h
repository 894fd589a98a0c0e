/* Everything the command says on stderr: errors, notes and the progress line. */
#ifndef REPORT_H
#define REPORT_H

#include <stdint.h>

#if defined(__GNUC__)
#define REPORT_FORMAT __attribute__((format(printf, 1, 2)))
#else
#define REPORT_FORMAT
#endif

/* One line "asttrack: ...". Control characters (a file name may hold them) become '?', so it stays one line. */
void report_error(const char *format, ...) REPORT_FORMAT;

/* The progress line: redrawn in place at most ten times a second, and only where stderr is a terminal. */
void report_progress(const char *name, int32_t done, int32_t total, const char *state);
/* Removes the progress line, if one is drawn. */
void report_progress_end(void);

#endif
