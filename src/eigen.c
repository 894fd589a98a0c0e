#include "eigen.h"

#include <stddef.h>

/* Rotates rows and columns p < q of a so that a[p, q] becomes zero. */
static void rotate(int n, ast_real *a, ast_real *vectors, int p, int q) {
    const ast_real cross = a[q * n + p];
    const ast_real zeta = (a[q * n + q] - a[p * n + p]) / (2 * cross);
    const ast_real t = (zeta < 0 ? -1 : 1) / (ast_fabs(zeta) + ast_sqrt(1 + zeta * zeta));
    const ast_real c = 1 / ast_sqrt(1 + t * t), s = c * t;

    a[p * n + p] -= t * cross;
    a[q * n + q] += t * cross;
    a[q * n + p] = a[p * n + q] = 0;
    for (int i = 0; i < n; i++) {
        if (i == p || i == q) continue;
        const ast_real x = a[p * n + i], y = a[q * n + i];
        a[p * n + i] = a[i * n + p] = c * x - s * y;
        a[q * n + i] = a[i * n + q] = s * x + c * y;
    }
    if (vectors == NULL) return;
    for (int i = 0; i < n; i++) {
        const ast_real x = vectors[p * n + i], y = vectors[q * n + i];
        vectors[p * n + i] = c * x - s * y;
        vectors[q * n + i] = s * x + c * y;
    }
}

void ast_eigen_symmetric(int n, ast_real *a, ast_real *values, ast_real *vectors) {
    enum { SWEEPS = 20 }; /* convergence is quadratic: 5 or 6 are needed */

    for (int i = 0; vectors != NULL && i < n * n; i++) vectors[i] = i % (n + 1) == 0 ? 1 : 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        int rotations = 0;
        for (int p = 0; p + 1 < n; p++) {
            for (int q = p + 1; q < n; q++) {
                /* Relative to both diagonals, so that small eigenvalues converge too; a semidefinite matrix is the rule here. */
                const ast_real cross = a[q * n + p];
                const ast_real bound = ast_real_epsilon() * ast_sqrt(ast_fabs(a[p * n + p]) * ast_fabs(a[q * n + q]));
                if (ast_fabs(cross) <= bound) continue;
                rotate(n, a, vectors, p, q);
                rotations++;
            }
        }
        if (rotations == 0) break;
    }

    for (int i = 0; i < n; i++) values[i] = a[i * n + i];
    for (int i = 0; i + 1 < n; i++) {
        int largest = i;
        for (int j = i + 1; j < n; j++)
            if (values[j] > values[largest]) largest = j;
        if (largest == i) continue;
        const ast_real keep = values[i];
        values[i] = values[largest];
        values[largest] = keep;
        for (int d = 0; vectors != NULL && d < n; d++) {
            const ast_real v = vectors[i * n + d];
            vectors[i * n + d] = vectors[largest * n + d];
            vectors[largest * n + d] = v;
        }
    }
}
