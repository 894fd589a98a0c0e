/* asttrack: follow one object through a video from a single box, on fixed memory.
 *
 * The Affine Subspace Tracker (AST) of Shirazi, Harandi, Lovell and Sanderson, "Object Tracking via Non-Euclidean
 * Geometry: A Grassmann Approach" (2013). Comments below that say "paper" mean that publication.
 *
 * In call order:
 *
 *     ast_config cfg;
 *     ast_config_preset(&cfg, AST_PRESET_ROBUST);
 *     ast_tracker *t = NULL;
 *     ast_init(&t, &cfg, block, sizeof block);        // or (&t, &cfg, NULL, 0): one allocation
 *     ast_start(t, &frame, &box);
 *     while (next(&frame)) ast_step(t, &frame, &result);
 *     ast_free(t);
 *
 * Rules that hold for every function:
 *  - Functions that can fail return AST_OK (0) or a negative AST_E_* code; ast_strerror() names it.
 *  - A call that fails leaves the tracker as it was; only the distances of ast_get_particles are gone after a failed step.
 *  - After ast_init nothing allocates memory, in any linear-algebra backend.
 *  - There is no global mutable state: different trackers may be used in different threads at once; one tracker may not.
 *  - With cfg.threads > 1 ast_init starts threads, which sleep between steps, take no signals, and end in ast_free. They do not
 *    live on in a child of fork: there, such a tracker must not be used, nor freed.
 *  - Pixel centres lie at integer coordinates: a box covers x - 1/2 .. x + w - 1/2.
 */
#ifndef ASTTRACK_H
#define ASTTRACK_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version lives here only; everything else (shared object, pkg-config file, Python package) reads it. */
#define AST_VERSION_MAJOR 0
#define AST_VERSION_MINOR 1
#define AST_VERSION_PATCH 0

#if defined(AST_BUILD_SHARED) && defined(__GNUC__)
#define AST_API __attribute__((visibility("default")))
#else
#define AST_API
#endif
#if defined(__GNUC__)
#define AST_CHECKED __attribute__((warn_unused_result))
#else
#define AST_CHECKED
#endif

/* ---- Return codes. Frozen: a value never changes its meaning. ---- */
enum {
    AST_OK = 0,
    AST_E_NULL = -1,           /* a required pointer is NULL */
    AST_E_CONFIG = -2,         /* a configuration field is out of range: ast_config_check names it */
    AST_E_STRUCT_SIZE = -3,    /* ast_config.struct_size is not this library's: a stale header or binding */
    AST_E_ARENA = -10,         /* the caller's block is smaller than ast_mem_size */
    AST_E_OUT_OF_MEMORY = -11, /* the one allocation of ast_init failed */
    AST_E_NO_HEAP = -12,       /* mem == NULL in a build with AST_NO_HEAP */
    AST_E_THREAD = -13,        /* ast_init could not start the threads that the configuration asks for */
    AST_E_FRAME = -20,         /* a side outside 1..AST_MAX_FRAME, stride < width, or more rows than the memory has addresses */
    AST_E_BOX = -21,           /* box not finite, a side below one pixel or above AST_MAX_FRAME, or wholly outside its frame */
    AST_E_NOT_STARTED = -22,   /* ast_step, ast_save or a look inside before ast_start */
    AST_E_RANGE = -23,         /* an index or a count outside its range */
    AST_E_BACKEND = -30,       /* the linear-algebra backend reported a failure */
    AST_E_BUFFER = -40,        /* the buffer for ast_save or the workspace is too small */
    AST_E_CORRUPT = -41,       /* ast_restore: not a saved state, truncated, or altered */
    AST_E_MISMATCH = -42       /* ast_restore: saved under another configuration or an unknown format version */
};

/* A text for any int; never NULL. Static storage. */
AST_API const char *ast_strerror(int code);
/* "MAJOR.MINOR.PATCH" of the library that is linked or loaded. Static storage. */
AST_API const char *ast_version(void);
/* Name of the linear-algebra backend that this build uses: "lapacke" or "builtin". Static storage. */
AST_API const char *ast_backend(void);

/* ---- Configuration ---- */

