/* Interprets the operations of a program one by one, as textbooks do and most controllers: fetch, switch, execute. Every
   value has a cell, and so has every constant; the image lies at their head, and contacts and coils are operations that
   load and store. */
#include <stdint.h>

#include "stream.h"

/* In the order of `textbook.rs`. */
enum operation_t {
    LOAD8, LOAD64, NOT, AND, OR, EXCLUSIVE_OR, ADD64, SUBTRACT64, MINIMUM64, MAXIMUM64,
    EQUAL64, NOT_EQUAL64, LESS64, LESS_OR_EQUAL64, GREATER64, GREATER_OR_EQUAL64, SELECT8, SELECT64, END
};

uint8_t ladder_image[CELLS] __attribute__((aligned(8)));

void ladder_init(void *image, const void *retained) {
    (void)retained;
    for (uint32_t index = 0; index < CELLS; index++) {
        ((uint8_t *)image)[index] = first_cells[index];
    }
}

#define CELL8(place) (cells[code[place]])
#define CELL64(place) (*(int64_t *)(void *)(cells + code[place]))
#define COMPARE(operator) CELL8(1) = CELL64(2) operator CELL64(3); code += 4; break

void ladder_scan(void *image, int64_t now) {
    uint8_t *const cells = image;
    const uint16_t *code = stream;
    *(int64_t *)(void *)(cells + NOW) = now;
    for (;;) {
        switch (code[0]) {
        case LOAD8: CELL8(1) = CELL8(2); code += 3; break;
        case LOAD64: CELL64(1) = CELL64(2); code += 3; break;
        case NOT: CELL8(1) = CELL8(2) ^ 1u; code += 3; break;
        case AND: CELL8(1) = CELL8(2) & CELL8(3); code += 4; break;
        case OR: CELL8(1) = CELL8(2) | CELL8(3); code += 4; break;
        case EXCLUSIVE_OR: CELL8(1) = CELL8(2) ^ CELL8(3); code += 4; break;
        case ADD64: CELL64(1) = (int64_t)((uint64_t)CELL64(2) + (uint64_t)CELL64(3)); code += 4; break;
        case SUBTRACT64: CELL64(1) = (int64_t)((uint64_t)CELL64(2) - (uint64_t)CELL64(3)); code += 4; break;
        case MINIMUM64: CELL64(1) = CELL64(2) < CELL64(3) ? CELL64(2) : CELL64(3); code += 4; break;
        case MAXIMUM64: CELL64(1) = CELL64(2) < CELL64(3) ? CELL64(3) : CELL64(2); code += 4; break;
        case EQUAL64: COMPARE(==);
        case NOT_EQUAL64: COMPARE(!=);
        case LESS64: COMPARE(<);
        case LESS_OR_EQUAL64: COMPARE(<=);
        case GREATER64: COMPARE(>);
        case GREATER_OR_EQUAL64: COMPARE(>=);
        case SELECT8: CELL8(1) = CELL8(2) ? CELL8(3) : CELL8(4); code += 5; break;
        case SELECT64: CELL64(1) = CELL8(2) ? CELL64(3) : CELL64(4); code += 5; break;
        default: return;
        }
    }
}
