/* Runs emitted programs by commands from the standard input: a letter, the number of the program, and what the command
   takes; what it gives goes to the standard output. All numbers are in the machine's byte order. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct
{
    const uint32_t *image_size;
    const uint32_t *retain_size;
    void (*init)(void *image, const void *retained);
    void (*save)(const void *image, void *retained);
    void (*scan)(void *image, int64_t now);
    void (*tick)(void);
    void (*cycle)(void *image);
} program_t;

#include "programs.h"

static void take(void *bytes, size_t count)
{
    if (fread(bytes, 1, count, stdin) != count)
    {
        fprintf(stderr, "the commands end in the middle\n");
        exit(1);
    }
}

int main(void)
{
    int command;
    while ((command = getchar()) != EOF)
    {
        uint32_t number;
        take(&number, sizeof number);
        const program_t *program = &programs[number];
        const size_t size = *program->image_size;
        const size_t retain_size = *program->retain_size;
        /* Memory without a type of its own, of exactly the size, so that a sanitizer sees what is touched beside it. */
        unsigned char *image = malloc(size);
        unsigned char *retained = malloc(retain_size + 1);
        int64_t now;
        uint32_t ticks;
        uint8_t restores;
        switch (command)
        {
        case 's':
            take(&now, sizeof now);
            take(image, size);
            program->scan(image, now);
            fwrite(image, 1, size, stdout);
            break;
        case 'c':
            take(image, size);
            program->cycle(image);
            fwrite(image, 1, size, stdout);
            break;
        case 'i':
            take(&restores, sizeof restores);
            memset(image, 0xA5, size);
            if (restores)
            {
                take(retained, retain_size);
            }
            program->init(image, restores ? retained : NULL);
            fwrite(image, 1, size, stdout);
            break;
        case 'v':
            take(image, size);
            program->save(image, retained);
            fwrite(retained, 1, retain_size, stdout);
            break;
        case 't':
            take(&ticks, sizeof ticks);
            while (ticks-- > 0)
            {
                program->tick();
            }
            break;
        default:
            return 1;
        }
        free(image);
        free(retained);
    }
    return 0;
}
