/* Instructions that functions execute, callees included, as valgrind's tool callgrind counts them. */
#ifndef CALLGRIND_H
#define CALLGRIND_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct callgrind_count {
    const char *function; /* its name in the program */
    uint64_t instructions;
};

/* Whether there is a valgrind to call. */
bool callgrind_available(void);
/* Runs "program verb argument" under callgrind, which collects inside the function `within` only; its profile goes to the file
 * `profile`. False when the program or valgrind fails. */
bool callgrind_run(const char *program, const char *verb, const char *argument, const char *within, const char *profile);
/* Adds up, from a profile, the instructions of all calls of each function. False when the text is not a profile. */
bool callgrind_read(FILE *profile, struct callgrind_count *counts, int count);

#endif
