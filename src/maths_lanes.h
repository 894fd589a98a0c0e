/* The elementary functions that are wanted for many numbers at once, without branches, so that a loop over them becomes vector
 * instructions. In double builds they are what maths.h declares, bit for bit. */
#ifndef AST_MATHS_LANES_H
#define AST_MATHS_LANES_H

#include <stdint.h>
#include <string.h>

#include "maths.h"
#include "real.h"

#if AST_REAL_IS_DOUBLE

/* (asin(s) - s) / s for s^2 = z <= 1/4. */
static inline double ast_arcsine_excess(double z) {
    const double high =
        0.010350533439814569 +
        z * (0.005343025003147791 + z * (0.017701448975080063 + z * (-0.01530603704025498 + z * 0.02905848395573076)));
    const double middle =
        0.022372174502858302 + z * (0.017352358601511367 + z * (0.013971691376155278 + z * (0.011474729572284697 + z * high)));
    return z *
           (0.16666666666666669 + z * (0.07499999999998022 + z * (0.04464285714699303 + z * (0.030381944095536736 + z * middle))));
}

static inline double ast_acos_lane(double x) {
    const double half_pi = 1.5707963267948966, missing = 6.123233995736766e-17;
    const double size = x < 0.0 ? -x : x, inside = size < 1.0 ? size : 1.0;
    const double z = inside <= 0.5 ? inside * inside : 0.5 * (1.0 - inside); /* acos(x) = 2 asin(sqrt z) for x > 1/2 */
    const double excess = ast_arcsine_excess(z), s = AST_SQUARE_ROOT(z);
    const double near_zero = half_pi - (x - (missing - x * excess));
    const double right = 2.0 * (s + s * excess), left = 2.0 * (half_pi - (s + (s * excess - missing)));
    const double beside = x > 0.0 ? right : left;
    return inside <= 0.5 ? near_zero : beside;
}

/* 2^k for -1022 <= k <= 1023. */
static inline double ast_power_of_two_lane(int k) {
    const uint64_t bits = (uint64_t)(k + 1023) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* e^x where the result is a number; 0 for what is none. */
static inline double ast_exp_lane(double x) {
    const double least = -708.39641853226408, inside = x >= least ? x : least, counts = x >= least ? 1.0 : 0.0;
    const int k = (int)(inside * 1.4426950408889634 + (inside < 0.0 ? -0.5 : 0.5));
    const double r = (inside - (double)k * 0.6931471805598903) - (double)k * 5.497923018708371e-14;
    const double high =
        2.480149249563551e-05 + r * (2.7557572329198064e-06 + r * (2.7630438957528254e-07 + r * 2.5004469482619634e-08));
    const double tail =
        0.5000000000000011 +
        r * (0.16666666666666424 +
             r * (0.04166666666652707 +
                  r * (0.008333333333487052 + r * (0.0013888888944304325 + r * (0.00019841269522449025 + r * high)))));
    return (1.0 + (r + r * r * tail)) * ast_power_of_two_lane(k / 2) * ast_power_of_two_lane(k - k / 2) * counts;
}

static inline double ast_cos_lane(double x) {
    const double z = x * x;
    const double high = 2.0876730385966157e-09 + z * (-1.1468399389901768e-11 + z * 4.679279490419081e-14);
    const double tail =
        0.041666666666666664 + z * (-0.0013888888888888278 + z * (2.480158730111952e-05 + z * (-2.75573190670572e-07 + z * high)));
    return 1.0 - (0.5 * z - z * z * tail);
}

#else

static inline float ast_acos_lane(float x) {
    return ast_acosf(x);
}
static inline float ast_exp_lane(float x) {
    return ast_expf(x);
}
static inline float ast_cos_lane(float x) {
    return ast_cosf(x);
}

#endif

#endif
