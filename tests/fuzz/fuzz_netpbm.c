/* Hostile PGM and PPM files: any bytes give a picture or a reason, never more than the header allows, and the same with buffers
 * that an earlier picture left. */
#include "bytes.h"
#include "image_read.h"

static image_reader used;
static image used_grey;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    image_reader fresh;
    image grey;
    if (size >= 2 && data[0] == 0xff && data[1] == 0xd8) return -1; /* JPEG has a harness of its own */
    memset(&fresh, 0, sizeof fresh);
    memset(&grey, 0, sizeof grey);
    const bool good = image_decode(&fresh, data, size, &grey);
    REQUIRE(good == image_decode(&used, data, size, &used_grey));
    REQUIRE(grey.width == used_grey.width && grey.height == used_grey.height);
    if (good) {
        const ast_frame frame = image_frame(&grey);
        const size_t pixels = (size_t)grey.width * (size_t)grey.height;
        REQUIRE(frame.width >= 1 && frame.height >= 1 && frame.width <= AST_MAX_FRAME && frame.height <= AST_MAX_FRAME);
        REQUIRE(grey.channels == 1 && pixels <= IMAGE_MAX_PIXELS && pixels <= size);
        REQUIRE(memcmp(grey.pixels, used_grey.pixels, pixels) == 0);
    } else {
        REQUIRE(grey.width == 0 && grey.height == 0);
        REQUIRE(fresh.error[0] != '\0' && memchr(fresh.error, '\0', sizeof fresh.error) != NULL);
        REQUIRE(strcmp(fresh.error, used.error) == 0);
    }
    image_free(&grey);
    image_reader_free(&fresh);
    return 0;
}
