/* The kernels for x86 processors with AVX-512. */
#include "kernels.h"

#if AST_X86_KERNELS
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512bw,avx512vl"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512bw,avx512vl,prefer-vector-width=512")
#endif
#include <immintrin.h>
#define AST_EIGHT_NUMBERS(bytes) _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)(bytes))))
#define AST_SIXTEEN_NUMBERS(bytes) _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)(const void *)(bytes))))
#define AST_EIGHT_DOUBLES(numbers) _mm512_cvtps_pd((__m256)(numbers))
#define AST_KERNELS ast_kernels_avx512
#define AST_KERNELS_NAME "AVX-512"
#define AST_VECTOR_BYTES 64
#define AST_PANEL_VECTORS 1
#define AST_PANEL_COLUMNS 12
#include "kernels_body.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int ast_no_avx512_kernels;
#endif
