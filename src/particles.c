#include "particles.h"

#include "real.h"

void ast_cloud_set(struct ast_cloud *cloud, int i, struct ast_state state) {
    cloud->x[i] = state.x;
    cloud->y[i] = state.y;
    cloud->scale[i] = state.scale;
}

void ast_cloud_gather(struct ast_cloud *cloud, const struct ast_state *state) {
    for (int i = 0; i < cloud->count; i++) {
        ast_cloud_set(cloud, i, *state);
        cloud->weight[i] = 1.0f / (float)cloud->count;
    }
}

void ast_cloud_resample(const struct ast_cloud *from, struct ast_cloud *to, struct ast_random *random) {
    const ast_real offset = (ast_real)ast_random_uniform(random);
    ast_real total = 0;
    for (int i = 0; i < from->count; i++) total += (ast_real)from->weight[i];

    const ast_real step = total / (ast_real)to->count;
    ast_real reached = (ast_real)from->weight[0];
    int source = 0;
    for (int i = 0; i < to->count; i++) {
        const ast_real wanted = ((ast_real)i + offset) * step;
        while (reached < wanted && source + 1 < from->count) reached += (ast_real)from->weight[++source];
        to->x[i] = from->x[source];
        to->y[i] = from->y[source];
        to->scale[i] = from->scale[source];
    }
}

static float clamp(float v, float low, float high) {
    return v < low ? low : v > high ? high : v;
}

void ast_cloud_shift(struct ast_cloud *cloud, float x, float y) {
    for (int i = 0; i < cloud->count; i++) {
        cloud->x[i] += x;
        cloud->y[i] += y;
    }
}

/* Three standard normals for particle after particle. The quasi-random ones are an additive recurrence in the unit cube, whose
 * steps are powers of the inverse of the root of r^4 = r + 1 (Roberts' R3 sequence), shifted by a random start, through the normal
 * quantile. Kept in 32-bit fractions of a turn, which wrap without rounding. */
struct draws {
    uint32_t at[3];
};

static void draw(struct draws *draws, int quasi, struct ast_random *random, float normal[3]) {
    static const uint32_t step[3] = {3518319155u, 2882110345u, 2360945575u};
    for (int a = 0; a < 3; a++) {
        if (quasi) {
            draws->at[a] += step[a];
            normal[a] = ast_normal_quantile(((float)(draws->at[a] >> 9) + 0.5f) * (1.0f / 8388608.0f));
        } else {
            normal[a] = ast_random_normal(random);
        }
    }
}

struct ast_state ast_state_within(struct ast_state state, const ast_config *cfg, const ast_frame *frame) {
    state.x = clamp(state.x, 0.0f, (float)frame->width);
    state.y = clamp(state.y, 0.0f, (float)frame->height);
    state.scale = clamp(state.scale, cfg->scale_min, cfg->scale_max);
    return state;
}

void ast_cloud_diffuse(struct ast_cloud *cloud, const ast_config *cfg, const ast_frame *frame, struct ast_random *random) {
    const int quasi = cfg->draws == AST_DRAWS_QUASI;
    struct draws draws = {{0, 0, 0}};
    for (int a = 0; quasi && a < 3; a++) draws.at[a] = ast_random_bits(random);
    for (int i = 0; i < cloud->count; i++) {
        float normal[3];
        draw(&draws, quasi, random, normal);
        const struct ast_state moved = {cloud->x[i] + cfg->walk_x * normal[0], cloud->y[i] + cfg->walk_y * normal[1],
                                        cloud->scale[i] * ast_expf(cfg->walk_scale * normal[2])};
        ast_cloud_set(cloud, i, ast_state_within(moved, cfg, frame));
    }
}

float ast_cloud_spread(const struct ast_cloud *cloud) {
    ast_real x = 0, y = 0, total = 0, variance = 0;
    for (int i = 0; i < cloud->count; i++) {
        const ast_real w = (ast_real)cloud->weight[i];
        x += w * (ast_real)cloud->x[i];
        y += w * (ast_real)cloud->y[i];
        total += w;
    }
    if (!(total > 0)) return 0.0f;
    x /= total;
    y /= total;
    for (int i = 0; i < cloud->count; i++) {
        const ast_real dx = (ast_real)cloud->x[i] - x, dy = (ast_real)cloud->y[i] - y;
        variance += (ast_real)cloud->weight[i] * (dx * dx + dy * dy);
    }
    return (float)ast_sqrt(variance / total);
}

float ast_cloud_effective(const struct ast_cloud *cloud) {
    ast_real sum = 0;
    for (int i = 0; i < cloud->count; i++) sum += (ast_real)cloud->weight[i] * (ast_real)cloud->weight[i];
    return sum > 0 ? (float)(1 / sum) : 0.0f;
}
