/* Arm MPS2 boards (AN500: Cortex-M7, AN386: Cortex-M4) without an operating system: the vector table, what runs before main, an
 * interrupt from the system timer, and text to the debugger's host by semihosting. */
#include "board.h"

#include <stdint.h>

unsigned char *board_flash(void) {
    static unsigned char flash[BOARD_FLASH] __attribute__((section(".noinit")));
    return flash;
}

/* ---- Registers of every Cortex-M ---- */

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define SYST_CSR REGISTER(0xE000E010u) /* system timer: control, reload, current value */
#define SYST_RVR REGISTER(0xE000E014u)
#define SYST_CVR REGISTER(0xE000E018u)
#define AIRCR REGISTER(0xE000ED0Cu) /* reset control */
#define CPACR REGISTER(0xE000ED88u) /* access to the FPU */

enum { TICK_CYCLES = 25000 }; /* a millisecond at the boards' 25 MHz */

/* ---- Semihosting: a breakpoint that the debugger, here the emulator, takes as a request ---- */

enum { SYS_WRITE0 = 0x04, SYS_EXIT_EXTENDED = 0x20, STOPPED_EXIT = 0x20026 };

static void request(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void board_write(const char *text) {
    request(SYS_WRITE0, text);
}

void board_exit(int status) {
    const uint32_t reason[2] = {STOPPED_EXIT, (uint32_t)status};
    request(SYS_EXIT_EXTENDED, reason);
    for (;;) {
    }
}

/* ---- Interrupts ---- */

static void (*volatile tick_handler)(void);

static void on_tick(void) {
    if (tick_handler != 0) tick_handler();
}

void board_start_interrupts(void (*handler)(void)) {
    tick_handler = handler;
    SYST_RVR = TICK_CYCLES - 1;
    SYST_CVR = 0;
    SYST_CSR = 7; /* processor clock, interrupt, on */
}

uint32_t board_elapsed(void) {
    enum { NANOSECONDS = 40, WRAP = 0xFFFFFF }; /* of a cycle; of the counter, which counts down */
    const uint32_t count = SYST_CVR;
    const int running = (SYST_CSR & 1u) != 0;
    SYST_RVR = WRAP;
    SYST_CVR = 0;
    SYST_CSR = 5; /* processor clock, no interrupt, on */
    return running ? (WRAP - count) * NANOSECONDS : 0;
}

void board_wait(void) {
    __asm__ volatile("wfi" ::: "memory");
}

void board_reset(void) {
    AIRCR = 0x05FA0004u; /* the key, and the request */
    for (;;) {
    }
}

/* ---- From reset to the program ---- */

/* Places that the linker script names. */
extern uint32_t data_from[], data_start[], data_end[], bss_start[], bss_end[], stack_bottom[], stack_painted[], stack_top[];

/* Unused stack keeps a colour. */
enum { PAINT = 0x5AFEC0DE };

size_t board_stack_used(void) {
    const uint32_t *at = stack_bottom;
    while (at < stack_top && *at == PAINT) at++;
    return (size_t)(stack_top - at) * sizeof *at;
}

void board_entry(void);
void board_entry(void) {
    CPACR |= 0xFu << 20; /* before the first floating-point instruction */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    uint32_t *to = data_start;
    for (const uint32_t *from = data_from; to < data_end;) *to++ = *from++;
    for (to = bss_start; to < bss_end;) *to++ = 0;
    for (to = stack_bottom; to < stack_painted; to++) *to = PAINT;
    board_exit(program());
}

static void on_fault(void) {
    board_write("a fault\n");
    board_exit(1);
}

/* The processor reads the first stack pointer and the entry from the start of memory; the rest is called by the number of its
 * cause. */
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handler[15])(void);
} vectors = {stack_top,
             {board_entry, on_fault, on_fault, on_fault, on_fault, on_fault, 0, 0, 0, 0, on_fault, on_fault, 0, on_fault, on_tick}};
