#include "score.h"

const struct ast_scoring *ast_scoring_of(const ast_config *cfg) {
#ifdef AST_NO_LITERAL
    (void)cfg; /* the check lets nothing else through */
    return &ast_scoring_gram;
#else
    return cfg->scoring == AST_SCORING_LITERAL ? &ast_scoring_literal : &ast_scoring_gram;
#endif
}
