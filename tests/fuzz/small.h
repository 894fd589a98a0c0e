/* Small trackers for harnesses, and what every result of a tracker must be. */
#ifndef FUZZ_SMALL_H
#define FUZZ_SMALL_H

#include <asttrack.h>
#include <math.h>

#include "bytes.h"

/* With every part at work and steps of some microseconds. which: the paper's parts scored by Gram matrices, the same scored
 * literally, the robust preset's parts. */
enum { SMALL_KINDS = 3 };
static inline ast_config small_kind(int which) {
    ast_config cfg;
    REQUIRE(ast_config_preset(&cfg, which == 2 ? AST_PRESET_ROBUST : AST_PRESET_PAPER) == AST_OK);
    if (which == 1) cfg.scoring = AST_SCORING_LITERAL;
    cfg.particles = 6;
    cfg.patch_width = 5;
    cfg.patch_height = 4;
    cfg.history = 2;
    cfg.basis_size = 2;
    cfg.bag_size = 3;
    cfg.bag_interval = 1;
    if (which == 2) {
        cfg.view = 32;
        cfg.gradient_cells = 2;
        cfg.background = 8;
        cfg.background_refresh = 2;
        cfg.shortlist = 4;
    }
    REQUIRE(ast_config_check(&cfg, NULL) == AST_OK);
    return cfg;
}

/* Numbers, in their ranges, whatever was seen. */
static inline void require_sane(const ast_tracker *t, const ast_result *r) {
    ast_config cfg;
    ast_particles p;
    double sum = 0;
    REQUIRE(ast_get_config(t, &cfg) == AST_OK && ast_get_particles(t, &p) == AST_OK);
    REQUIRE(isfinite(r->box.x) && isfinite(r->box.y) && isfinite(r->box.w) && isfinite(r->box.h) && isfinite(r->distance));
    REQUIRE(r->box.w > 0 && r->box.h > 0 && r->scale >= cfg.scale_min && r->scale <= cfg.scale_max);
    REQUIRE(r->score >= 0 && r->score <= 1);
    REQUIRE(r->effective_particles >= 0.999f && r->effective_particles <= 1.001f * (float)cfg.particles);
    REQUIRE(r->status >= AST_TRACKING && r->status <= AST_LOST);
    REQUIRE(p.count == cfg.particles && p.scored >= 1 && p.scored <= p.count && r->best >= 0 && r->best < p.scored);
    for (int32_t i = 0; i < p.count; i++) {
        REQUIRE(isfinite(p.x[i]) && isfinite(p.y[i]) && p.scale[i] >= cfg.scale_min && p.scale[i] <= cfg.scale_max);
        REQUIRE(p.weight[i] >= 0 && p.weight[i] <= 1.0001f);
        sum += (double)p.weight[i];
    }
    REQUIRE(fabs(sum - 1) < 1e-4);
    for (int32_t i = p.scored; i < p.count; i++) REQUIRE(p.weight[i] == 0);
    for (int32_t i = 0; i < p.scored * p.models; i++) REQUIRE(isfinite(p.distance[i]));
}

#endif