#define AST_MAX_FRAME 65535     /* largest frame side, pixels */
#define AST_MAX_PARTICLES 65536 /* largest N */
#define AST_MAX_PATCH 64        /* largest patch side, pixels */
#define AST_MAX_HISTORY 15      /* largest P; a candidate set has at most 16 images */
#define AST_MAX_BASIS 8         /* largest n */
#define AST_MAX_BAG 64          /* largest k */
#define AST_MAX_VIEW 256        /* largest view side, pixels */
#define AST_MAX_CELLS 16        /* most gradient cells in an axis */
#define AST_MAX_BACKGROUND 128  /* most background vectors */
#define AST_MAX_THREADS 16      /* most threads that share a step's work */

/* Values of the enumerated fields: plain int32_t in the struct, so that no ABI's enum size matters. */
enum {
    AST_PRESET_PAPER = 0,  /* the publication */
    AST_PRESET_ROBUST = 1, /* the default choice where there is a megabyte */
    AST_PRESET_TINY = 2,   /* 64 KiB with its stack */
    AST_PRESET_COMPACT = 3 /* the robust one in reduced sizes, for a microcontroller with half a megabyte */
};
/* normalisation of a patch, applied to its pixels in [0, 1] */
enum {
    AST_NORMALISE_NONE = 0, /* raw pixel values */
    AST_NORMALISE_MEAN = 1, /* minus the patch's mean: blind to an offset of the light */
    AST_NORMALISE_UNIT = 2  /* minus the mean, then x / (|x| + 1/255): blind to offset and gain, a flat patch stays small */
};
/* which set the basis spans */
enum {
    AST_BASIS_CENTRED = 0, /* images minus their mean: the affine subspace proper */
    AST_BASIS_RAW = 1      /* the images themselves: the letter of the paper's section 2.2 */
};
/* what an object model is */
enum {
    AST_MODEL_AFFINE = 0, /* mean and basis: the paper's tracker */
    AST_MODEL_LINEAR = 1  /* mu = 0 everywhere: the paper's linear-subspace ablation (table 1); takes AST_BASIS_RAW only */
};
/* how distances are computed; the numbers are the same. A build with AST_NO_LITERAL is smaller and has the first only. */
enum {
    AST_SCORING_GRAM = 0,   /* one matrix product a frame and small eigen-problems */
    AST_SCORING_LITERAL = 1 /* each candidate's images formed, thin SVD, U_i'U_j, thin SVD again: the paper as written */
};

/* how the random walk's steps are drawn */
enum {
    AST_DRAWS_RANDOM = 0, /* independent */
    AST_DRAWS_QUASI = 1   /* quasi-random: an additive sequence with a random start, which covers the walk evenly */
};
/* the scale of the likelihood */
enum {
    AST_LIKELIHOOD_FIXED = 0, /* exp(-dist / sigma): the paper's eq. 6 */
    AST_LIKELIHOOD_SCALED = 1 /* exp(-(dist - least) / (sigma (mean - least))): distances need no unit, so no scene to fit */
};
/* how much each model of the bag has to say about the particles */
enum {
    AST_VOTE_EQUAL = 0,   /* as much as any other: the paper's eq. 9 */
    AST_VOTE_CONTRAST = 1 /* in proportion to mean - least of its distances: one that tells the particles apart says more */
};
/* switches */
enum { AST_NO = 0, AST_YES = 1 };

