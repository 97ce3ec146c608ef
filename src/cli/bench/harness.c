/* Runs the scans of a program that a C compiler built, as the command measures its own engines: the same inputs at the
   same times, changed within the time that is measured. It takes commands from the standard input, numbers in the
   machine's byte order: first the size of the image and the image, then the count of the BOOL inputs and their offsets;
   then, again and again, how many scans to run, and it gives the nanoseconds that they took. 0 scans ask for the image. */

#define _POSIX_C_SOURCE 200809L

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

extern unsigned char ladder_image[];
void ladder_scan(void *image, int64_t now);

static void take(void *bytes, size_t count)
{
    if (fread(bytes, 1, count, stdin) != count)
    {
        exit(0);
    }
}

static uint64_t state = UINT64_C(0x9E3779B97F4A7C15);

static uint64_t next_random(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static uint64_t nanoseconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * 1000000000u + (uint64_t)time.tv_nsec;
}

int main(void)
{
    uint32_t size, count;
    take(&size, sizeof size);
    take(ladder_image, size);
    take(&count, sizeof count);
    uint32_t *offsets = malloc(count * sizeof *offsets + 1);
    take(offsets, count * sizeof *offsets);
    int64_t now = 0;
    for (;;)
    {
        uint64_t scans;
        take(&scans, sizeof scans);
        if (scans == 0)
        {
            fwrite(ladder_image, 1, size, stdout);
            fflush(stdout);
            continue;
        }
        const uint64_t start = nanoseconds();
        while (scans > 0)
        {
            for (uint32_t change = 0; change < (count + 9) / 10; change++)
            {
                const uint64_t which = next_random(), value = next_random();
                ladder_image[offsets[which % count]] = (unsigned char)(value >> 63);
            }
            const uint64_t batch = scans < CHANGE ? scans : CHANGE;
            for (uint64_t scan = 0; scan < batch; scan++)
            {
                ladder_scan(ladder_image, now);
                now += CYCLE;
            }
            scans -= batch;
        }
        const uint64_t spent = nanoseconds() - start;
        fwrite(&spent, sizeof spent, 1, stdout);
        fflush(stdout);
    }
}
