/* The kernels of every instruction set that this processor has give the same bits as the plain ones, and those what they promise. */
#include "kernels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support_noise.h"
#include "unity.h"

void setUp(void) {
}
void tearDown(void) {
}

static char label[160];

static void test_the_best_is_the_last_and_the_plain_the_first(void) {
    int count = 0;
    TEST_ASSERT_EQUAL_PTR(&ast_kernels_plain, ast_kernels_at(0));
    TEST_ASSERT_NULL(ast_kernels_at(-1));
    while (ast_kernels_at(count) != NULL) count++;
    TEST_ASSERT_EQUAL_PTR(ast_kernels(), ast_kernels_at(count - 1));
    TEST_ASSERT_NULL(ast_kernels_at(count + 5));
    printf("kernels here:");
    for (int i = 0; i < count; i++) printf(" %s", ast_kernels_at(i)->name);
    printf("\n");
#if AST_X86_KERNELS
    if (__builtin_cpu_supports("avx2")) TEST_ASSERT_GREATER_THAN_INT(1, count);
#endif
}

/* ---- Panels ---- */

enum { MOST_COLUMNS = 40, LD = AST_PANEL_DEPTH + 3, LD_SUMS = AST_LANES + 5 };

static void test_packing_interleaves_columns(void) {
    static float m[AST_LANES * LD], panel[AST_PANEL_DEPTH * AST_LANES + 1];
    struct noise noise = {1};
    noise_fill(&noise, m, sizeof m / sizeof *m, -1, 1);
    for (int i = 0; ast_kernels_at(i) != NULL; i++) {
        for (int depth = 1; depth <= AST_PANEL_DEPTH; depth++) {
            for (int used = 1; used <= AST_LANES; used++) {
                panel[depth * AST_LANES] = 42.0f;
                ast_kernels_at(i)->pack(panel, m, LD, used, depth);
                for (int d = 0; d < depth; d++)
                    for (int l = 0; l < AST_LANES; l++)
                        TEST_ASSERT_TRUE(panel[d * AST_LANES + l] == m[(l < used ? l : 0) * LD + d]);
                TEST_ASSERT_EQUAL_FLOAT(42.0f, panel[depth * AST_LANES]);
            }
        }
    }
}

static void test_a_panel_product_is_the_sums_in_order_on_every_instruction_set(void) {
    static float panel[AST_PANEL_DEPTH * AST_LANES], columns[MOST_COLUMNS * LD], sums[(MOST_COLUMNS + 1) * LD_SUMS];
    struct noise noise = {2};
    noise_fill(&noise, panel, sizeof panel / sizeof *panel, -1, 1);
    noise_fill(&noise, columns, sizeof columns / sizeof *columns, -1, 1);
    const int depths[] = {1, 2, 3, 17, AST_PANEL_DEPTH - 1, AST_PANEL_DEPTH};
    for (int i = 0; ast_kernels_at(i) != NULL; i++) {
        for (int k = 0; k < (int)(sizeof depths / sizeof depths[0]); k++) {
            for (int count = 1; count <= MOST_COLUMNS; count++) {
                const int depth = depths[k];
                for (int e = 0; e < (MOST_COLUMNS + 1) * LD_SUMS; e++) sums[e] = (float)(e % 7);
                ast_kernels_at(i)->panel_product(panel, depth, columns, LD, count, sums, LD_SUMS);
                snprintf(label, sizeof label, "%s, depth %d, %d columns", ast_kernels_at(i)->name, depth, count);
                for (int e = 0; e < (MOST_COLUMNS + 1) * LD_SUMS; e++) {
                    const int c = e / LD_SUMS, l = e % LD_SUMS;
                    volatile float sum = 0.0f; /* volatile: rounded to float at every step */
                    for (int d = 0; c < count && l < AST_LANES && d < depth; d++) {
                        const volatile float term = panel[d * AST_LANES + l] * columns[c * LD + d];
                        sum += term;
                    }
                    const volatile float wanted = (float)(e % 7) + sum;
                    TEST_ASSERT_TRUE_MESSAGE(sums[e] == wanted, label);
                }
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_the_best_is_the_last_and_the_plain_the_first);
    RUN_TEST(test_packing_interleaves_columns);
    RUN_TEST(test_a_panel_product_is_the_sums_in_order_on_every_instruction_set);
    return UNITY_END();
}