/* Plain data, copied by ast_init. Fill with ast_config_preset, then change fields. */
typedef struct ast_config {
    uint32_t struct_size; /* sizeof(ast_config); set by ast_config_preset */

    /* Particles (paper section 2.1) */
    int32_t particles; /* N, 1 .. AST_MAX_PARTICLES */
    int32_t shortlist; /* of them scored in full, the likeliest at a glance; 0 or N: all (the paper's); needs a background */
    float walk_x;      /* standard deviation of the random walk in x, pixels a frame, 0 .. 1000 */
    float walk_y;      /* the same in y */
    float walk_scale;  /* the same for the natural logarithm of the scale, 0 .. 1 */
    int32_t draws;     /* AST_DRAWS_* */
    float velocity;    /* share of the smoothed velocity added to every particle, 0 (the paper's) .. 1 */
    int32_t incumbent; /* AST_YES: one particle stays on the last estimate */
    float prior; /* standard deviation of the winner's place about the last one, in object sizes, 0 .. 100; 0: none (the paper's) */
    float scale_min; /* least scale, relative to the first box, 0.01 .. 1 */
    float scale_max; /* greatest scale, relative to the first box, 1 .. 100 */

    /* View: the reachable part of the frame, resampled once a frame to a fixed number of pixels; 0: features read the frame */
    int32_t view;        /* greatest side, pixels, 0 or 32 .. AST_MAX_VIEW */
    int32_t view_object; /* the object's size in it (geometric mean of the sides) at most, pixels, 8 .. AST_MAX_VIEW */

    /* Feature vector: grey patch, then oriented gradients, each times its weight; weight 0 leaves a part out, not both */
    float patch_weight;     /* 0 .. 100 */
    float gradient_weight;  /* 0 .. 100; needs a view; 0 alone in a build with AST_NO_GRADIENT */
    int32_t gradient_cells; /* cells in each axis, 2 .. AST_MAX_CELLS, 8 directions each */

    /* Patches (section 2.2) */
    int32_t patch_width;   /* N2, pixels, 4 .. AST_MAX_PATCH */
    int32_t patch_height;  /* N1, pixels, 4 .. AST_MAX_PATCH */
    int32_t normalisation; /* AST_NORMALISE_* */

    /* Subspaces (section 2.2) */
    int32_t history;    /* P, tracked patches in a candidate's image set, 1 .. AST_MAX_HISTORY */
    int32_t basis_size; /* n, basis vectors kept, 1 .. AST_MAX_BASIS and at most history + 1 */
    int32_t basis;      /* AST_BASIS_* */
    int32_t model;      /* AST_MODEL_* */

    /* Bag of models (section 2.3) */
    int32_t bag_size;     /* k, models, 1 .. AST_MAX_BAG */
    int32_t bag_interval; /* W, frames between updates, 1 .. 10000 */
    int32_t keep_first;   /* AST_YES: the first model is never replaced */

    /* Background: feature vectors of displaced boxes around the object; 0: none, and the metric is the identity (the paper's) */
    int32_t background;         /* vectors, 0 or 8 .. AST_MAX_BACKGROUND; needs AST_SCORING_GRAM */
    int32_t background_refresh; /* of them drawn anew each frame, 0 .. background */
    float ridge;                /* of the metric, relative to the background's total variance, 1e-4 .. 1e6 */
    float background_ratio;     /* weight of the likelihood ratio against the background's mean in the Mahalanobis term, 0 .. 10 */

    /* Distance and likelihood (section 2.4) */
    float alpha;        /* weight of the Mahalanobis term, 0 .. 1e6 */
    float sigma;        /* scale of the likelihood, 1e-6 .. 1e6 */
    int32_t likelihood; /* AST_LIKELIHOOD_* */
    int32_t vote;       /* AST_VOTE_* */
    int32_t scoring;    /* AST_SCORING_* */

    /* Guard: what the tracker learns from, and what it does when the object is gone. Likenesses are relative to what they were:
     * recall's and selective's to a mean of about the last 20 frames, guard's and reacquire's to one that is slower to fall. */
    float guard;  /* least likeness to the start of a frame that is learned from, 0 .. 1; 0: no guard, and none of the next three */
    float recall; /* the same of the likeness to the bag's likest model; a frame is refused when both fall short, 0 .. 1 */
    float reacquire; /* least likeness to the start that ends AST_LOST, beside recall's, 0 .. 1 */
    float selective; /* least likeness to the start of a frame whose model takes another's place in a full bag, 0 .. 1 */

    /* Confidence */
    float score_uncertain; /* below this score a frame is doubtful, 0 .. 1 */
    float score_lost;      /* below this score, 0 .. score_uncertain, a frame counts towards AST_LOST (without a guard), or takes no
                              place in a full bag (with one) */
    int32_t lost_after;    /* consecutive frames that count (with a guard: that it refuses) and make AST_LOST, 1 .. 10000 */

    /* Threads that share a step's work, the caller's own among them, 1 .. AST_MAX_THREADS; 1 alone in a build without threads
     * (AST_NO_THREADS, AST_NO_HEAP). The results are the same bits for every number. */
    int32_t threads;

    uint64_t seed; /* of the tracker's own random generator; the same seed and frames give the same bits */
} ast_config;

