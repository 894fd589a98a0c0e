/* What may be a frame, and what may be a box on it. */
#ifndef AST_FRAME_H
#define AST_FRAME_H

#include "asttrack.h"

/* AST_OK, AST_E_NULL or AST_E_FRAME. */
int ast_frame_check(const ast_frame *frame);
/* AST_OK, AST_E_NULL or AST_E_BOX. The frame must be legal. */
int ast_box_check(const ast_box *box, const ast_frame *frame);
/* Share of a box that lies inside the frame, 0 .. 1. */
float ast_frame_share(const ast_frame *frame, const ast_box *box);

#endif
