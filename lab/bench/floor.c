/* The time of only reading a frame and writing a surface. */
#include "bench/bench.h"

#include <string.h>

#define SETS_BYTES ((size_t)192 << 20) /* far beyond the last-level cache of a desktop machine */
#define SET_BYTES_PER_PIXEL (BENCH_FLOOR_READ + BENCH_FLOOR_WRITTEN)

/* What each repeat writes, one pixel after the other, as a kernel
 * would (each plane is a parameter of its own, so that a compiler may vectorise the loop): 16-bit
 * counts in, eight float planes, a label and two bytes out. The arithmetic keeps a compiler from
 * turning planes into memset; it is hidden behind the memory. */
static void write_surface(size_t count, const uint16_t *restrict in, float *restrict depth,
                          float *restrict normal_x, float *restrict normal_y,
                          float *restrict normal_z, float *restrict velocity_x,
                          float *restrict velocity_y, float *restrict velocity_z,
                          float *restrict thickness, int32_t *restrict label,
                          uint8_t *restrict reason, uint8_t *restrict foreground)
{
    for (size_t i = 0; i < count; i++) {
        float z = (float)in[i] * 0.001f;
        depth[i] = z;
        normal_x[i] = z * 0.1f;
        normal_y[i] = z * 0.2f;
        normal_z[i] = z * 0.3f;
        velocity_x[i] = z * 0.4f;
        velocity_y[i] = z * 0.5f;
        velocity_z[i] = z * 0.6f;
        thickness[i] = z * 0.7f;
        label[i] = in[i];
        reason[i] = in[i] == 0;
        foreground[i] = in[i] < 2000;
    }
}

static size_t set_size(size_t pixels)
{
    return (pixels * SET_BYTES_PER_PIXEL + 63) / 64 * 64;
}

rlf_result bench_floor_open(int32_t width, int32_t height, bench_floor *out)
{
    memset(out, 0, sizeof(*out));
    out->pixels = ((size_t)width * (size_t)height + 15) / 16 * 16;
    size_t size = set_size(out->pixels);
    out->set_count = (int32_t)(SETS_BYTES / size) + 1;
    out->memory = rlf_alloc_array((size_t)out->set_count, size);
    return out->memory != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

void bench_floor_close(bench_floor *f)
{
    rlf_free(f->memory);
    f->memory = NULL;
}

void bench_floor_run(bench_floor *f)
{
    size_t n = f->pixels;
    unsigned char *set = f->memory + (size_t)f->next * set_size(n);
    f->next = (f->next + 1) % f->set_count;
    float *planes = (float *)(void *)set; /* sizes are multiples of 64 bytes: all is aligned */
    int32_t *label = (int32_t *)(void *)(planes + 8 * n);
    uint16_t *in = (uint16_t *)(void *)(label + n);
    uint8_t *reason = (uint8_t *)(in + n);
    int64_t start = rlf_clock_ns();
    write_surface(n, in, planes, planes + n, planes + 2 * n, planes + 3 * n, planes + 4 * n,
                  planes + 5 * n, planes + 6 * n, planes + 7 * n, label, reason, reason + n);
    timing_add(&f->times, (double)(rlf_clock_ns() - start) * 1e-6);
}