/* Fills *cfg (all of it, whatever was there). AST_E_NULL, or AST_E_RANGE for an unknown preset. */
AST_API AST_CHECKED int ast_config_preset(ast_config *cfg, int preset);
/* AST_OK, or an error with *field set to the name of the first offending field (NULL when it is not a field's fault;
 * static storage). field may be NULL. */
AST_API AST_CHECKED int ast_config_check(const ast_config *cfg, const char **field);

enum { AST_FIELD_INT = 0, AST_FIELD_FLOAT = 1, AST_FIELD_ENUM = 2, AST_FIELD_SEED = 3 };
/* One row for each field of ast_config but struct_size, in declaration order: for option parsers and bindings. */
typedef struct ast_config_field {
    const char *name;           /* the member's name */
    const char *const *choices; /* AST_FIELD_ENUM: the names of the values 0, 1, ..; NULL otherwise */
    uint32_t offset;            /* bytes from the start of ast_config */
    int32_t kind;               /* AST_FIELD_*: int32_t, float, int32_t, uint64_t */
    float minimum, maximum;     /* legal range, inclusive (for AST_FIELD_ENUM the number of choices less one; none for the seed) */
} ast_config_field;
/* The table, static storage; *count (required) receives its length. NULL when count is NULL. */
AST_API const ast_config_field *ast_config_fields(int32_t *count);

/* ---- Frames and boxes ---- */

/* Borrowed 8-bit grey pixels, read during a call only; row r starts at pixels + r * stride. */
typedef struct ast_frame {
    const uint8_t *pixels;
    int32_t width, height; /* pixels, 1 .. AST_MAX_FRAME */
    int32_t stride;        /* bytes from one row to the next, >= width */
} ast_frame;

/* Top-left corner and size in pixels, 0-based. */
typedef struct ast_box {
    float x, y, w, h;
} ast_box;

/* Colour rows to grey (ITU-R BT.601 luma, rounded), no allocation. dst: height rows of width bytes, dst_stride bytes apart;
 * src: rows src_stride bytes apart. AST_E_NULL, or AST_E_FRAME for sides or strides that cannot be. YUYV wants an even width
 * and keeps its Y bytes; RGB565 is two bytes a pixel, low byte first. dst must not overlap src. */
AST_API AST_CHECKED int ast_grey_from_rgb(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width,
                                          int32_t height);
AST_API AST_CHECKED int ast_grey_from_bgr(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width,
                                          int32_t height);
AST_API AST_CHECKED int ast_grey_from_yuyv(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width,
                                           int32_t height);
AST_API AST_CHECKED int ast_grey_from_rgb565(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride,
                                             int32_t width, int32_t height);

/* ---- Tracking ---- */

typedef struct ast_tracker ast_tracker; /* opaque; lives inside the block given to ast_init */

/* Bytes that ast_init needs for this configuration, whatever the block's alignment; a function of the configuration (and the
 * build) alone, never of a frame. 0 when the configuration is not valid. AST_MEM_SIZE, at the end of this header, is an upper bound
 * of it for an array's length. */
AST_API size_t ast_mem_size(const ast_config *cfg);

/* Builds a tracker in mem (mem_size bytes, any address, the caller's to keep until ast_free and to release afterwards), or, with
 * mem == NULL, in one allocation of its own that ast_free releases. *cfg is copied. On an error *out is untouched.
 * AST_E_NULL, AST_E_CONFIG, AST_E_STRUCT_SIZE, AST_E_ARENA, AST_E_OUT_OF_MEMORY, AST_E_NO_HEAP, AST_E_THREAD. */
AST_API AST_CHECKED int ast_init(ast_tracker **out, const ast_config *cfg, void *mem, size_t mem_size);
/* Ends a tracker and its threads: before its block is released or used otherwise. NULL is accepted; a caller's block is never
 * freed. */
AST_API void ast_free(ast_tracker *t);

