/* QEMU's `mps2-an385`, a Cortex-M3: the CMSDK UART, SysTick, and semihosting to end the emulator. The vector table and
   the start-up code are here, too: a Cortex-M needs no assembly for them. */
#include "port.h"

#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Addresses of the machine: on a board, those of its manual. */
#define UART_DATA REGISTER(0x40004000u)
#define UART_STATE REGISTER(0x40004004u)
#define UART_CONTROL REGISTER(0x40004008u)
#define UART_DIVIDER REGISTER(0x40004010u)
#define CPU_FREQUENCY 25000000u /* Hz */

/* Addresses that every Cortex-M has. */
#define SYSTICK_CONTROL REGISTER(0xE000E010u)
#define SYSTICK_RELOAD REGISTER(0xE000E014u)
#define SYSTICK_VALUE REGISTER(0xE000E018u)

#define TRANSMITTER_FULL 0x1u
#define TRANSMITTER_ENABLED 0x1u
#define SYSTICK_RUN 0x7u /* counts, interrupts, by the processor's clock */

extern uint32_t data_source[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];
int main(void);

static void (*on_tick)(void);

void port_put(char character) {
    while ((UART_STATE & TRANSMITTER_FULL) != 0u) {
    }
    UART_DATA = (uint8_t)character;
}

void port_exit(int status) {
    /* SYS_EXIT_EXTENDED with ADP_Stopped_ApplicationExit. Without a debugger a board stops here with a fault. */
    const uint32_t reason[2] = {0x20026u, (uint32_t)status};
    register uint32_t operation __asm__("r0") = 0x20u;
    register const uint32_t *argument __asm__("r1") = reason;
    __asm__ volatile("bkpt 0xAB" : : "r"(operation), "r"(argument) : "memory");
    for (;;) {
    }
}

static void systick(void) {
    on_tick();
}

void port_start_timer(void (*tick)(void)) {
    on_tick = tick;
    SYSTICK_RELOAD = CPU_FREQUENCY / 1000u - 1u;
    SYSTICK_VALUE = 0u;
    SYSTICK_CONTROL = SYSTICK_RUN;
}

void port_wait(void) {
    __asm__ volatile("wfi");
}

static void reset(void) {
    const uint32_t *source = data_source;
    for (uint32_t *target = data_start; target < data_end;) {
        *target++ = *source++;
    }
    for (uint32_t *target = bss_start; target < bss_end;) {
        *target++ = 0u;
    }
    UART_DIVIDER = CPU_FREQUENCY / 115200u;
    UART_CONTROL = TRANSMITTER_ENABLED;
    port_exit(main());
}

/* Nothing else is expected, and ends all. */
static void fault(void) {
    port_exit(2);
}

typedef union vector_t {
    uint32_t *stack;
    void (*handler)(void);
} vector_t;

/* A board's own interrupts follow behind the sixteen that every Cortex-M has. */
__attribute__((section(".vectors"), used)) static const vector_t vectors[16] = {
    [0] = {.stack = stack_top}, [1] = {.handler = reset}, [2] = {.handler = fault}, [3] = {.handler = fault},
    [4] = {.handler = fault},   [5] = {.handler = fault}, [6] = {.handler = fault}, [11] = {.handler = fault},
    [14] = {.handler = fault},  [15] = {.handler = systick},
};
