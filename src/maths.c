/* Reduction of the argument to a short interval, and a polynomial there. The polynomials are minimax ones, their coefficients
 * rounded one after the other so that each makes up for the last one's rounding (what the tool Sollya calls fpminimax). */
#include "maths.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

#include "maths_lanes.h"
#include "real.h"

/* ---- Single precision ---- */

/* 2^k for -126 <= k <= 127. */
static float power_of_two(int k) {
    const uint32_t bits = (uint32_t)(k + 127) << 23;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

float ast_expf(float x) {
    /* x = k ln 2 + r; ln 2 in two parts, the first short enough that its product with k is exact */
    if (x != x) return x;
    if (x < -87.336545f) return 0.0f;
    if (x > 88.722839f) return HUGE_VALF;
    const int k = (int)(x * 1.44269504f + (x < 0.0f ? -0.5f : 0.5f));
    const float r = (x - (float)k * 0.693145752f) - (float)k * 1.42860677e-6f;
    const float tail = 0.4999999f + r * (0.16666521f + r * (0.041668963f + r * (0.008368669f + r * 0.0013782458f)));
    return (1.0f + (r + r * r * tail)) * power_of_two(k / 2) * power_of_two(k - k / 2);
}

float ast_logf(float x) {
    /* x = 2^e (1 + f), sqrt(1/2) < 1 + f <= sqrt(2); with s = f / (2 + f), log(1 + f) = 2 s + 2 s^3 / 3 + 2 s^5 / 5 + ..
     * = f - (f^2 / 2 - s (f^2 / 2 + rest)), where f is exact and the bracket small */
    uint32_t bits;
    if (x != x) return x;
    if (x > FLT_MAX) return x;
    if (x < FLT_MIN) x = FLT_MIN;
    memcpy(&bits, &x, sizeof bits);
    int e = (int)(bits >> 23) - 127;
    float m = x * power_of_two(-e / 2) * power_of_two(-e - -e / 2);
    if (m > 1.41421354f) {
        m *= 0.5f;
        e++;
    }
    const float f = m - 1.0f, s = f / (2.0f + f), z = s * s, half = 0.5f * f * f;
    const float rest = z * (0.6666667f + z * (0.3999955f + z * (0.28589663f + z * 0.22576208f)));
    return (float)e * 0.693145752f + (f - (half - (s * (half + rest) + (float)e * 1.42860677e-6f)));
}

/* The quadrant k of x = k pi / 2 + r, |r| <= pi / 4; pi / 2 in three parts, the first two short enough that products with k are
 * exact. */
static int quadrant(float x, float *r) {
    const int k = (int)(x * 0.636619747f + (x < 0.0f ? -0.5f : 0.5f));
    const float q = (float)k;
    *r = ((x - q * 1.57067871f) - q * 1.17614865e-4f) - q * 9.92093629e-10f;
    return k & 3;
}

static float sine_near_zero(float r) {
    const float z = r * r;
    return r + r * z * (-0.16666664f + z * (0.008332715f + z * -1.9583505e-4f));
}
static float cosine_near_zero(float r) {
    const float z = r * r;
    return 1.0f - (0.5f * z - z * z * (0.041666664f + z * (-0.0013888271f + z * 2.4543722e-5f)));
}

float ast_sinf(float x) {
    float r;
    if (!(ast_fabsf(x) <= 10000.0f)) return 0.0f;
    const int k = quadrant(x, &r);
    const float value = (k & 1) != 0 ? cosine_near_zero(r) : sine_near_zero(r);
    return (k & 2) != 0 ? -value : value;
}

float ast_cosf(float x) {
    float r;
    if (!(ast_fabsf(x) <= 10000.0f)) return 1.0f;
    const int k = quadrant(x, &r);
    const float value = (k & 1) != 0 ? sine_near_zero(r) : cosine_near_zero(r);
    return k == 1 || k == 2 ? -value : value;
}

/* (asin(s) - s) / s for s^2 = z <= 1/4. */
static float arcsine_excess(float z) {
    return z * (0.16666673f + z * (0.07498762f + z * (0.045020174f + z * (0.026433537f + z * 0.038328044f))));
}

float ast_acosf(float x) {
    const float half_pi = 1.57079637f, missing = -4.37113883e-8f; /* of pi / 2 */
    if (x >= 1.0f) return 0.0f;
    if (x <= -1.0f) return 2.0f * half_pi;
    if (ast_fabsf(x) <= 0.5f) return half_pi - (x - (missing - x * arcsine_excess(x * x)));
    const float z = 0.5f * (1.0f - ast_fabsf(x)), s = ast_sqrtf(z); /* acos(x) = 2 asin(s) for x > 0 */
    const float excess = s * arcsine_excess(z);
    return x > 0.0f ? 2.0f * (s + excess) : 2.0f * (half_pi - (s + (excess - missing)));
}

/* ---- Double precision ---- */

#if AST_REAL_IS_DOUBLE

double ast_exp_double(double x) {
    if (x != x) return x;
    if (x > 709.78271289338397) return HUGE_VAL;
    return ast_exp_lane(x);
}

double ast_cos_double(double x) {
    return ast_cos_lane(x);
}

double ast_acos_double(double x) {
    return ast_acos_lane(x);
}

#endif
