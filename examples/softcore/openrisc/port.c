/* QEMU's `virt` machine for OpenRISC: a 16550 UART, the processor's own tick timer, and the test device that ends the
   emulator. */
#include "port.h"

#include <stdint.h>

#define REGISTER8(address) (*(volatile uint8_t *)(uintptr_t)(address))
#define REGISTER32(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Addresses of the machine: on a board, those of its manual. */
#define UART_DATA REGISTER8(0x90000000u)
#define UART_LINE_STATUS REGISTER8(0x90000005u)
#define TEST_DEVICE REGISTER32(0x96000000u)
#define TRANSMITTER_EMPTY 0x20u
#define CPU_FREQUENCY 20000000u /* Hz */

/* Special-purpose registers: the group in the upper bits, the register in the lower eleven. */
#define SUPERVISION 17u /* SR */
#define POWER_MANAGEMENT (8u << 11)
#define TIMER_MODE (10u << 11)
#define TIMER_COUNT ((10u << 11) + 1u)

#define SUPERVISION_TICKS 0x2u /* SR[TEE] */
#define DOZE 0x10u             /* PMR[DME] */
#define TIMER_RESTART 0x40000000u
#define TIMER_INTERRUPT 0x20000000u
#define TIMER_RUN (TIMER_RESTART | TIMER_INTERRUPT | CPU_FREQUENCY / 1000u)

static void (*on_tick)(void);

static uint32_t read_special(uint32_t number) {
    uint32_t value;
    __asm__ volatile("l.mfspr %0, %1, 0" : "=r"(value) : "r"(number));
    return value;
}

static void write_special(uint32_t number, uint32_t value) {
    __asm__ volatile("l.mtspr %0, %1, 0" : : "r"(number), "r"(value) : "memory");
}

void port_put(char character) {
    while ((UART_LINE_STATUS & TRANSMITTER_EMPTY) == 0u) {
    }
    UART_DATA = (uint8_t)character;
}

void port_exit(int status) {
    TEST_DEVICE = status == 0 ? 0x5555u : (uint32_t)status << 16 | 0x3333u;
    for (;;) {
    }
}

/* Called from the exception. Writing the mode again takes the interrupt back; the counter restarted by itself. */
void port_tick(void) {
    write_special(TIMER_MODE, TIMER_RUN);
    on_tick();
}

void port_start_timer(void (*tick)(void)) {
    on_tick = tick;
    write_special(TIMER_COUNT, 0u);
    write_special(TIMER_MODE, TIMER_RUN);
    write_special(SUPERVISION, read_special(SUPERVISION) | SUPERVISION_TICKS);
}

void port_wait(void) {
    write_special(POWER_MANAGEMENT, DOZE);
}
