/* The choice of the kernels. */
#include "kernels.h"

const struct ast_kernels *ast_kernels(void) {
#if AST_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return &ast_kernels_avx512;
    if (__builtin_cpu_supports("avx2")) return &ast_kernels_avx2;
#endif
    return &ast_kernels_plain;
}

const struct ast_kernels *ast_kernels_at(int index) {
    const struct ast_kernels *best = ast_kernels();
    const struct ast_kernels *const all[] = {
        &ast_kernels_plain,
#if AST_X86_KERNELS
        &ast_kernels_avx2,
        &ast_kernels_avx512,
#endif
    };
    const int count = (int)(sizeof all / sizeof all[0]);
    if (index < 0 || index >= count) return NULL;
    if (index > 0 && all[index - 1] == best) return NULL;
    return all[index];
}
