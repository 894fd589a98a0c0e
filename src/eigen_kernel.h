/* Symmetric eigen-problems, one in each lane. A lane's result does not depend on the others'. */
#include "maths_lanes.h"
#include "real.h"

/* Element (i, j) of a symmetric n x n matrix, of which the triangle i <= j is kept. */
#define AT(i, j) ((size_t)((i) < (j) ? (i)*n + (j) : (j)*n + (i)) * AST_LANES)

/* Rotates rows and columns p < q of every matrix so that element (p, q) becomes zero; returns how many lanes still had one. */
static int rotate_lanes(int n, ast_real *restrict a, ast_real *restrict vectors, int p, int q) {
    ast_real tangent[AST_LANES], cosine[AST_LANES], sine[AST_LANES];
    int rotations = 0;
    ast_real *pp = a + AT(p, p), *qq = a + AT(q, q), *pq = a + AT(p, q);
    for (int l = 0; l < AST_LANES; l++) {
        const ast_real cross = pq[l], apart = qq[l] - pp[l];
        /* Relative to both diagonals, so that small eigenvalues converge too; a semidefinite matrix is the rule here. */
        const ast_real bound = ast_real_epsilon() * ast_sqrt(ast_fabs(pp[l]) * ast_fabs(qq[l]));
        const int active = ast_fabs(cross) > bound;
        const ast_real sum = ast_fabs(apart) + ast_sqrt(apart * apart + 4 * (cross * cross));
        const ast_real quotient = 2 * cross / (sum > 0 ? sum : 1);
        const ast_real t = sum > 0 ? (apart < 0 ? -quotient : quotient) : 1; /* 1: both squares are below the least number */
        tangent[l] = active ? t : 0;
        rotations += active;
    }
    if (rotations == 0) return 0;
    for (int l = 0; l < AST_LANES; l++) {
        const ast_real t = tangent[l], c = 1 / ast_sqrt(1 + t * t), change = t * pq[l];
        cosine[l] = c;
        sine[l] = c * t;
        pp[l] -= change;
        qq[l] += change;
        pq[l] = t != 0 ? 0 : pq[l];
    }
    for (int i = 0; i < n; i++) {
        if (i == p || i == q) continue;
        ast_real *ip = a + AT(i, p), *iq = a + AT(i, q);
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real x = ip[l], y = iq[l];
            ip[l] = cosine[l] * x - sine[l] * y;
            iq[l] = sine[l] * x + cosine[l] * y;
        }
    }
    for (int i = 0; vectors != NULL && i < n; i++) {
        ast_real *ip = vectors + (size_t)(p * n + i) * AST_LANES, *iq = vectors + (size_t)(q * n + i) * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real x = ip[l], y = iq[l];
            ip[l] = cosine[l] * x - sine[l] * y;
            iq[l] = sine[l] * x + cosine[l] * y;
        }
    }
    return rotations;
}

/* Exchanges values i < j, and their vectors, where the later one is larger. */
static void order_lanes(int n, ast_real *restrict values, ast_real *restrict vectors, int i, int j) {
    ast_real swapped[AST_LANES];
    ast_real *x = values + (size_t)i * AST_LANES, *y = values + (size_t)j * AST_LANES;
    for (int l = 0; l < AST_LANES; l++) {
        const ast_real first = x[l], second = y[l];
        swapped[l] = second > first ? 1 : 0;
        x[l] = second > first ? second : first;
        y[l] = second > first ? first : second;
    }
    for (int d = 0; vectors != NULL && d < n; d++) {
        x = vectors + (size_t)(i * n + d) * AST_LANES;
        y = vectors + (size_t)(j * n + d) * AST_LANES;
        for (int l = 0; l < AST_LANES; l++) {
            const ast_real first = x[l], second = y[l];
            x[l] = swapped[l] > 0 ? second : first;
            y[l] = swapped[l] > 0 ? first : second;
        }
    }
}

