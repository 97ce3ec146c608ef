/* Start-up for RISC-V, 32 or 64 bits: a stack, zeroed variables, and on to main. Runs in machine mode on hart 0; other
   harts sleep. Everything is loaded where it runs; a board that starts from flash also copies .data here. */

.section .text.start, "ax"
.globl _start
_start:
    csrr t0, mhartid
    bnez t0, sleep
    la sp, stack_top
#ifdef __riscv_flen
    /* The floating-point unit is off after reset. */
    li t0, 0x2000
    csrs mstatus, t0
    csrw fcsr, zero
#endif
    la t0, bss_start
    la t1, bss_end
zero:
    bgeu t0, t1, zeroed
    sb zero, 0(t0)
    addi t0, t0, 1
    j zero
zeroed:
    call port_prepare
    call main
    call port_exit

sleep:
    wfi
    j sleep
