/* Interprets the stream of Rung's own interpreter: runs of gates, which are boolean functions of up to four cells given
   by their truth tables and need no branch, and between them steps of which the first word says what they compute.

   The image lies at the head of the cells, so that nothing is copied in or out. */
#include <stdint.h>

#include "stream.h"

/* In the order of `engine::interp::stream`. */
enum step_t {
    COPY8, COPY16, COPY32, COPY64, SELECT8, SELECT16, SELECT32, SELECT64,
    ADD64, SUBTRACT64, MINIMUM64, MAXIMUM64, LESS64, LESS_OR_EQUAL64, EQUAL64, NOT_EQUAL64, END
};

uint8_t ladder_image[CELLS] __attribute__((aligned(8)));

void ladder_init(void *image, const void *retained) {
    (void)retained;
    for (uint32_t index = 0; index < CELLS; index++) {
        ((uint8_t *)image)[index] = first_cells[index];
    }
}

#define CELL8(place) (cells[code[place]])
#define CELL16(place) (*(uint16_t *)(void *)(cells + code[place]))
#define CELL32(place) (*(uint32_t *)(void *)(cells + code[place]))
#define CELL64(place) (*(int64_t *)(void *)(cells + code[place]))

void ladder_scan(void *image, int64_t now) {
    uint8_t *const cells = image;
    const uint16_t *code = stream;
    *(int64_t *)(void *)(cells + NOW) = now;
    for (;;) {
        const uint16_t *const end = code + 1 + 6u * code[0];
        for (code += 1; code < end; code += 6) {
            uint32_t index = (uint32_t)CELL8(1) | (uint32_t)CELL8(2) << 1 | (uint32_t)CELL8(3) << 2 | (uint32_t)CELL8(4) << 3;
            CELL8(5) = (uint8_t)(code[0] >> index & 1u);
        }
        switch (code[0]) {
        case COPY8: CELL8(1) = CELL8(2); break;
        case COPY16: CELL16(1) = CELL16(2); break;
        case COPY32: CELL32(1) = CELL32(2); break;
        case COPY64: CELL64(1) = CELL64(2); break;
        case SELECT8: CELL8(1) = CELL8(2) ? CELL8(3) : CELL8(4); break;
        case SELECT16: CELL16(1) = CELL8(2) ? CELL16(3) : CELL16(4); break;
        case SELECT32: CELL32(1) = CELL8(2) ? CELL32(3) : CELL32(4); break;
        case SELECT64: CELL64(1) = CELL8(2) ? CELL64(3) : CELL64(4); break;
        case ADD64: CELL64(1) = (int64_t)((uint64_t)CELL64(2) + (uint64_t)CELL64(3)); break;
        case SUBTRACT64: CELL64(1) = (int64_t)((uint64_t)CELL64(2) - (uint64_t)CELL64(3)); break;
        case MINIMUM64: CELL64(1) = CELL64(2) < CELL64(3) ? CELL64(2) : CELL64(3); break;
        case MAXIMUM64: CELL64(1) = CELL64(2) < CELL64(3) ? CELL64(3) : CELL64(2); break;
        case LESS64: CELL8(1) = CELL64(2) < CELL64(3); break;
        case LESS_OR_EQUAL64: CELL8(1) = CELL64(2) <= CELL64(3); break;
        case EQUAL64: CELL8(1) = CELL64(2) == CELL64(3); break;
        case NOT_EQUAL64: CELL8(1) = CELL64(2) != CELL64(3); break;
        default: return;
        }
        code += 5;
    }
}
