/* A trace as `rung sim` prints it: a line a scan, a column a variable. Without REAL and LREAL, whose shortest exact
   decimal form takes more code than a whole ladder program. */
#ifndef TRACE_H
#define TRACE_H

#include <stdint.h>

/* How a variable is printed. The sizes are those in the image. */
typedef enum trace_type_t { TRACE_UNSIGNED, TRACE_SIGNED, TRACE_TIME } trace_type_t;

/* A column: where the variable lies in the image, in bytes, and of how many bytes it is. */
typedef struct trace_column_t {
    uint32_t offset;
    uint8_t size;
    uint8_t type;
} trace_column_t;

/* A variable that gets a value before the first scan at or after a time, in nanoseconds. */
typedef struct stimulus_t {
    int64_t time;
    uint32_t offset;
    uint8_t size;
    uint64_t bits;
} stimulus_t;

/* These come from tables.awk. */
extern const char trace_names[];
extern const trace_column_t trace_columns[];
extern const uint32_t trace_column_count;
extern const stimulus_t stimuli[]; /* in order of time; the last is a sentinel at the end of time */
extern const int64_t scan_cycle;   /* nanoseconds from one scan to the next */
extern const uint32_t scan_count;

/* Prints the line of names. */
void trace_header(void);

/* Prints the variables after the scan at `now` nanoseconds. */
void trace_row(int64_t now, const void *image);

/* Sets the variables of every stimulus from `*next` on that is due at `now`, and moves `*next` behind them. */
void set_stimuli(int64_t now, const stimulus_t **next, void *image);

#endif
