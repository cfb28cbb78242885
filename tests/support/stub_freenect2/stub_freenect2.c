/* The shim of libfreenect2 for tests: the same C functions over a synthetic, mirrored camera. */
#define _POSIX_C_SOURCE 200809L
#include "stub_freenect2.h"

#include "io/freenect2/freenect2_shim.h"
#include "kinect2_sample.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct relief_freenect2 {
    stub_stream stream;
    float depth[KINECT2_DEPTH_PIXELS];
    uint8_t color[KINECT2_COLOR_PIXELS * 4];
};

static stub_freenect2 stub = {.fault = {.devices = 1, .is_paced = true}};

stub_freenect2 *stub_freenect2_get(void)
{
    return &stub;
}

int relief_freenect2_version(void)
{
    return RELIEF_FREENECT2_VERSION;
}

int relief_freenect2_count(void)
{
    return stub.fault.devices;
}

int relief_freenect2_serial(int index, char *out, size_t size)
{
    snprintf(out, size, "0%d", index);
    return index < stub.fault.devices;
}

relief_freenect2 *relief_freenect2_open(const char *serial, char *out_cause, size_t size)
{
    const bool is_there = stub.fault.devices > 0 && (serial[0] == '\0' || serial[0] == '0');
    if (stub.fault.open_fails || !is_there) {
        snprintf(out_cause, size, is_there ? "cannot be opened" : "no Kinect v2 is plugged in");
        return NULL;
    }
    stub.fault.waits = 0;
    stub.fault.objects++;
    return calloc(1, sizeof(relief_freenect2));
}

void relief_freenect2_get_calibration(relief_freenect2 *self, relief_freenect2_calibration *out)
{
    (void)self;
    memcpy(out->ir, &kinect2_sample_ir, sizeof(out->ir));
    memcpy(out->color, &kinect2_sample_color, sizeof(out->color));
    if (stub.has_bad_numbers) {
        memset(out, 0, sizeof(*out));
    }
}

/* The scene as the real camera sees it: left and right have changed sides. */
static void paint(relief_freenect2 *self)
{
    const uint64_t n = self->stream.number;
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        const int u = KINECT2_DEPTH_WIDTH - 1 - i % KINECT2_DEPTH_WIDTH;
        self->depth[i] = (float)stub_depth_mm(u, i / KINECT2_DEPTH_WIDTH, n) + 0.25F;
        if (self->depth[i] == 0.25F) { /* the three ways to say nothing */
            self->depth[i] = u % 3 == 0 ? 0.0F : u % 3 == 1 ? NAN : INFINITY;
        }
    }
    for (int i = 0; i < KINECT2_COLOR_PIXELS; i++) {
        uint8_t rgb[3];
        uint8_t *p = self->color + (ptrdiff_t)i * 4;
        stub_color(KINECT2_COLOR_WIDTH - 1 - i % KINECT2_COLOR_WIDTH, i / KINECT2_COLOR_WIDTH, n,
                   rgb);
        p[stub.is_rgbx ? 0 : 2] = rgb[0];
        p[1] = rgb[1];
        p[stub.is_rgbx ? 2 : 0] = rgb[2];
    }
}

int relief_freenect2_wait(relief_freenect2 *self, int timeout_ms, relief_freenect2_frame *out)
{
    const stub_event event = stub_wait(&stub.fault, &self->stream, timeout_ms);
    if (event != STUB_FRAME) {
        return event == STUB_GONE ? -1 : 0;
    }
    paint(self);
    const uint32_t ticks = (uint32_t)(self->stream.number - 1) * STUB_K2_TICKS;
    *out = (relief_freenect2_frame){.depth = self->depth,
                                    .depth_sequence = (uint32_t)self->stream.number,
                                    .depth_time = stub.first_time + ticks,
                                    .color = self->color,
                                    .color_is_rgbx = stub.is_rgbx};
    out->color_time = out->depth_time + STUB_K2_COLOR_LATE_TICKS;
    if (stub.fault.waits == stub.fault.damage_at) {
        out->color_time = out->depth_time - 2 * STUB_K2_TICKS; /* of another moment */
    }
    if (stub.fault.waits == stub.fault.no_color_at) {
        out->color = NULL;
    }
    return 1;
}

/* No lens and no shadow: a depth pixel's colour lies three times as far and twice as low. */
void relief_freenect2_registration(relief_freenect2 *self, float *out_depth, uint32_t *out_color)
{
    for (int i = 0; i < KINECT2_DEPTH_PIXELS; i++) {
        const int x = STUB_K2_ALIGNED_X + 3 * (i % KINECT2_DEPTH_WIDTH);
        const int y = STUB_K2_ALIGNED_Y + 2 * (i / KINECT2_DEPTH_WIDTH);
        out_depth[i] = self->depth[i] > 0.0F ? self->depth[i] : 0.0F;
        memcpy(&out_color[i], self->color + (ptrdiff_t)(y * KINECT2_COLOR_WIDTH + x) * 4, 4);
    }
}

void relief_freenect2_close(relief_freenect2 *self)
{
    stub.fault.objects--;
    free(self);
}
