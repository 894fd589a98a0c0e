/* The words for a tracker's status, as the CSV, the pictures and the progress line use them. */
#ifndef STATUS_H
#define STATUS_H

#include <stdint.h>

/* "tracking", "uncertain" or "lost" for AST_TRACKING, AST_UNCERTAIN and AST_LOST. */
const char *status_name(int32_t status);

#endif