/* Cyclic Jacobi rotations. */
static void eigen(int n, ast_real *a, ast_real *values, ast_real *vectors) {
    enum { SWEEPS = 20 }; /* convergence is quadratic: 5 or 6 are needed */
    for (int i = 0; vectors != NULL && i < n * n; i++)
        for (int l = 0; l < AST_LANES; l++) vectors[(size_t)i * AST_LANES + (size_t)l] = i % (n + 1) == 0 ? 1 : 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        int rotations = 0;
        for (int p = 0; p + 1 < n; p++)
            for (int q = p + 1; q < n; q++) rotations += rotate_lanes(n, a, vectors, p, q);
        if (rotations == 0) break;
    }
    for (int i = 0; i < n; i++)
        for (int l = 0; l < AST_LANES; l++) values[i * AST_LANES + l] = a[AT(i, i) + (size_t)l];
    for (int i = 0; i + 1 < n; i++)
        for (int j = i + 1; j < n; j++) order_lanes(n, values, vectors, i, j);
}

/* The eigenvalues of 3 x 3 matrices, descending, in closed form: with q the mean of the diagonal and A = q I + p B, those of B are
 * 2 cos of the thirds of acos(det(B) / 2) (Smith, Communications of the ACM 4, 1961). Not where they lie too close together for
 * that: its error grows with (q / p)^3, and with the root of what rounding leaves where two are equal. Returns the number of such
 * lanes and marks them with 1 in `close`, the others with 0. */
static int eigenvalues_of_three(const ast_real *restrict a, ast_real *restrict values, ast_real *restrict close) {
    enum { n = 3 };
    const ast_real *a00 = a + AT(0, 0), *a11 = a + AT(1, 1), *a22 = a + AT(2, 2);
    const ast_real *a01 = a + AT(0, 1), *a02 = a + AT(0, 2), *a12 = a + AT(1, 2);
    int refused = 0;
    for (int l = 0; l < AST_LANES; l++) {
        const ast_real q = (a00[l] + a11[l] + a22[l]) / 3;
        const ast_real off = a01[l] * a01[l] + a02[l] * a02[l] + a12[l] * a12[l];
        const ast_real on = (a00[l] - q) * (a00[l] - q) + (a11[l] - q) * (a11[l] - q) + (a22[l] - q) * (a22[l] - q);
        const ast_real p = ast_sqrt((on + 2 * off) / 6);
        const ast_real per = 1 / (p + AST_REAL_LEAST); /* finite where all are equal */
        const ast_real x = (a00[l] - q) * per, y = (a11[l] - q) * per, z = (a22[l] - q) * per;
        const ast_real u = a01[l] * per, v = a02[l] * per, w = a12[l] * per;
        const ast_real half = (x * (y * z - w * w) - u * (u * z - w * v) + v * (u * w - y * v)) / 2;
        const ast_real third = ast_acos_lane(half) / 3; /* in 0 .. pi / 3 */
        const ast_real c = ast_cos_lane(third), s = ast_sqrt(3 * (1 - c * c));
        const ast_real largest = q + 2 * p * c, least = q - p * (c + s);
        values[l] = largest;
        values[2 * AST_LANES + l] = least;
        values[AST_LANES + l] = 3 * q - largest - least;
        const ast_real by_distance = p > (ast_real)0.02 * ast_fabs(q) ? (ast_real)0 : (ast_real)1,
                       by_angle = ast_fabs(half) <= (ast_real)0.9999 ? (ast_real)0 : (ast_real)1;
        close[l] = by_distance > by_angle ? by_distance : by_angle;
    }
    for (int l = 0; l < AST_LANES; l++) refused += close[l] > 0;
    return refused;
}

/* Eigenvalues alone, by the way that is fastest. spare: n values and 1 more. */
static void eigenvalues(int n, ast_real *a, ast_real *values, ast_real *spare) {
    if (n != 3) {
        eigen(n, a, values, NULL);
        return;
    }
    ast_real *close = spare + (size_t)n * AST_LANES;
    if (eigenvalues_of_three(a, values, close) == 0) return;
    eigen(n, a, spare, NULL);
    for (int i = 0; i < n; i++)
        for (int l = 0; l < AST_LANES; l++)
            values[i * AST_LANES + l] = close[l] > 0 ? spare[i * AST_LANES + l] : values[i * AST_LANES + l];
}
