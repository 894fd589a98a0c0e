#include "frame.h"

static int sides_are_legal(int32_t width, int32_t height) {
    return width >= 1 && height >= 1 && width <= AST_MAX_FRAME && height <= AST_MAX_FRAME;
}

/* Where addresses have 32 bits, the last row of a large frame or of a long stride would lie beyond the end of memory. */
static int rows_fit_memory(int32_t stride, int32_t height) {
    return (uint64_t)stride * (uint64_t)height <= (uint64_t)PTRDIFF_MAX;
}

int ast_frame_check(const ast_frame *frame) {
    if (frame == NULL || frame->pixels == NULL) return AST_E_NULL;
    if (!sides_are_legal(frame->width, frame->height) || frame->stride < frame->width) return AST_E_FRAME;
    return rows_fit_memory(frame->stride, frame->height) ? AST_OK : AST_E_FRAME;
}

int ast_box_check(const ast_box *box, const ast_frame *frame) {
    const float side = (float)AST_MAX_FRAME;
    if (box == NULL) return AST_E_NULL;
    /* Written so that a NaN fails; the overlap test bounds x and y. */
    if (!(box->w >= 1.0f && box->h >= 1.0f && box->w <= side && box->h <= side)) return AST_E_BOX;
    if (!(box->x < (float)frame->width && box->y < (float)frame->height)) return AST_E_BOX;
    if (!(box->x + box->w > 0.0f && box->y + box->h > 0.0f)) return AST_E_BOX;
    return AST_OK;
}

/* Length that the span from `from` of a length has in common with 0 .. side. */
static float common(float from, float length, int32_t side) {
    const float left = from > 0.0f ? from : 0.0f;
    const float right = from + length < (float)side ? from + length : (float)side;
    return right > left ? right - left : 0.0f;
}

float ast_frame_share(const ast_frame *frame, const ast_box *box) {
    return (common(box->x, box->w, frame->width) / box->w) * (common(box->y, box->h, frame->height) / box->h);
}

/* ITU-R BT.601 luma in 16-bit fixed point; the weights sum to 65536, so that white stays 255. */
static uint8_t luma(unsigned red, unsigned green, unsigned blue) {
    return (uint8_t)((19595u * red + 38470u * green + 7471u * blue + 32768u) >> 16);
}

static int conversion_check(const uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width,
                            int32_t height, int32_t bytes) {
    if (dst == NULL || src == NULL) return AST_E_NULL;
    if (!sides_are_legal(width, height) || dst_stride < width || src_stride < width * bytes) return AST_E_FRAME;
    return rows_fit_memory(dst_stride, height) && rows_fit_memory(src_stride, height) ? AST_OK : AST_E_FRAME;
}

static int grey_from_triples(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width,
                             int32_t height, int red, int blue) {
    const int error = conversion_check(dst, dst_stride, src, src_stride, width, height, 3);
    if (error != AST_OK) return error;
    for (int32_t r = 0; r < height; r++) {
        const uint8_t *in = src + (size_t)r * (size_t)src_stride;
        uint8_t *out = dst + (size_t)r * (size_t)dst_stride;
        for (int32_t c = 0; c < width; c++, in += 3) out[c] = luma(in[red], in[1], in[blue]);
    }
    return AST_OK;
}

int ast_grey_from_rgb(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width, int32_t height) {
    return grey_from_triples(dst, dst_stride, src, src_stride, width, height, 0, 2);
}

int ast_grey_from_bgr(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width, int32_t height) {
    return grey_from_triples(dst, dst_stride, src, src_stride, width, height, 2, 0);
}

int ast_grey_from_yuyv(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width, int32_t height) {
    const int error = conversion_check(dst, dst_stride, src, src_stride, width, height, 2);
    if (error != AST_OK) return error;
    if (width % 2 != 0) return AST_E_FRAME;
    for (int32_t r = 0; r < height; r++) {
        const uint8_t *in = src + (size_t)r * (size_t)src_stride;
        uint8_t *out = dst + (size_t)r * (size_t)dst_stride;
        for (int32_t c = 0; c < width; c++, in += 2) out[c] = in[0];
    }
    return AST_OK;
}

int ast_grey_from_rgb565(uint8_t *dst, int32_t dst_stride, const uint8_t *src, int32_t src_stride, int32_t width, int32_t height) {
    const int error = conversion_check(dst, dst_stride, src, src_stride, width, height, 2);
    if (error != AST_OK) return error;
    for (int32_t r = 0; r < height; r++) {
        const uint8_t *in = src + (size_t)r * (size_t)src_stride;
        uint8_t *out = dst + (size_t)r * (size_t)dst_stride;
        for (int32_t c = 0; c < width; c++, in += 2) {
            const unsigned word = (unsigned)in[0] | (unsigned)in[1] << 8;
            const unsigned red = word >> 11, green = (word >> 5) & 63u, blue = word & 31u;
            /* Repeat the leading bits below, so that full scale maps to 255. */
            out[c] = luma(red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2);
        }
    }
    return AST_OK;
}
