#include "random.h"

#include "maths.h"

#define PCG_MULTIPLIER UINT64_C(6364136223846793005)
#define PCG_INCREMENT UINT64_C(1442695040888963407)

void ast_random_seed(struct ast_random *r, uint64_t seed) {
    r->state = 0;
    (void)ast_random_bits(r);
    r->state += seed;
    (void)ast_random_bits(r);
}

uint32_t ast_random_bits(struct ast_random *r) {
    const uint64_t old = r->state;
    r->state = old * PCG_MULTIPLIER + PCG_INCREMENT;
    const uint32_t mixed = (uint32_t)(((old >> 18) ^ old) >> 27);
    const uint32_t turn = (uint32_t)(old >> 59);
    return (mixed >> turn) | (mixed << ((32u - turn) & 31u));
}

float ast_random_uniform(struct ast_random *r) {
    const uint32_t k = ast_random_bits(r) >> 9; /* 23 bits, so that k + 1/2 is exact */
    return ((float)k + 0.5f) * (1.0f / 8388608.0f);
}

/* Wichura's algorithm AS 241, routine PPND7 (Applied Statistics 37, 1988): rational approximations good to about 1e-7. */
float ast_normal_quantile(float p) {
    const float q = p - 0.5f;
    if (ast_fabsf(q) <= 0.425f) {
        const float r = 0.180625f - q * q;
        return q * (((59.109374720f * r + 159.29113202f) * r + 50.434271938f) * r + 3.3871327179f) /
               (((67.187563600f * r + 78.757757664f) * r + 17.895169469f) * r + 1.0f);
    }
    float r = ast_sqrtf(-ast_logf(q < 0.0f ? p : 1.0f - p));
    float value;
    if (r <= 5.0f) {
        r -= 1.6f;
        value = (((0.17023821103f * r + 1.3067284816f) * r + 2.7568153900f) * r + 1.4234372777f) /
                ((0.12021132975f * r + 0.73700164250f) * r + 1.0f);
    } else {
        r -= 5.0f;
        value = (((0.017337203997f * r + 0.42868294337f) * r + 3.0812263860f) * r + 6.6579051150f) /
                ((0.012258202635f * r + 0.24197894225f) * r + 1.0f);
    }
    return q < 0.0f ? -value : value;
}

float ast_random_normal(struct ast_random *r) {
    return ast_normal_quantile(ast_random_uniform(r));
}
