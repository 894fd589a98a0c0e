#include "camera.h"

#include <string.h>

#include "board.h"
#include "small_scene.h"

enum { LINES_AT_ONCE = 20 }; /* in an interrupt */

/* What the interrupt and the program share. `whole` is set by the one and cleared by the other; all else belongs to the interrupt
 * while it is 0, and to the program while it is 1. */
static struct {
    volatile int whole; /* a picture waits in buffer[filling] */
    int filling;
    int32_t line, lines; /* of the picture: there, and in all */
    int32_t scene_frame;
    enum camera_fault fault, next_fault;
    uint8_t buffer[2][CAMERA_HEIGHT][CAMERA_WIDTH];
} camera;

static void line_arrives(uint8_t *to, int32_t line) {
    switch (camera.fault) {
    case CAMERA_BLACK: memset(to, 0, CAMERA_WIDTH); break;
    case CAMERA_SATURATED: memset(to, 255, CAMERA_WIDTH); break;
    case CAMERA_FROZEN: memcpy(to, camera.buffer[1 - camera.filling][line], CAMERA_WIDTH); break;
    default: small_scene_row(to, camera.scene_frame, line, CAMERA_WIDTH, CAMERA_HEIGHT); break;
    }
}

static void interrupt(void) {
    if (camera.whole) return;
    for (int i = 0; i < LINES_AT_ONCE && camera.line < camera.lines; i++, camera.line++)
        line_arrives(camera.buffer[camera.filling][camera.line], camera.line);
    if (camera.line == camera.lines) camera.whole = 1;
}

static void begin_picture(void) {
    camera.fault = camera.next_fault;
    camera.line = 0;
    camera.lines = camera.fault == CAMERA_TORN ? CAMERA_HEIGHT / 3 : CAMERA_HEIGHT;
    camera.whole = 0; /* from here on the interrupt works */
}

void camera_start(int32_t scene_frame) {
    camera.whole = 1;
    camera.filling = 0;
    camera.scene_frame = scene_frame;
    camera.next_fault = CAMERA_GOOD;
    begin_picture();
    board_start_interrupts(interrupt);
}

void camera_break(enum camera_fault fault) {
    camera.next_fault = fault;
}

int32_t camera_take(ast_frame *frame) {
    while (!camera.whole) board_wait();
    const int32_t lines = camera.lines;
    frame->pixels = &camera.buffer[camera.filling][0][0];
    frame->width = CAMERA_WIDTH;
    frame->height = lines;
    frame->stride = CAMERA_WIDTH;
    camera.filling = 1 - camera.filling;
    camera.scene_frame++;
    begin_picture();
    return lines;
}
