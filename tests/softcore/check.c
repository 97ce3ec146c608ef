/* Runs many programs in one firmware, each under its own stimuli, and prints what changed in each whole image: first
   after the start against an image of zeros, then after every scan. An image is a list of places, its slots and the bytes
   between them, so that the text is the same in either byte order. */
#include "port.h"
#include "programs.h"

static uint64_t before[LARGEST_IMAGE]; /* by place; there are no more places than bytes */

static uint64_t value_of(const uint8_t *at, uint8_t size) {
    switch (size) {
    case 1: return *at;
    case 2: return *(const uint16_t *)(const void *)at;
    case 4: return *(const uint32_t *)(const void *)at;
    default: return *(const uint64_t *)(const void *)at;
    }
}

static void set(uint8_t *at, uint8_t size, uint64_t bits) {
    switch (size) {
    case 1: *at = (uint8_t)bits; break;
    case 2: *(uint16_t *)(void *)at = (uint16_t)bits; break;
    case 4: *(uint32_t *)(void *)at = (uint32_t)bits; break;
    default: *(uint64_t *)(void *)at = bits; break;
    }
}

static void put_hex(uint64_t number) {
    int shift = 60;
    while (shift > 0 && number >> shift == 0u) {
        shift -= 4;
    }
    for (; shift >= 0; shift -= 4) {
        port_put("0123456789abcdef"[number >> shift & 15u]);
    }
}

static void put_changes(const program_t *program) {
    for (uint32_t index = 0; index < program->place_count; index++) {
        const place_t *place = &program->places[index];
        uint64_t value = value_of((const uint8_t *)program->image + place->offset, place->size);
        if (value != before[index]) {
            before[index] = value;
            put_hex(index);
            port_put(':');
            put_hex(value);
            port_put(' ');
        }
    }
    port_put('\n');
}

static void run(const program_t *program) {
    const change_t *change = program->changes;
    for (uint32_t index = 0; index < program->place_count; index++) {
        before[index] = 0u;
    }
    program->init(program->image, 0);
    put_changes(program);
    for (uint32_t scan = 0; scan < program->scan_count; scan++) {
        const moment_t *moment = &program->moments[scan];
        for (const change_t *end = change + moment->changes; change < end; change++) {
            set((uint8_t *)program->image + change->offset, change->size, change->bits);
        }
        program->scan(program->image, moment->now);
        put_changes(program);
    }
}

int main(void) {
    for (uint32_t index = 0; index < program_count; index++) {
        port_put('=');
        put_hex(index);
        port_put('\n');
        run(&programs[index]);
    }
    return 0;
}
