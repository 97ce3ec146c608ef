#include "trace.h"

#include "port.h"

/* The value at a place of the image, in the byte order of this processor, as the program stores it. */
static uint64_t read_bits(const uint8_t *at, uint8_t size) {
    switch (size) {
    case 1: return *at;
    case 2: return *(const uint16_t *)(const void *)at;
    case 4: return *(const uint32_t *)(const void *)at;
    default: return *(const uint64_t *)(const void *)at;
    }
}

static void write_bits(uint8_t *at, uint8_t size, uint64_t bits) {
    switch (size) {
    case 1: *at = (uint8_t)bits; break;
    case 2: *(uint16_t *)(void *)at = (uint16_t)bits; break;
    case 4: *(uint32_t *)(void *)at = (uint32_t)bits; break;
    default: *(uint64_t *)(void *)at = bits; break;
    }
}

static int64_t sign_extended(uint64_t bits, uint8_t size) {
    unsigned unused = 64u - 8u * size;
    return (int64_t)(bits << unused) >> unused;
}

static void put_text(const char *text) {
    while (*text != '\0') {
        port_put(*text++);
    }
}

static void put_unsigned(uint64_t number) {
    char digits[20];
    int count = 0;
    do {
        digits[count++] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0u);
    while (count > 0) {
        port_put(digits[--count]);
    }
}

/* The size of a number, after its sign. The least number has no positive counterpart, so this counts in unsigned. */
static uint64_t put_sign(int64_t number) {
    if (number >= 0) {
        return (uint64_t)number;
    }
    port_put('-');
    return 0u - (uint64_t)number;
}

/* Nanoseconds as milliseconds, with as many decimals as there are. */
static void put_time(int64_t nanoseconds) {
    uint64_t size = put_sign(nanoseconds);
    uint32_t rest = (uint32_t)(size % 1000000u);
    put_unsigned(size / 1000000u);
    if (rest != 0u) {
        port_put('.');
        for (uint32_t digit = 100000u; rest != 0u; digit /= 10u) {
            port_put((char)('0' + rest / digit));
            rest %= digit;
        }
    }
}

void trace_header(void) {
    put_text(trace_names);
    port_put('\n');
}

void trace_row(int64_t now, const void *image) {
    put_time(now);
    for (uint32_t index = 0; index < trace_column_count; index++) {
        const trace_column_t *column = &trace_columns[index];
        uint64_t bits = read_bits((const uint8_t *)image + column->offset, column->size);
        port_put(',');
        switch (column->type) {
        case TRACE_TIME: put_time((int64_t)bits); break;
        case TRACE_SIGNED: put_unsigned(put_sign(sign_extended(bits, column->size))); break;
        default: put_unsigned(bits); break;
        }
    }
    port_put('\n');
}

void set_stimuli(int64_t now, const stimulus_t **next, void *image) {
    /* The sentinel is never due: a scan at the end of time is out of reach. */
    for (; (*next)->time <= now && (*next)->size != 0u; (*next)++) {
        write_bits((uint8_t *)image + (*next)->offset, (*next)->size, (*next)->bits);
    }
}
