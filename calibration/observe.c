/* What the confidence is made from, watched: linked in front of the command (--wrap), it writes the predictors of every step's
 * probability, and the probability itself, as a row of the file AST_PREDICTORS. calibration/fit.py reads the names in its
 * heading. */
#include <stdio.h>
#include <stdlib.h>

#include "confidence.h"

float __real_ast_confidence_probability(const struct ast_evidence *evidence);
float __wrap_ast_confidence_probability(const struct ast_evidence *evidence);

static FILE *rows;

/* Ends the program: a file that lacks rows must not be taken for a whole one. */
static void require(int holds, const char *path) {
    if (holds) return;
    perror(path);
    exit(1);
}

__attribute__((constructor)) static void open_rows(void) {
    const char *path = getenv("AST_PREDICTORS");
    if (path == NULL) return;
    rows = fopen(path, "w");
    require(rows != NULL && fprintf(rows, "start,spread,inside,score\n") > 0, path);
}

__attribute__((destructor)) static void close_rows(void) {
    if (rows != NULL && fclose(rows) != 0) perror("AST_PREDICTORS");
}

float __wrap_ast_confidence_probability(const struct ast_evidence *evidence) {
    const float score = __real_ast_confidence_probability(evidence);
    if (rows != NULL)
        require(fprintf(rows, "%.9g,%.9g,%.9g,%.9g\n", (double)evidence->start, (double)evidence->spread, (double)evidence->inside,
                        (double)score) > 0,
                "AST_PREDICTORS");
    return score;
}
