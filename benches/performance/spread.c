/* Scans images that come from a file, one after the other, each once: first how many bytes an image has. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

void ladder_scan(void *image, int64_t now);

int main(void)
{
    uint32_t size;
    if (fread(&size, sizeof size, 1, stdin) != 1)
    {
        return 1;
    }
    unsigned char *image = malloc(size);
    while (fread(image, 1, size, stdin) == size)
    {
        ladder_scan(image, INT64_C(1000000000));
    }
    free(image);
    return 0;
}
