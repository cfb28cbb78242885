/* A libk4a for tests: the same C functions, written for Relief, over a synthetic camera. */
#define _POSIX_C_SOURCE 200809L
#include "stub_k4a.h"

#include "io/k4a/k4a.h"

#include <stdio.h>
#include <string.h>
#include <turbojpeg.h>

struct k4a_device {
    int index;
    k4a_configuration configuration;
    stub_stream stream;
};
struct k4a_image {
    int references, format, width, height, stride;
    size_t size;
    uint64_t time_us;
    uint8_t *data;
};
struct k4a_capture {
    k4a_image_t depth, color;
};

static stub_k4a stub = {.fault = {.devices = 1, .is_paced = true},
                        .lens_type = K4A_LENS_BROWN_CONRADY};

stub_k4a *stub_k4a_get(void)
{
    return &stub;
}

static const int depth_sizes[5][2] = {{0, 0}, {320, 288}, {640, 576}, {512, 512}, {1024, 1024}};
static const int color_sizes[7][2] = {{0, 0},       {1280, 720},  {1920, 1080}, {2560, 1440},
                                      {2048, 1536}, {3840, 2160}, {4096, 3072}};

static void *make(size_t size)
{
    stub.fault.objects++;
    return calloc(1, size);
}

static void drop(void *object)
{
    stub.fault.objects--;
    free(object);
}

#define EXPORT(result, name, parameters) result k4a_##name parameters;
IO_K4A_FUNCTIONS(EXPORT)

uint32_t k4a_device_get_installed_count(void)
{
    return (uint32_t)stub.fault.devices;
}

int k4a_device_open(uint32_t index, k4a_device_t *out)
{
    if (stub.fault.open_fails || (int)index >= stub.fault.devices) {
        return 1;
    }
    *out = make(sizeof(**out));
    (*out)->index = (int)index;
    return K4A_SUCCEEDED;
}

void k4a_device_close(k4a_device_t device)
{
    drop(device);
}

int k4a_device_get_serialnum(k4a_device_t device, char *out, size_t *size)
{
    *size = (size_t)snprintf(out, *size, "00012%d", device->index) + 1;
    return K4A_SUCCEEDED;
}

int k4a_device_start_cameras(k4a_device_t device, const k4a_configuration *c)
{
    stub.fault.waits = 0;
    device->configuration = *c;
    const int seen[5] = {c->color_format, c->color_resolution, c->depth_mode, c->camera_fps,
                         c->synchronized_images_only};
    memcpy(stub.configuration, seen, sizeof(seen));
    return stub.fault.start_fails ? 1 : K4A_SUCCEEDED;
}

void k4a_device_stop_cameras(k4a_device_t device)
{
    (void)device;
}

static void fill_camera(k4a_camera *out, const int size[2], float scale)
{
    const k4a_lens lens = {.cx = (float)size[0] * 0.5F + 3.0F,
                           .cy = (float)size[1] * 0.5F - 4.0F,
                           .fx = (float)size[0] * scale,
                           .fy = (float)size[0] * scale + 0.25F,
                           .k1 = 0.5F,
                           .k2 = -2.5F,
                           .k3 = 1.5F,
                           .k4 = 0.375F,
                           .k5 = -2.25F,
                           .k6 = 1.375F,
                           .p2 = -0.000125F,
                           .p1 = 0.00025F,
                           .metric_radius = 1.7F};
    out->type = stub.lens_type;
    out->parameter_count = 14;
    out->lens = lens;
    out->width = size[0];
    out->height = size[1];
}

int k4a_device_get_calibration(k4a_device_t device, int depth_mode, int color_resolution,
                               k4a_calibration *out)
{
    (void)device;
    fill_camera(&out->depth, depth_sizes[depth_mode], 0.8F);
    fill_camera(&out->color, color_sizes[color_resolution], 0.5F);
    /* A tenth of a radian about x, row by row: the depth camera looks down. */
    out->extrinsics[0][1] = (k4a_extrinsics){
        {1.0F, 0.0F, 0.0F, 0.0F, 0.9950042F, -0.0998334F, 0.0F, 0.0998334F, 0.9950042F},
        {-32.0F, -2.0F, 4.0F}};
    out->extrinsics[1][0].rotation[0] = 7.0F; /* the way back must not be taken */
    return K4A_SUCCEEDED;
}

