/* Runs the program in real time, its timers driven by the timer interrupt, and prints the trace. This is the main loop
   of a controller; where the stimuli are set, copy the inputs in, and where the trace is printed, copy the outputs out.

   A line is printed after each cycle. At a slow line that alone may take longer than a cycle: nothing is lost by it,
   since the interrupt counts on and the next cycle reads the right time. */
#include "ladder.h"
#include "port.h"
#include "trace.h"

/* How long to go on, in milliseconds. */
#ifndef DURATION_MS
#define DURATION_MS 6000
#endif

#define TICK_NS 1000000 /* what `--tick` was when the program was built */

static volatile uint32_t ticks;

/* The interrupt: the program counts its ticks itself; ours say when a cycle is due. */
static void tick(void) {
    ladder_tick();
    ticks++;
}

/* The time of the last cycle: the image ends with the sum of all its ticks. */
static int64_t latched_time(void) {
    const uint8_t *end = (const uint8_t *)&ladder_image + ladder_image_size;
    return *(const int64_t *)(const void *)(end - 8) * TICK_NS;
}

int main(void) {
    const uint32_t cycle = (uint32_t)(scan_cycle / TICK_NS);
    const stimulus_t *next = stimuli;
    ladder_init(&ladder_image, 0);
    trace_header();
    port_start_timer(tick);
    for (uint32_t due = 0; due < DURATION_MS; due += cycle) {
        /* The difference, so that the counter may wrap around. */
        while ((int32_t)(ticks - due) < 0) {
            port_wait();
        }
        set_stimuli((int64_t)due * TICK_NS, &next, &ladder_image);
        ladder_cycle(&ladder_image);
        trace_row(latched_time(), &ladder_image);
    }
    return 0;
}
