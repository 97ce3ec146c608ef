/* Counts the instructions of a program's scans on RISC-V: as many scans as told, at a time that goes on by 10 ms, a tenth
   of the inputs changing before each. Prints the least, the sum and the greatest count, and a hash of the image at the
   end, so that every way to run a program can be seen to compute the same. */
#include <stdint.h>

#include "measure.h"
#include "port.h"

extern uint8_t ladder_image[];
void ladder_init(void *image, const void *retained);
void ladder_scan(void *image, int64_t now);

/* What measuring costs: a call like the other, of which one instruction, the return, is not counted as such. */
static void nothing(void *image, int64_t now) {
    (void)image;
    (void)now;
}

static uint32_t instructions(void) {
    uintptr_t count;
    __asm__ volatile("csrr %0, minstret" : "=r"(count) : : "memory");
    return (uint32_t)count;
}

static uint32_t count(void (*scan)(void *image, int64_t now), int64_t now) {
    void (*volatile called)(void *image, int64_t now) = scan;
    uint32_t start = instructions();
    called(ladder_image, now);
    return instructions() - start;
}

static void put_number(uint64_t number) {
    if (number >= 10u) {
        put_number(number / 10u);
    }
    port_put((char)('0' + number % 10u));
}

int main(void) {
    uint32_t overhead = count(nothing, 0) - 1u;
    uint32_t least = UINT32_MAX, greatest = 0u, random = 1u;
    uint64_t sum = 0u, hash = 0xCBF29CE484222325u;
    ladder_init(ladder_image, 0);
    for (uint32_t scan = 0; scan < SCANS; scan++) {
        for (uint32_t input = INPUTS_START; input < INPUTS_END; input++) {
            random ^= random << 13;
            random ^= random >> 17;
            random ^= random << 5;
            ladder_image[input] ^= random % 10u == 0u;
        }
        uint32_t taken = count(ladder_scan, (int64_t)scan * 10000000) - overhead;
        sum += taken;
        least = taken < least ? taken : least;
        greatest = taken > greatest ? taken : greatest;
    }
    for (uint32_t index = 0; index < LAYOUT_SIZE; index++) {
        hash = (hash ^ ladder_image[index]) * 0x100000001B3u;
    }
    uint64_t printed[4] = {least, sum, greatest, hash};
    for (int index = 0; index < 4; index++) {
        put_number(printed[index]);
        port_put(index < 3 ? ' ' : '\n');
    }
    return 0;
}
