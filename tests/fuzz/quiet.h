/* Keeps what the command says on stderr out of a fuzzer's way: a million error lines are no help. Reports of sanitizers and of
 * libFuzzer, which do not go through the stream, still show. */
#ifndef FUZZ_QUIET_H
#define FUZZ_QUIET_H

#include <stdio.h>

static inline void be_quiet(void) {
    static FILE *nowhere;
    if (nowhere == NULL) nowhere = fopen("/dev/null", "w");
    if (nowhere != NULL) stderr = nowhere;
}

#endif
