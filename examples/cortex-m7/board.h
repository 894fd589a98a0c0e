/* What the program asks of the machine it runs on: the emulated board (board_mps2.c), or a process on the host (board_host.c) that
 * runs the same program to compare with. */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>
#include <stdint.h>

/* Memory that a reset leaves alone, as flash is: zeros at first. */
enum { BOARD_FLASH = 40 * 1024 };
unsigned char *board_flash(void);

/* Text to whoever watches. */
void board_write(const char *text);
/* Calls the interrupt handler again and again, at any time from now on. */
void board_start_interrupts(void (*handler)(void));
/* Returns after the next interrupt, or before. */
void board_wait(void);
/* Nanoseconds since the call before, up to 600 million: with the emulator's -icount shift=0, instructions. Not together with
 * interrupts; 0 where nobody knows. */
uint32_t board_elapsed(void);
/* Starts the program again from its entry, all memory but board_flash as at first. */
void board_reset(void);
/* Ends: 0 is success. */
void board_exit(int status);

/* Bytes of stack that were ever used; 0 where nobody knows. */
size_t board_stack_used(void);

/* The program: returns what board_exit takes. */
int program(void);

#endif