/* Starts (or re-targets) on the object inside box. All earlier state is forgotten; the random generator restarts from the seed.
 * AST_E_NULL, AST_E_FRAME, AST_E_BOX, AST_E_BACKEND. */
AST_API AST_CHECKED int ast_start(ast_tracker *t, const ast_frame *frame, const ast_box *box);
/* The paper's initialisation: count >= 1 frames with the object's box in each, oldest first; the last `history` of them fill the
 * image set. scale is relative to boxes[0]. Errors as ast_start; AST_E_RANGE for count < 1. */
AST_API AST_CHECKED int ast_start_sequence(ast_tracker *t, const ast_frame *frames, const ast_box *boxes, int32_t count);

/* ast_result.status */
enum { AST_TRACKING = 0, AST_UNCERTAIN = 1, AST_LOST = 2 };

typedef struct ast_result {
    ast_box box;               /* the object's, pixels; may reach beyond the frame; with AST_LOST the likeliest place of all */
    float scale;               /* relative to the first box */
    float score;               /* 0 .. 1; with a guard the probability that the box is on the object, else its likeness */
    float distance;            /* the winner's least distance to a model (paper eq. 2); can be negative with background_ratio */
    float effective_particles; /* effective sample size 1 / sum w^2, 1 .. N */
    int32_t status;            /* AST_TRACKING, AST_UNCERTAIN or AST_LOST */
    int32_t best;              /* index of the winning particle */
    uint32_t frame;            /* frames seen since the start; the first step after ast_start is 1 */
} ast_result;

/* Tracks one frame. The frame's size may differ from the last one's: the state stays in pixels, the cloud is clamped into the new
 * frame. result may be NULL. AST_E_NULL, AST_E_FRAME, AST_E_NOT_STARTED, AST_E_BACKEND; on an error *result is untouched. */
AST_API AST_CHECKED int ast_step(ast_tracker *t, const ast_frame *frame, ast_result *result);

/* ---- Looking inside. Pointers stay valid until the next call that changes the tracker; read only. ---- */

/* A copy of the configuration. */
AST_API AST_CHECKED int ast_get_config(const ast_tracker *t, ast_config *cfg);

typedef struct ast_particles {
    const float *x, *y;    /* centre of each particle's box, pixels */
    const float *scale;    /* relative to the first box */
    const float *weight;   /* sum 1 */
    int32_t count;         /* N */
    int32_t models;        /* columns of distance: models in the bag at the last step (1 before the bag has one) */
    int32_t scored;        /* rows of distance: the first particles, of which the others weigh nothing; count without a shortlist */
    const float *distance; /* scored x models, row-major: the last step's distances (paper eq. 2); NULL before the first step */
    ast_box reference;     /* x, y: centre of the last estimate; w, h: box size at scale 1 */
} ast_particles;
AST_API AST_CHECKED int ast_get_particles(const ast_tracker *t, ast_particles *out);

/* An affine subspace (paper eq. 1): { mean + basis y }. */
typedef struct ast_subspace {
    const float *mean;  /* dim floats */
    const float *basis; /* dim x n, column-major, stride floats a column, orthonormal; absent directions are zero columns */
    int32_t dim;        /* D */
    int32_t stride;     /* floats from one basis column to the next, >= dim */
    int32_t n;          /* basis vectors asked for */
    int32_t rank;       /* of them present, 0 .. n, first */
} ast_subspace;

/* Number of models in the bag, 0 .. bag_size; or a negative code. */
AST_API int ast_bag_count(const ast_tracker *t);
/* Model index of the bag, 0 = oldest. AST_E_NULL, AST_E_NOT_STARTED, AST_E_RANGE. */
AST_API AST_CHECKED int ast_get_model(const ast_tracker *t, int32_t index, ast_subspace *out);
/* Floats in a feature vector of this configuration (D): the grey patch's patch_height x patch_width, row-major and normalised,
 * times patch_weight, then gradient_cells x gradient_cells x 8 directions, times gradient_weight; a part with weight 0 is not
 * there. 0 when the configuration is not valid. */
