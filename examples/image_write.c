#include "image_write.h"

#include "image_jpeg.h"
#include "output_file.h"
#include "path.h"
#include "report.h"

typedef enum kind { KIND_NONE, KIND_PGM, KIND_PPM, KIND_JPEG } kind;

static kind kind_of(const char *path) {
    if (path_has_extension(path, ".pgm")) return KIND_PGM;
    if (path_has_extension(path, ".ppm")) return KIND_PPM;
    if (path_has_extension(path, ".jpg") || path_has_extension(path, ".jpeg")) return KIND_JPEG;
    return KIND_NONE;
}

bool image_write_supports(const char *path, int32_t channels) {
    const kind k = kind_of(path);
    if (k == KIND_NONE || (k == KIND_PGM && channels != 1)) {
        report_error("%s: the name of a %s.ppm, .jpg or .jpeg", path,
                     channels == 1 ? "picture ends in .pgm, " : "colour picture ends in ");
        return false;
    }
    if (k == KIND_JPEG && !image_jpeg_available()) {
        report_error("%s: JPEG support was not built in: install libjpeg-dev and rebuild, or name it .ppm", path);
        return false;
    }
    return true;
}

static void write_netpbm(output_file *output, kind k, const image *picture) {
    const size_t pixels = (size_t)picture->width * (size_t)picture->height;
    output_print(output, "P%d\n%d %d\n255\n", k == KIND_PGM ? 5 : 6, (int)picture->width, (int)picture->height);
    if (k == KIND_PGM || picture->channels == 3) {
        output_bytes(output, picture->pixels, (size_t)picture->channels * pixels);
        return;
    }
    for (size_t i = 0; i < pixels; ++i) {
        const uint8_t rgb[3] = {picture->pixels[i], picture->pixels[i], picture->pixels[i]};
        output_bytes(output, rgb, sizeof rgb);
    }
}

bool image_write(const char *path, const image *picture) {
    if (!image_write_supports(path, picture->channels)) return false;
    const kind k = kind_of(path);
    output_file output;
    if (!output_open(&output, path)) return false;
    if (k == KIND_JPEG) {
        char error[256];
        if (!image_jpeg_encode(output.stream, picture, error, sizeof error)) {
            report_error("%s: cannot write: %s", path, error);
            output_discard(&output);
            return false;
        }
    } else {
        write_netpbm(&output, k, picture);
    }
    return output_commit(&output);
}
