/* The bytes that drive a harness, taken one after the other; behind the last one there are zeros. */
#ifndef FUZZ_BYTES_H
#define FUZZ_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* libFuzzer's entry, which replay.c calls too. Returns 0, or -1 for an input that is not worth keeping. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A promise that must hold whatever the bytes are: the program ends where it does not. */
#define REQUIRE(condition)                                                                                                         \
    do {                                                                                                                           \
        if (!(condition)) {                                                                                                        \
            printf("%s:%d: broken: %s\n", __FILE__, __LINE__, #condition);                                                         \
            (void)fflush(stdout);                                                                                                  \
            abort();                                                                                                               \
        }                                                                                                                          \
    } while (0)

struct bytes {
    const uint8_t *at, *end;
};

static inline size_t bytes_left(const struct bytes *b) {
    return (size_t)(b->end - b->at);
}

static inline uint8_t bytes_u8(struct bytes *b) {
    return b->at < b->end ? *b->at++ : 0;
}

static inline uint16_t bytes_u16(struct bytes *b) {
    const unsigned low = bytes_u8(b);
    return (uint16_t)(low | (unsigned)bytes_u8(b) << 8);
}

static inline uint32_t bytes_u32(struct bytes *b) {
    const uint32_t low = bytes_u16(b);
    return low | (uint32_t)bytes_u16(b) << 16;
}

/* Any bit pattern: NaN, infinities and denormal numbers too. */
static inline float bytes_float(struct bytes *b) {
    const uint32_t word = bytes_u32(b);
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* Memory of exactly this size, so that a sanitizer sees the first byte beyond it. Ends the program when there is none. */
static inline void *exactly(size_t size) {
    void *block = malloc(size > 0 ? size : 1);
    REQUIRE(block != NULL);
    return block;
}

#endif
