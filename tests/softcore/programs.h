/* The tables that the test writes for check.c. */
#ifndef PROGRAMS_H
#define PROGRAMS_H

#include <stdint.h>

typedef struct place_t {
    uint32_t offset;
    uint8_t size;
} place_t;

typedef struct change_t {
    uint32_t offset;
    uint8_t size;
    uint64_t bits;
} change_t;

/* A scan: its time in nanoseconds, and how many changes come before it. */
typedef struct moment_t {
    int64_t now;
    uint32_t changes;
} moment_t;

typedef struct program_t {
    void (*init)(void *image, const void *retained);
    void (*scan)(void *image, int64_t now);
    void *image;
    uint32_t place_count;
    const place_t *places;
    const change_t *changes;
    uint32_t scan_count;
    const moment_t *moments;
} program_t;

extern const program_t programs[];
extern const uint32_t program_count;

#include "sizes.h"

#endif
