/* Hostile JPEG files: a whole picture or a reason, and nothing left allocated. */
#include "bytes.h"
#include "image_jpeg.h"

/* Whether a frame header somewhere claims more pixels than are decoded quickly: libjpeg, which is not what is tested here, would be
 * all that such an input exercises. */
static bool claims_much(const uint8_t *data, size_t size) {
    for (size_t i = 0; i + 9 <= size; i++) {
        const uint8_t marker = data[i + 1];
        if (data[i] != 0xff || marker < 0xc0 || marker > 0xcf || marker == 0xc4 || marker == 0xc8 || marker == 0xcc) continue;
        const uint32_t height = (uint32_t)data[i + 5] << 8 | data[i + 6], width = (uint32_t)data[i + 7] << 8 | data[i + 8];
        if (width <= IMAGE_MAX_PIXELS / (height > 0 ? height : 1) && width * height > 128 * 128) return true;
    }
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    image grey;
    char error[64]; /* shorter than some of libjpeg's messages */
    if (claims_much(data, size)) return -1;
    memset(&grey, 0, sizeof grey);
    memset(error, 0, sizeof error);
    if (image_jpeg_decode(data, size, &grey, error, sizeof error)) {
        uint32_t sum = 0;
        REQUIRE(grey.width >= 1 && grey.height >= 1 && grey.channels == 1);
        for (size_t i = 0; i < (size_t)grey.width * (size_t)grey.height; i++) sum += grey.pixels[i];
        REQUIRE(sum <= 255u * 128u * 128u);
    } else {
        REQUIRE(error[0] != '\0' && memchr(error, '\0', sizeof error) != NULL && strchr(error, '\n') == NULL);
    }
    image_free(&grey);
    return 0;
}
