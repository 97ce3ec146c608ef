/* The functions of the C library that a compiler may call of its own accord. Firmware with a C library leaves this out. */
#include <stddef.h>
#include <stdint.h>

/* A compiler that knows these loops would turn each into a call of the very function that it is in. */
#pragma GCC optimize("no-tree-loop-distribute-patterns")

void *memcpy(void *restrict to, const void *restrict from, size_t count) {
    uint8_t *target = to;
    const uint8_t *source = from;
    while (count-- > 0) {
        *target++ = *source++;
    }
    return to;
}

void *memmove(void *to, const void *from, size_t count) {
    uint8_t *target = to;
    const uint8_t *source = from;
    if (target <= source) {
        return memcpy(to, from, count);
    }
    while (count-- > 0) {
        target[count] = source[count];
    }
    return to;
}

void *memset(void *to, int value, size_t count) {
    uint8_t *target = to;
    while (count-- > 0) {
        *target++ = (uint8_t)value;
    }
    return to;
}
