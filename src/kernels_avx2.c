/* The kernels for x86 processors with AVX2. */
#include "kernels.h"

#if AST_X86_KERNELS
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#include <immintrin.h>
#define AST_EIGHT_NUMBERS(bytes) _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)(bytes))))
#define AST_KERNELS ast_kernels_avx2
#define AST_KERNELS_NAME "AVX2"
#define AST_VECTOR_BYTES 32
#define AST_PANEL_VECTORS 2
#define AST_PANEL_COLUMNS 6
#include "kernels_body.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int ast_no_avx2_kernels;
#endif
