/* The kernels for the processor that the whole library is compiled for; the only ones elsewhere than on x86. */
#define AST_KERNELS ast_kernels_plain
#define AST_KERNELS_NAME "plain"
#if defined(__GNUC__) && (defined(__SSE2__) || defined(__ARM_NEON))
#define AST_VECTOR_BYTES 16
#define AST_PANEL_VECTORS 4
#if defined(__aarch64__)
#define AST_PANEL_COLUMNS 6 /* 32 registers */
#else
#define AST_PANEL_COLUMNS 3 /* 16 registers */
#endif
#else
#define AST_VECTOR_BYTES 4
#define AST_PANEL_COLUMNS 4
#endif
#include "kernels_body.h"
