#include "score.h"

const struct ast_scoring *ast_scoring_of(const ast_config *cfg) {
    return cfg->scoring == AST_SCORING_LITERAL ? &ast_scoring_literal : &ast_scoring_gram;
}