AST_API int32_t ast_feature_length(const ast_config *cfg);
/* Number of vectors in the history, 0 .. history; or a negative code. */
AST_API int ast_history_count(const ast_tracker *t);
/* Vector index of the history, 0 = oldest: ast_feature_length floats, the winners' features of the last frames. */
AST_API AST_CHECKED int ast_get_history(const ast_tracker *t, int32_t index, const float **vector);

/* ---- Save and restore ---- */

/* Bytes that ast_save writes for this configuration; 0 when it is not valid. */
AST_API size_t ast_save_size(const ast_config *cfg);
/* Writes the whole state into buffer: versioned, checksummed, little-endian on every machine, so that a restored tracker continues
 * bit for bit. AST_E_NULL, AST_E_NOT_STARTED, AST_E_BUFFER. */
AST_API AST_CHECKED int ast_save(const ast_tracker *t, void *buffer, size_t size);
/* Replaces the state of t, which must have the configuration of the saved one (but for `scoring` and `threads`). AST_E_NULL,
 * AST_E_CORRUPT, AST_E_MISMATCH. */
AST_API AST_CHECKED int ast_restore(ast_tracker *t, const void *buffer, size_t size);

/* ---- The geometry on its own ---- */

/* Bytes of workspace for ast_subspace_fit (count images of dim floats) and ast_subspace_distance (pass the larger n as count).
 * 0 for dim < 1 or a count outside 1 .. AST_MAX_HISTORY + 1. */
AST_API size_t ast_subspace_work_size(int32_t dim, int32_t count);
/* Fits an affine subspace to count images (paper section 2.2). images: dim x count, column-major, stride floats a column. mean
 * (dim floats) and basis (dim x n, column-major, packed) are the caller's; out then points into them. A direction whose singular
 * value is at most 1e-5 of the images' Frobenius norm is absent: a zero column. basis_kind: AST_BASIS_*; 1 <= n <= AST_MAX_BASIS.
 * work: any address, ast_subspace_work_size(dim, count) bytes. AST_E_NULL, AST_E_RANGE (values that are not finite, too),
 * AST_E_BUFFER, AST_E_BACKEND. */
AST_API AST_CHECKED int ast_subspace_fit(const float *images, int32_t dim, int32_t stride, int32_t count, int basis_kind, int32_t n,
                                         float *mean, float *basis, ast_subspace *out, void *work, size_t work_size);

typedef struct ast_distance {
    float angle[AST_MAX_BASIS]; /* the n principal angles (paper eq. 4), radians, ascending, 0 .. pi/2; the rest 0 */
    float geodesic;             /* |angle|_2 (eq. 3) */
    float mahalanobis;          /* 2 d'd - |Ua'd|^2 - |Ub'd|^2, d = mean_a - mean_b (from eq. 5) */
    float distance;             /* geodesic + alpha mahalanobis (eq. 2) */
} ast_distance;
/* Distance of two subspaces of the same dim and n. Where a and b have absent directions (of n), min(a, b) angles are 0 and the
 * remaining absent ones pi/2. work as above, ast_subspace_work_size(dim, n). Errors as above. */
AST_API AST_CHECKED int ast_subspace_distance(const ast_subspace *a, const ast_subspace *b, float alpha, ast_distance *out,
                                              void *work, size_t work_size);

/* ---- The block's size at compile time ---- */

/* At least ast_mem_size for a configuration with these fields, and at most 768 bytes more for each of its threads: a constant
 * expression, so that
 *
 *     static unsigned char block[AST_MEM_SIZE_TINY];
 *
 * is a tracker's block without a heap. patch_width and patch_height: 0 when patch_weight is 0; gradient_cells: 0 when
 * gradient_weight is 0. For the built-in linear algebra (LAPACK says only when it runs how much it needs) and AST_SCORING_GRAM.
 * Compile with the library's own AST_REAL and AST_LANES, if it was built with any. */
#define AST_MEM_SIZE(particles, shortlist, view, patch_width, patch_height, gradient_cells, history, basis_size, bag_size,         \
                     background, threads)                                                                                          \
    AST_MEM_OF_((size_t)(particles), (size_t)(shortlist), (size_t)(view), (size_t)(patch_width), (size_t)(patch_height),           \
                (size_t)(gradient_cells), (size_t)(history), (size_t)(basis_size), (size_t)(bag_size), (size_t)(background),       \
                (size_t)(threads))

