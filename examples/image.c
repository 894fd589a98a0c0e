#include "image.h"

#include <stdlib.h>
#include <string.h>

bool image_reserve(image *picture, int32_t width, int32_t height, int32_t channels) {
    if (width < 1 || height < 1 || width > AST_MAX_FRAME || height > AST_MAX_FRAME ||
        (size_t)width > IMAGE_MAX_PIXELS / (size_t)height) {
        return false;
    }
    const size_t size = (size_t)width * (size_t)height * (size_t)channels;
    if (size > picture->capacity) {
        uint8_t *pixels = malloc(size);
        if (pixels == NULL) return false;
        free(picture->pixels);
        picture->pixels = pixels;
        picture->capacity = size;
    }
    picture->width = width;
    picture->height = height;
    picture->channels = channels;
    return true;
}

void image_free(image *picture) {
    free(picture->pixels);
    memset(picture, 0, sizeof *picture);
}

ast_frame image_frame(const image *grey) {
    const ast_frame frame = {grey->pixels, grey->width, grey->height, grey->width};
    return frame;
}
