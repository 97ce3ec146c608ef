/* A process under Linux in the place of a board: the interrupt is a signal. */
#define _POSIX_C_SOURCE 200809L
#include "port.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>
#include <unistd.h>

static void (*on_tick)(void);

static void on_signal(int number) {
    (void)number;
    on_tick();
}

void port_put(char character) {
    if (putchar(character) == EOF) {
        exit(2);
    }
}

void port_start_timer(void (*tick)(void)) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    const struct itimerval millisecond = {{0, 1000}, {0, 1000}};
    on_tick = tick;
    /* An alarm that comes while the last one still waits is lost: a process is no board. */
    if (sigaction(SIGALRM, &action, NULL) != 0 || setitimer(ITIMER_REAL, &millisecond, NULL) != 0) {
        exit(2);
    }
}

void port_wait(void) {
    pause();
}

void port_exit(int status) {
    exit(status);
}