/* The presets as they are. */
#define AST_MEM_SIZE_PAPER AST_MEM_SIZE(600, 0, 0, 32, 32, 0, 3, 3, 10, 0, 1)
#define AST_MEM_SIZE_ROBUST AST_MEM_SIZE(350, 160, 128, 16, 16, 12, 3, 2, 18, 40, 1)
#define AST_MEM_SIZE_TINY AST_MEM_SIZE(92, 0, 48, 16, 16, 0, 2, 1, 5, 8, 1)
#define AST_MEM_SIZE_COMPACT AST_MEM_SIZE(200, 48, 96, 12, 12, 8, 3, 2, 10, 32, 1)

/* What it is made of: no business of a program. Bytes of the library's own structs at most, which it checks as it is compiled; then
 * the arrays, each on a boundary of 64 bytes, in the order of ast_init. N, S, v, pw, ph, c, P, n, k, b, T: the fields above. */
#define AST_MEM_TRACKER_ (768 + 80 * sizeof(void *))
#define AST_MEM_DESK_ (64 + 40 * sizeof(void *))
#define AST_MEM_CREW_ 512
#define AST_MEM_WORKER_ 64
#if defined(AST_REAL)
#define AST_MEM_REAL_ sizeof(AST_REAL)
#elif defined(ARDUINO)
#define AST_MEM_REAL_ sizeof(float)
#else
#define AST_MEM_REAL_ sizeof(double)
#endif
#if defined(AST_LANES)
#define AST_MEM_LANES_ ((size_t)AST_LANES)
#elif defined(ARDUINO)
#define AST_MEM_LANES_ ((size_t)4)
#else
#define AST_MEM_LANES_ ((size_t)16)
#endif
#define AST_MEM_MOST_(a, b) ((a) > (b) ? (a) : (b))
#define AST_MEM_LEAST_(a, b) ((a) < (b) ? (a) : (b))
#define AST_MEM_BYTES_(bytes) (((bytes) + 63) / 64 * 64)
#define AST_MEM_FLOATS_(count) AST_MEM_BYTES_((count) * sizeof(float))
#define AST_MEM_REALS_(count) AST_MEM_BYTES_((count)*AST_MEM_REAL_)
#define AST_MEM_TILES_(count) AST_MEM_REALS_((count)*AST_MEM_LANES_)
/* floats of a feature vector, and from one to the next; columns of the product */
#define AST_MEM_DIM_(pw, ph, c) ((pw) * (ph) + 8 * (c) * (c))
#define AST_MEM_LINES_(dim) (((dim) + 15) / 16 * 16)
#define AST_MEM_STRIDE_(dim) (AST_MEM_LINES_(dim) + (AST_MEM_LINES_(dim) % 512 == 0 ? 16 : 0))
#define AST_MEM_COLUMNS_(P, n, k, b) (1 + (P) + ((b) > 0 ? 1 + (b) : 0) + (k) * ((n) + 1))
#define AST_MEM_AXIS_(length) (3 * AST_MEM_FLOATS_(length) + AST_MEM_FLOATS_(32 * (length)))
#define AST_MEM_RESAMPLER_(width)                                                                                                  \
    (AST_MEM_AXIS_(width) + AST_MEM_AXIS_(AST_MEM_LANES_) +                                                                        \
     AST_MEM_FLOATS_((AST_MEM_LANES_ < 16 ? (size_t)32 : (size_t)160) * AST_MEM_LANES_))
#define AST_MEM_VIEW_(v, side)                                                                                                     \
    ((v) > 0 ? AST_MEM_BYTES_((v) * (v)) + AST_MEM_FLOATS_((side)*AST_MEM_LANES_) + AST_MEM_RESAMPLER_(side) : 0)
