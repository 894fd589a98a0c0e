/* The loops that take the time. One C source (the *_kernel.h files), compiled once for each instruction set: the best that the
 * processor has is chosen at run time, so that a library built for any machine is fast on this one.
 *
 * Every kernel takes its sums in an order that its source fixes, whatever the width of a vector: all instruction sets give the same
 * bits. */
#ifndef AST_KERNELS_H
#define AST_KERNELS_H

#include <stddef.h>

#include "asttrack.h"
#include "build.h"
#include "real.h"

/* Whether this build has the x86 versions: they need nothing from the build but a compiler that can aim single files. Build with
 * AST_ONE_KERNEL to leave them out. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(AST_ONE_KERNEL) && AST_LANES == 16
#define AST_X86_KERNELS 1
#else
#define AST_X86_KERNELS 0
#endif

/* Elements of a panel at most. Summing so many at a time keeps the rounding error well below that of one long sum. */
enum { AST_PANEL_DEPTH = 64 };

/* For arrays of lanes outside the arena. */
#if defined(__GNUC__)
#define AST_LANES_ALIGNED __attribute__((aligned(64)))
#else
#define AST_LANES_ALIGNED
#endif

struct ast_axis;
struct ast_gradient;
struct ast_gram;
struct ast_gram_tile;
struct ast_gram_model;

/* Arrays of lanes hold AST_LANES numbers for each of their elements. */
struct ast_kernels {
    const char *name; /* of the instruction set */

    /* Interleaves depth elements of used <= AST_LANES columns of m (ld floats apart): panel[d * AST_LANES + l]. Unused lanes repeat
     * the first column. */
    void (*pack)(float *panel, const float *m, size_t ld, int used, int depth);
    /* sums[c * ld_sums + l] += sum over d < depth of panel[d * AST_LANES + l] * columns[c * ld + d], for c < count and every
     * lane. */
    void (*panel_product)(const float *panel, int depth, const float *columns, size_t ld, int count, float *sums, size_t ld_sums);

    /* x'y, in a fixed order: ast_dot. */
    ast_real (*dot)(const float *x, const float *y, int n);
    /* x[i] = e^x[i], for those whose result is a number. */
    void (*exponentials)(ast_real *x, int n);
    /* Takes the origin from `count` vectors, ld floats apart; square[i]: the squared length of what is left of vector i, as ast_dot
     * sums. */
    void (*depart)(float *vectors, size_t ld, int count, const float *origin, int n, ast_real *square);
    /* L^-1 applied to lanes of vectors of `size` floats, in place; L is row-major, its diagonal inverted. */
    void (*solve)(const float *factor, int size, float *vectors);
    /* Lanes of symmetric eigen-problems, n x n (column-major, the triangle i <= j at i * n + j; destroyed): values (n) descending,
     * vectors (n x n, as columns; NULL: not wanted). */
    void (*eigen)(int n, ast_real *a, ast_real *values, ast_real *vectors);
    /* The same without vectors, by the way that is fastest. spare: n + 1 lanes. */
    void (*eigenvalues)(int n, ast_real *a, ast_real *values, ast_real *spare);

    /* The weights of an axis for a window from `start` over `extent` pixels of a source. */
    void (*axis)(struct ast_axis *axis, float start, float extent, int source_length);
    /* count <= AST_RESAMPLER_ROWS rows of the grid, ld floats apart, from `row` on. */
    void (*rows)(const struct ast_axis *columns, const struct ast_axis *rows, const ast_frame *frame, int row, int count,
                 float *line, float *out, size_t ld);
    /* A patch from 0 .. 255 to its normalised form (AST_NORMALISE_*). */
    void (*normalise)(float *patch, int length, int normalisation);

    /* The maps of an image, for cells of about this size in it; NULL in a build with AST_NO_GRADIENT, as the next one. */
    void (*maps)(struct ast_gradient *g, const ast_frame *image, float cell_x, float cell_y);
    /* The cells of a window of the image whose maps g holds. */
    void (*cells)(const struct ast_gradient *g, const ast_box *window, float *out);

    /* The stages of the Gram scoring for the candidates of a tile (score_gram.c). */
    void (*project)(const struct ast_gram *s, struct ast_gram_tile *t);
    void (*decompose)(const struct ast_gram *s, struct ast_gram_tile *t);
    void (*pair)(const struct ast_gram *s, struct ast_gram_tile *t, const struct ast_gram_model *model, float *distance);
};

/* The best of this processor. */
const struct ast_kernels *ast_kernels(void);
/* All that this build has and this processor can run, the plain one first; NULL for an index past the last. */
const struct ast_kernels *ast_kernels_at(int index);

extern const struct ast_kernels ast_kernels_plain;
#if AST_X86_KERNELS
extern const struct ast_kernels ast_kernels_avx2;
extern const struct ast_kernels ast_kernels_avx512;
#endif

#endif
