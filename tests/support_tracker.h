/* Trackers to test: every backend, blocks with guard bytes, states as bytes. Failing here fails the running test. */
#ifndef SUPPORT_TRACKER_H
#define SUPPORT_TRACKER_H

#include "support_backends.h"
#include "tracker.h"

/* A configuration with all parts at work in little time: 40 particles (a full tile and a part of one), patches of 8 x 8, P = 3,
 * k = 3, W = 2; otherwise the paper preset. */
ast_config small_config(void);
/* The same with every part of the robust preset: a view of 64 pixels, 4 x 4 cells of gradients, 16 background vectors,
 * a shortlist of AST_TILE + 1. */
ast_config small_robust_config(void);
/* One of three: the paper's parts scored by Gram matrices, the same scored literally, and the robust preset's parts. */
enum { SMALL_CONFIGS = 3 };
ast_config small_config_of(int which);
/* A tracker in a block of its own, released by ast_free. */
ast_tracker *tracker_new(const ast_config *cfg, const struct ast_linalg *la);

/* A block of exactly size bytes at an address that leaves this remainder by AST_ALIGNMENT, every byte `fill`, guard bytes
 * around. */
struct guarded {
    unsigned char *memory;
    size_t size;
    unsigned char *allocation;
};
void guarded_open(struct guarded *block, size_t size, size_t remainder, int fill);
/* Fails the test when a guard byte has changed. */
void guarded_check(const struct guarded *block);
void guarded_close(struct guarded *block);

/* What ast_save writes. */
struct saved {
    unsigned char *bytes;
    size_t size;
};
struct saved saved_from(const ast_tracker *t);
/* Fails the test unless the tracker's state is, byte for byte, the one saved. */
void saved_check(const struct saved *saved, const ast_tracker *t, const char *what);
void saved_free(struct saved *saved);

#endif