#define AST_MEM_GRADIENT_(v, c) ((c) > 0 ? AST_MEM_BYTES_((v) * (v)*8) + AST_MEM_FLOATS_((v)*16) : 0)
#define AST_MEM_FRAME_(P, n, k, b, columns)                                                                                        \
    (3 * AST_MEM_REALS_(P) + 2 * AST_MEM_REALS_((P) * (P)) + AST_MEM_REALS_(k) + AST_MEM_REALS_((k) * (n)) +                       \
     AST_MEM_REALS_((k) * (n) * (n)) + AST_MEM_FLOATS_((b) * (b)) + AST_MEM_FLOATS_((b) * ((columns) - (b))) +                     \
     AST_MEM_FLOATS_((columns) * ((P) + 1)) + ((b) > 0 ? AST_MEM_FLOATS_((columns) * (1 + (b))) : 0))
#define AST_MEM_TILE_(P, n, b, columns)                                                                                            \
    (AST_MEM_FLOATS_((columns)*AST_MEM_LANES_) * ((b) > 0 ? (size_t)1 : (size_t)2) + 6 * AST_MEM_TILES_(1) + AST_MEM_TILES_(P) +   \
     2 * AST_MEM_TILES_(((P) + 1) * ((P) + 1)) + AST_MEM_TILES_(AST_MEM_MOST_((P) + 1, n)) + 2 * AST_MEM_TILES_(n) +               \
     2 * AST_MEM_TILES_((n) * (n)) + AST_MEM_TILES_((n) + 1) + AST_MEM_FLOATS_((b)*AST_MEM_LANES_))
#define AST_MEM_DESKS_(pw, ph, dim, P, n, b, columns, T)                                                                           \
    ((T) * (((pw) * (ph) > 0 ? AST_MEM_RESAMPLER_(pw) : 0) + AST_MEM_TILE_(P, n, b, columns) +                                     \
            AST_MEM_REALS_((dim) * ((P) + 1) + 2 * ((P) + 1))) +                                                                   \
     AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim) * AST_MEM_MOST_(AST_MEM_LANES_, (P) + 1)) +                                              \
     ((T)-1) * AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim) * AST_MEM_LANES_) + AST_MEM_BYTES_((T)*AST_MEM_DESK_) +                        \
     ((T) > 1 ? AST_MEM_CREW_ + AST_MEM_BYTES_((T)*AST_MEM_WORKER_) : 0))
#define AST_MEM_SCORED_(N, S) ((S) > 0 && (S) < (N) ? (S) : (N))
#define AST_MEM_SUM_(N, S, v, pw, ph, c, dim, P, n, k, b, columns, T)                                                              \
    (63 + AST_MEM_BYTES_(AST_MEM_TRACKER_) + 8 * AST_MEM_FLOATS_(N) + AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim) * (P)) +                \
     AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim) * (columns)) + AST_MEM_BYTES_((k) * sizeof(int)) + AST_MEM_REALS_((k) * (n)) +           \
     AST_MEM_BYTES_(columns) + 2 * AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim)) +                                                         \
     AST_MEM_VIEW_(v, AST_MEM_LEAST_(v, 4 * AST_MEM_LANES_)) + AST_MEM_GRADIENT_(v, c) + AST_MEM_FRAME_(P, n, k, b, columns) +     \
     AST_MEM_DESKS_(pw, ph, dim, P, n, b, columns, T) + AST_MEM_FLOATS_(AST_MEM_STRIDE_(dim) * (n)) + AST_MEM_FLOATS_(k) +         \
     AST_MEM_REALS_(4 * (k)) + AST_MEM_FLOATS_(AST_MEM_MOST_((N), AST_MEM_SCORED_(N, S) * (k))) +                                  \
     (AST_MEM_SCORED_(N, S) < (N) ? AST_MEM_FLOATS_((pw) * (ph) > 0 ? (pw) * (ph) : 8 * (c) * (c)) + AST_MEM_FLOATS_(N) +          \
                                        AST_MEM_FLOATS_(S) + AST_MEM_REALS_(b)                                                     \
                                  : 0))
#define AST_MEM_OF_(N, S, v, pw, ph, c, P, n, k, b, T)                                                                             \
    AST_MEM_SUM_(N, S, v, pw, ph, c, AST_MEM_DIM_(pw, ph, c), P, n, k, b, AST_MEM_COLUMNS_(P, n, k, b), T)

#ifdef __cplusplus
}
#endif

#endif