static k4a_image_t make_image(int format, const int size[2], int pixel, const stub_stream *s)
{
    k4a_image_t image = make(sizeof(*image));
    image->references = 1;
    image->format = format;
    image->width = size[0];
    image->height = size[1];
    image->stride = size[0] * pixel;
    image->size = (size_t)image->stride * (size_t)size[1];
    image->data = calloc(1, image->size);
    image->time_us = (uint64_t)s->time_us;
    return image;
}

static k4a_image_t make_depth(const k4a_device_t device)
{
    k4a_image_t image =
        make_image(4, depth_sizes[device->configuration.depth_mode], 2, &device->stream);
    for (int v = 0; v < image->height; v++) {
        for (int u = 0; u < image->width; u++) {
            const uint16_t z = stub_depth_mm(u, v, device->stream.number);
            memcpy(image->data + (ptrdiff_t)v * image->stride + (ptrdiff_t)u * 2, &z, 2);
        }
    }
    image->size -= stub.fault.waits == stub.fault.damage_depth_at ? 2 : 0;
    return image;
}

/* Blocks of 16 pixels, so that JPEG keeps their middles. */
static void paint_blocks(k4a_image_t image, uint64_t number)
{
    for (int v = 0; v < image->height; v++) {
        for (int u = 0; u < image->width; u++) {
            uint8_t rgb[3];
            uint8_t *p = image->data + (ptrdiff_t)v * image->stride + (ptrdiff_t)u * 4;
            stub_color(u / 16, v / 16, number, rgb);
            p[0] = rgb[2];
            p[1] = rgb[1];
            p[2] = rgb[0];
        }
    }
}

static void compress(k4a_image_t image)
{
    unsigned char *jpeg = NULL;
    unsigned long size = 0;
    tjhandle handle = tjInitCompress();
    tjCompress2(handle, image->data, image->width, image->stride, image->height, TJPF_BGRX, &jpeg,
                &size, TJSAMP_444, 95, 0);
    tjDestroy(handle);
    memcpy(image->data, jpeg, size);
    tjFree(jpeg);
    image->size = size;
    image->stride = 0;
    image->format = K4A_FORMAT_COLOR_MJPG;
}

static k4a_image_t make_color(const k4a_device_t device)
{
    k4a_image_t image =
        make_image(K4A_FORMAT_COLOR_BGRA32, color_sizes[device->configuration.color_resolution], 4,
                   &device->stream);
    image->time_us += STUB_COLOR_LATE_US;
    paint_blocks(image, device->stream.number);
    if (!stub.gives_raw) {
        compress(image);
    }
    image->size = stub.fault.waits == stub.fault.damage_at ? image->size / 2 : image->size;
    return image;
}

int k4a_device_get_capture(k4a_device_t device, k4a_capture_t *out, int32_t timeout_ms)
{
    const stub_event event = stub_wait(&stub.fault, &device->stream, timeout_ms);
    if (event != STUB_FRAME) {
        return event == STUB_GONE ? 1 : K4A_WAIT_TIMEOUT;
    }
    *out = make(sizeof(**out));
    (*out)->depth = make_depth(device);
    (*out)->color = stub.fault.waits != stub.fault.no_color_at ? make_color(device) : NULL;
    return K4A_SUCCEEDED;
}

void k4a_image_release(k4a_image_t image)
{
    if (--image->references == 0) {
        free(image->data);
        drop(image);
    }
}

void k4a_capture_release(k4a_capture_t capture)
{
    k4a_image_release(capture->depth);
    if (capture->color != NULL) {
        k4a_image_release(capture->color);
    }
    drop(capture);
}

k4a_image_t k4a_capture_get_color_image(k4a_capture_t capture)
{
    if (capture->color != NULL) {
        capture->color->references++;
    }
    return capture->color;
}

k4a_image_t k4a_capture_get_depth_image(k4a_capture_t capture)
{
    capture->depth->references++;
    return capture->depth;
}

uint8_t *k4a_image_get_buffer(k4a_image_t image)
{
    return image->data;
}

size_t k4a_image_get_size(k4a_image_t image)
{
    return image->size;
}

int k4a_image_get_format(k4a_image_t image)
{
    return image->format;
}

int k4a_image_get_width_pixels(k4a_image_t image)
{
    return image->width;
}

int k4a_image_get_height_pixels(k4a_image_t image)
{
    return image->height;
}

int k4a_image_get_stride_bytes(k4a_image_t image)
{
    return image->stride;
}

uint64_t k4a_image_get_device_timestamp_usec(k4a_image_t image)
{
    return image->time_us;
}
