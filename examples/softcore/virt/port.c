/* QEMU's `virt` machine for RISC-V: a 16550 UART, the CLINT's timer, and the test device that ends the emulator. */
#include "port.h"

#include <stdint.h>

#define REGISTER8(address) (*(volatile uint8_t *)(uintptr_t)(address))
#define REGISTER32(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Addresses of the machine: on a board, those of its manual. */
#define UART_DATA REGISTER8(0x10000000u)
#define UART_LINE_STATUS REGISTER8(0x10000005u)
#define TEST_DEVICE REGISTER32(0x00100000u)
#define TIME_COMPARE 0x02004000u
#define TIME 0x0200BFF8u

#define TRANSMITTER_EMPTY 0x20u
#define TIME_FREQUENCY 10000000u /* Hz */
#define TIME_PER_TICK (TIME_FREQUENCY / 1000u)

#define MACHINE_TIMER 7u /* its number as an interrupt, and its bit in mie */
#define MACHINE_INTERRUPTS 0x8u /* in mstatus */

static void (*on_tick)(void);
static uint64_t next_tick;

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

/* Reads both halves until no carry went from one to the other in between. */
static uint64_t time_now(void) {
    uint32_t high, low;
    do {
        high = REGISTER32(TIME + 4u);
        low = REGISTER32(TIME);
    } while (high != REGISTER32(TIME + 4u));
    return (uint64_t)high << 32 | low;
}

/* In halves, such that none of the values on the way is due. */
static void set_time_compare(uint64_t time) {
    REGISTER32(TIME_COMPARE + 4u) = UINT32_MAX;
    REGISTER32(TIME_COMPARE) = (uint32_t)time;
    REGISTER32(TIME_COMPARE + 4u) = (uint32_t)(time >> 32);
}

/* Every trap comes here. An interrupt of the timer is a tick; nothing else is expected, and ends all. */
static void __attribute__((interrupt("machine"), aligned(4))) trap(void) {
    uintptr_t cause;
    __asm__ volatile("csrr %0, mcause" : "=r"(cause));
    if (cause != ((uintptr_t)1 << (8u * sizeof cause - 1u) | MACHINE_TIMER)) {
        port_exit(2);
    }
    /* From the last deadline on, not from now: a late interrupt delays no other, and missed ones are made up for. */
    next_tick += TIME_PER_TICK;
    set_time_compare(next_tick);
    on_tick();
}

void port_prepare(void) {
    __asm__ volatile("csrw mtvec, %0" : : "r"((uintptr_t)trap));
}

void port_start_timer(void (*tick)(void)) {
    on_tick = tick;
    next_tick = time_now() + TIME_PER_TICK;
    set_time_compare(next_tick);
    __asm__ volatile("csrs mie, %0" : : "r"((uintptr_t)1 << MACHINE_TIMER));
    __asm__ volatile("csrs mstatus, %0" : : "r"((uintptr_t)MACHINE_INTERRUPTS));
}

void port_wait(void) {
    __asm__ volatile("wfi");
}
