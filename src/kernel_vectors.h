/* Vectors of the compiler's own making (GNU C), as wide as the file that includes this says (AST_VECTOR_BYTES): no instruction is
 * named. Without them a vector is one number, and every sum has the same order. */
#ifndef AST_KERNEL_VECTORS_H
#define AST_KERNEL_VECTORS_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "real.h"

#if defined(__GNUC__)
#define AST_ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define AST_ALWAYS_INLINE static inline
#endif
#if AST_VECTOR_BYTES > 4
#define AST_HAS_VECTORS 1
/* At any address. */
typedef float vector __attribute__((vector_size(AST_VECTOR_BYTES), aligned(4), may_alias));
typedef float four __attribute__((vector_size(16), aligned(4), may_alias));
#else
#define AST_HAS_VECTORS 0
typedef float vector;
#endif
enum { WIDTH = AST_VECTOR_BYTES / (int)sizeof(float) };

#if AST_HAS_VECTORS
/* Four times four numbers, transposed: element i of a, b, c and d to out + i * step. */
AST_ALWAYS_INLINE void transpose_four(const float *a, const float *b, const float *c, const float *d, float *out, size_t step) {
    const four x = *(const four *)a, y = *(const four *)b, z = *(const four *)c, w = *(const four *)d;
#if defined(__clang__) || __GNUC__ >= 12
    const four low_x = __builtin_shufflevector(x, z, 0, 4, 1, 5), low_y = __builtin_shufflevector(y, w, 0, 4, 1, 5);
    const four high_x = __builtin_shufflevector(x, z, 2, 6, 3, 7), high_y = __builtin_shufflevector(y, w, 2, 6, 3, 7);
    *(four *)out = __builtin_shufflevector(low_x, low_y, 0, 4, 1, 5);
    *(four *)(out + step) = __builtin_shufflevector(low_x, low_y, 2, 6, 3, 7);
    *(four *)(out + 2 * step) = __builtin_shufflevector(high_x, high_y, 0, 4, 1, 5);
    *(four *)(out + 3 * step) = __builtin_shufflevector(high_x, high_y, 2, 6, 3, 7);
#else
    *(four *)out = (four){x[0], y[0], z[0], w[0]};
    *(four *)(out + step) = (four){x[1], y[1], z[1], w[1]};
    *(four *)(out + 2 * step) = (four){x[2], y[2], z[2], w[2]};
    *(four *)(out + 3 * step) = (four){x[3], y[3], z[3], w[3]};
#endif
}
#endif

#if AST_HAS_VECTORS
/* Bytes become numbers twice as wide in each step, which is what processors have instructions for; where one does more at once and
 * the compiler does not see it, the file that includes this names it (AST_EIGHT_NUMBERS, AST_SIXTEEN_NUMBERS, AST_EIGHT_DOUBLES).
 * Passed by address: how vectors wider than the processor's are returned differs from one to the next. */
typedef uint8_t eight_bytes __attribute__((vector_size(8), aligned(1), may_alias));
typedef uint16_t eight_halves __attribute__((vector_size(16)));
typedef int32_t four_words __attribute__((vector_size(16)));
typedef int32_t eight_words __attribute__((vector_size(32)));
typedef float eight __attribute__((vector_size(32), aligned(4), may_alias));
typedef uint8_t sixteen_bytes __attribute__((vector_size(16), aligned(1), may_alias));
typedef uint16_t sixteen_halves __attribute__((vector_size(32)));
#ifdef AST_EIGHT_NUMBERS
#define EIGHT_NUMBERS(bytes) ((eight)AST_EIGHT_NUMBERS(bytes))
#else
#define EIGHT_NUMBERS(bytes)                                                                                                       \
    __builtin_convertvector(                                                                                                       \
        __builtin_convertvector(__builtin_convertvector(*(const eight_bytes *)(bytes), eight_halves), eight_words), eight)
#endif
typedef uint32_t sixteen_counts __attribute__((vector_size(64), aligned(4), may_alias));
#define SIXTEEN_COUNTS(bytes)                                                                                                      \
    __builtin_convertvector(__builtin_convertvector(*(const sixteen_bytes *)(bytes), sixteen_halves), sixteen_counts)

/* Eight sums of squares side by side, in the order of ast_dot. */
enum {
    SQUARES = 8,
    REALS = AST_VECTOR_BYTES / (int)sizeof(ast_real) < SQUARES ? AST_VECTOR_BYTES / (int)sizeof(ast_real) : SQUARES
};
typedef ast_real reals __attribute__((vector_size(REALS * sizeof(ast_real))));
typedef float as_many __attribute__((vector_size(REALS * sizeof(float)), aligned(4), may_alias));
#if defined(AST_EIGHT_DOUBLES) && AST_REAL_IS_DOUBLE
#define AS_REALS(numbers) ((reals)AST_EIGHT_DOUBLES(numbers))
#else
#define AS_REALS(numbers) __builtin_convertvector(numbers, reals)
#endif
AST_ALWAYS_INLINE void add_squares(const float *x, reals *sum) {
    for (int v = 0; v < SQUARES / REALS; v++) {
        const reals wide = AS_REALS(*(const as_many *)(x + v * REALS));
        sum[v] += wide * wide;
    }
}

/* Sixteen bytes as numbers, in vectors of the processor's own width: compilers keep wider ones in memory. */
AST_ALWAYS_INLINE void widen_sixteen(const uint8_t *bytes, vector *numbers) {
#if defined(AST_SIXTEEN_NUMBERS)
    numbers[0] = (vector)AST_SIXTEEN_NUMBERS(bytes);
#elif defined(AST_EIGHT_NUMBERS)
    numbers[0] = (vector)AST_EIGHT_NUMBERS(bytes);
    numbers[1] = (vector)AST_EIGHT_NUMBERS(bytes + 8);
#else
    for (int v = 0; v < 16 / WIDTH; v += 2) {
        const eight_words words =
            __builtin_convertvector(__builtin_convertvector(*(const eight_bytes *)(bytes + v * WIDTH), eight_halves), eight_words);
        four_words half[2];
        memcpy(half, &words, sizeof half);
        numbers[v] = __builtin_convertvector(half[0], vector);
        numbers[v + 1] = __builtin_convertvector(half[1], vector);
    }
#endif
}
#endif

#endif
