/* Runs the program in virtual time under its stimuli and prints the trace: the same bytes as `rung sim`. This is how a
   program is tried on the very processor that it is for. */
#include "ladder.h"
#include "trace.h"

int main(void) {
    const stimulus_t *next = stimuli;
    ladder_init(&ladder_image, 0);
    trace_header();
    for (uint32_t scan = 0; scan < scan_count; scan++) {
        int64_t now = (int64_t)scan * scan_cycle;
        set_stimuli(now, &next, &ladder_image);
        ladder_scan(&ladder_image, now);
        trace_row(now, &ladder_image);
    }
    return 0;
}
