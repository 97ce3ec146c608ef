/* What the firmware needs of a board. To carry it to another one, write these four functions. */
#ifndef PORT_H
#define PORT_H

/* Sends one character; waits while the line is busy. */
void port_put(char character);

/* From now on calls `tick` once a millisecond, from an interrupt. */
void port_start_timer(void (*tick)(void));

/* Sleeps until an interrupt comes. One that comes just before goes unnoticed, so that the caller waits for the next
   one, a tick at most; a spurious return does no harm either, since the caller looks at the time again. */
void port_wait(void);

/* Where nothing can go on: on a board an endless loop or a reset, in the emulator the end with this status. */
void port_exit(int status) __attribute__((noreturn));

#endif
