/* Start-up and exceptions for OpenRISC 1000: the vectors lie at fixed addresses from 0 on. An instruction behind a jump
   is executed before it. */

#define STACK_FRAME 256 /* for a handler: below the 128 bytes that a leaf function may use beyond its stack */
#define EXCEPTION_TICK 0x500

/* Nothing else is expected, and ends all: bus error, page faults, alignment, illegal instruction, range, trap and so on. */
.macro fatal address
.org \address
    l.j fault
    l.nop
.endm

.section .vectors, "ax"

/* Reset. */
.org 0x100
    l.j start
    l.nop

fatal 0x200
fatal 0x300
fatal 0x400

/* The tick timer: save what a C function may change, and call it. */
.org EXCEPTION_TICK
    l.addi r1, r1, -STACK_FRAME
    l.sw 0(r1), r3
    l.sw 4(r1), r4
    l.sw 8(r1), r5
    l.sw 12(r1), r6
    l.sw 16(r1), r7
    l.sw 20(r1), r8
    l.sw 24(r1), r9
    l.sw 28(r1), r11
    l.sw 32(r1), r12
    l.sw 36(r1), r13
    l.sw 40(r1), r15
    l.sw 44(r1), r17
    l.sw 48(r1), r19
    l.sw 52(r1), r21
    l.sw 56(r1), r23
    l.sw 60(r1), r25
    l.sw 64(r1), r27
    l.sw 68(r1), r29
    l.sw 72(r1), r31
    l.jal port_tick
    l.nop
    l.lwz r3, 0(r1)
    l.lwz r4, 4(r1)
    l.lwz r5, 8(r1)
    l.lwz r6, 12(r1)
    l.lwz r7, 16(r1)
    l.lwz r8, 20(r1)
    l.lwz r9, 24(r1)
    l.lwz r11, 28(r1)
    l.lwz r12, 32(r1)
    l.lwz r13, 36(r1)
    l.lwz r15, 40(r1)
    l.lwz r17, 44(r1)
    l.lwz r19, 48(r1)
    l.lwz r21, 52(r1)
    l.lwz r23, 56(r1)
    l.lwz r25, 60(r1)
    l.lwz r27, 64(r1)
    l.lwz r29, 68(r1)
    l.lwz r31, 72(r1)
    l.addi r1, r1, STACK_FRAME
    l.rfe

fatal 0x600
fatal 0x700
fatal 0x800
fatal 0x900
fatal 0xa00
fatal 0xb00
fatal 0xc00
fatal 0xd00
fatal 0xe00


.text
start:
    /* r0 is an ordinary register until it is set to 0. */
    l.movhi r0, 0
    l.movhi r1, hi(stack_top)
    l.ori r1, r1, lo(stack_top)
    l.movhi r3, hi(bss_start)
    l.ori r3, r3, lo(bss_start)
    l.movhi r4, hi(bss_end)
    l.ori r4, r4, lo(bss_end)
zero:
    l.sfgeu r3, r4
    l.bf zeroed
    l.nop
    l.sw 0(r3), r0
    l.j zero
    l.addi r3, r3, 4
zeroed:
    l.jal main
    l.nop
    l.jal port_exit
    l.ori r3, r11, 0

fault:
    l.jal port_exit
    l.addi r3, r0, 2
