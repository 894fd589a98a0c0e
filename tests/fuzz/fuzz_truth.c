/* Hostile ground truth: a file gives boxes with an area, or none, and every frame's box can be asked for. */
#define _GNU_SOURCE /* memfd_create */
#include <math.h>
#include <sys/mman.h>
#include <unistd.h>

#include "bytes.h"
#include "quiet.h"
#include "truth.h"

/* The bytes as a file that lies in memory. */
static const char *file_of(const uint8_t *data, size_t size) {
    static char path[64];
    static int file = -1;
    if (file < 0) {
        file = memfd_create("groundtruth", 0);
        (void)snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    }
    REQUIRE(file >= 0 && ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == (ssize_t)size);
    return path;
}

static bool is_number(const ast_box *box) {
    return isfinite(box->x) && isfinite(box->y) && isfinite(box->w) && isfinite(box->h);
}

static bool is_box(const ast_box *box) {
    return is_number(box) && box->w > 0.0f && box->h > 0.0f;
}

static bool is_same(const ast_box *a, const ast_box *b) {
    return a->x == b->x && a->y == b->y && a->w == b->w && a->h == b->h;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    ground_truth truth;
    be_quiet();
    if (!truth_read(&truth, file_of(data, size))) {
        REQUIRE(truth.boxes == NULL && truth.count == 0);
        return 0;
    }
    REQUIRE(truth.count >= 1 && (size_t)truth.count <= size);
    for (int32_t f = -1; f <= truth.count; f++) {
        const ast_box *box = truth_box(&truth, f);
        ast_box between;
        REQUIRE(box == NULL || is_box(box));
        if (f == -1 || f == truth.count) REQUIRE(box == NULL);
        if (truth.count > 64) continue; /* to interpolate looks through all */
        const bool found = truth_interpolate(&truth, f, &between);
        REQUIRE(box == NULL || (found && is_same(&between, box)));
        REQUIRE(!found || is_number(&between));
    }
    truth_free(&truth);
    return 0;
}
