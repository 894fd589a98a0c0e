/* The board as processes: interrupts come while the program waits, and after a reset another process runs the program from its
 * entry, with the flash of the one before. */
#include "board.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { EXIT_RESET = 77 };

static unsigned char *flash;
static void (*tick_handler)(void);

unsigned char *board_flash(void) {
    return flash;
}

void board_write(const char *text) {
    (void)fputs(text, stdout);
}

void board_start_interrupts(void (*handler)(void)) {
    tick_handler = handler;
}

uint32_t board_elapsed(void) {
    return 0;
}

void board_wait(void) {
    tick_handler();
}

void board_reset(void) {
    (void)fflush(stdout);
    _exit(EXIT_RESET);
}

void board_exit(int status) {
    (void)fflush(stdout);
    _exit(status);
}

size_t board_stack_used(void) {
    return 0;
}

int main(void) {
    int status = 0;
    flash = mmap(NULL, BOARD_FLASH, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (flash == MAP_FAILED) return EXIT_FAILURE;
    do {
        const pid_t child = fork();
        if (child < 0) return EXIT_FAILURE;
        if (child == 0) board_exit(program());
        if (waitpid(child, &status, 0) != child) return EXIT_FAILURE;
    } while (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_RESET);
    return WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_FAILURE;
}
