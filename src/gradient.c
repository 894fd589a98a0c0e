#include "gradient.h"

void ast_gradient_layout(struct ast_gradient *g, const ast_config *cfg, struct ast_arena *arena) {
    const size_t side = (size_t)cfg->view;
    g->kernels = ast_kernels();
    g->cells = cfg->gradient_cells;
    g->weight = cfg->gradient_weight;
    g->side = cfg->view;
    g->maps = ast_arena_take(arena, side * side * AST_DIRECTIONS, sizeof *g->maps);
    /* The energy takes the maps' second half: a row of maps is written where no row of the energy is still to be read. The first
     * half holds it on its way. */
    g->energy = g->maps != NULL ? (float *)(void *)(g->maps + side * side * (AST_DIRECTIONS - sizeof *g->energy)) : NULL;
    g->row = ast_arena_take(arena, 2 * side * AST_DIRECTIONS, sizeof *g->row);
}

void ast_gradient_prepare(struct ast_gradient *g, const ast_frame *image, float object_width, float object_height) {
    g->kernels->maps(g, image, object_width / (float)g->cells, object_height / (float)g->cells);
}

void ast_gradient_cells(const struct ast_gradient *g, const ast_box *window, float *out) {
    g->kernels->cells(g, window, out);
}
