/* A librealsense2 for tests: the same C functions, written for Relief, over a synthetic camera. */
#define _POSIX_C_SOURCE 200809L
#include "stub_realsense2.h"

#include "io/realsense/realsense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct rs2_error {
    char message[64];
};
struct rs2_context {
    int unused;
};
struct rs2_device_list {
    int count;
};
struct rs2_device {
    int index;
};
struct rs2_sensor_list {
    int unused;
};
struct rs2_sensor {
    int unused;
};
struct rs2_stream_profile {
    int stream, format, width, height, rate;
};
struct rs2_config {
    rs2_stream_profile depth, color; /* stream 0 = not wanted */
    char serial[32];
};
struct rs2_stream_profile_list {
    int count;
    rs2_stream_profile profiles[2];
};
struct rs2_pipeline {
    rs2_stream_profile_list streams;
    stub_stream stream;
};
struct rs2_pipeline_profile {
    const rs2_pipeline *pipeline;
};
struct rs2_frame {
    int references;
    const rs2_stream_profile *profile;
    uint64_t number;
    int64_t time_us;
    int domain, stride, size;
    uint8_t *data;
    rs2_frame *parts[2]; /* of a set */
};

static stub_realsense2 stub = {.fault = {.devices = 1, .is_paced = true},
                               .color_format = RS2_FORMAT_RGB8,
                               .has_color = true,
                               .has_big_modes = true,
                               .depth_scale = 0.001F,
                               .baseline_mm = 50.0F};

stub_realsense2 *stub_realsense2_get(void)
{
    return &stub;
}

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

static void fail(rs2_error **error, const char *message)
{
    *error = make(sizeof(**error));
    snprintf((*error)->message, sizeof((*error)->message), "%s", message);
}

static bool is_gone(void)
{
    return stub.fault.unplug_at > 0 && stub.fault.waits >= stub.fault.unplug_at;
}

#define EXPORT(result, name, parameters) result rs2_##name parameters;
IO_REALSENSE_FUNCTIONS(EXPORT)
IO_REALSENSE_OPTIONAL_FUNCTIONS(EXPORT)

int rs2_get_api_version(rs2_error **error)
{
    (void)error;
    return 25605;
}

const char *rs2_get_error_message(const rs2_error *error)
{
    return error->message;
}

void rs2_free_error(rs2_error *error)
{
    drop(error);
}

rs2_context *rs2_create_context(int version, rs2_error **error)
{
    if (version != 25605) {
        fail(error, "API version mismatch");
        return NULL;
    }
    return make(sizeof(rs2_context));
}

void rs2_delete_context(rs2_context *context)
{
    drop(context);
}

rs2_device_list *rs2_query_devices(const rs2_context *context, rs2_error **error)
{
    (void)context;
    (void)error;
    if (is_gone() && stub.fault.returns_after > 0 && --stub.fault.returns_after == 0) {
        stub.fault.unplug_at = 0;
    }
    rs2_device_list *list = make(sizeof(*list));
    list->count = is_gone() ? 0 : stub.fault.devices;
    return list;
}

int rs2_get_device_count(const rs2_device_list *list, rs2_error **error)
{
    (void)error;
    return list->count;
}

void rs2_delete_device_list(rs2_device_list *list)
{
    drop(list);
}

int rs2_device_list_contains(const rs2_device_list *list, const rs2_device *device,
                             rs2_error **error)
{
    (void)error;
    return device->index < list->count;
}

rs2_device *rs2_create_device(const rs2_device_list *list, int index, rs2_error **error)
{
    if (index >= list->count) {
        fail(error, "no such device");
        return NULL;
    }
    rs2_device *device = make(sizeof(*device));
    device->index = index;
    return device;
}

void rs2_delete_device(rs2_device *device)
{
    drop(device);
}

const char *rs2_get_device_info(const rs2_device *device, int info, rs2_error **error)
{
    static const char *const serials[3] = {"0001", "0002", "0003"};
    (void)error;
    return info == RS2_INFO_NAME ? "Stub RealSense" : serials[device->index % 3];
}

int rs2_supports_device_info(const rs2_device *device, int info, rs2_error **error)
{
    (void)device;
    (void)error;
    return info == RS2_INFO_NAME || info == RS2_INFO_SERIAL_NUMBER;
}

rs2_sensor_list *rs2_query_sensors(const rs2_device *device, rs2_error **error)
{
    (void)device;
    (void)error;
    return make(sizeof(rs2_sensor_list));
}

int rs2_get_sensors_count(const rs2_sensor_list *list, rs2_error **error)
{
    (void)list;
    (void)error;
    return 1;
}

void rs2_delete_sensor_list(rs2_sensor_list *list)
{
    drop(list);
}

rs2_sensor *rs2_create_sensor(const rs2_sensor_list *list, int index, rs2_error **error)
{
    (void)list;
    (void)index;
    (void)error;
    return make(sizeof(rs2_sensor));
}

void rs2_delete_sensor(rs2_sensor *sensor)
{
    drop(sensor);
}

int rs2_is_sensor_extendable_to(const rs2_sensor *sensor, int extension, rs2_error **error)
{
    (void)sensor;
    (void)error;
    return extension == RS2_EXTENSION_DEPTH_SENSOR;
}

float rs2_get_depth_scale(rs2_sensor *sensor, rs2_error **error)
{
    (void)sensor;
    (void)error;
    return stub.depth_scale;
}

int rs2_supports_option(const rs2_sensor *sensor, int option, rs2_error **error)
{
    (void)sensor;
    (void)error;
    return option == RS2_OPTION_STEREO_BASELINE && stub.baseline_mm != 0.0F;
}

float rs2_get_option(const rs2_sensor *sensor, int option, rs2_error **error)
{
    (void)sensor;
    (void)option;
    (void)error;
    return stub.baseline_mm;
}

rs2_config *rs2_create_config(rs2_error **error)
{
    (void)error;
    return make(sizeof(rs2_config));
}

void rs2_delete_config(rs2_config *config)
{
    drop(config);
}

void rs2_config_enable_device(rs2_config *config, const char *serial, rs2_error **error)
{
    (void)error;
    snprintf(config->serial, sizeof(config->serial), "%s", serial);
}

void rs2_config_enable_stream(rs2_config *config, int stream, int index, int width, int height,
                              int format, int rate, rs2_error **error)
{
    (void)index;
    (void)error;
    const rs2_stream_profile wanted = {stream, format, width, height, rate};
    *(stream == RS2_STREAM_DEPTH ? &config->depth : &config->color) = wanted;
}

/* Sets what is left open to what the camera has; false when it has no such mode. */
static bool complete(rs2_stream_profile *p, int big_width, int big_height, int format)
{
    const bool is_any = p->width == 0;
    const bool is_small = p->width == 640 && p->height == 480;
    const bool is_big = stub.has_big_modes && p->width == big_width && p->height == big_height;
    if (is_any) {
        p->width = 640;
        p->height = 480;
    }
    if (p->format == RS2_FORMAT_ANY) {
        p->format = format;
    }
    p->rate = p->rate == 0 ? 30 : p->rate;
    return (is_any || is_small || is_big) && p->format == format && p->rate == 30;
}

int rs2_config_can_resolve(rs2_config *config, rs2_pipeline *pipeline, rs2_error **error)
{
    (void)pipeline;
    (void)error;
    rs2_config c = *config;
    return complete(&c.depth, 848, 480, RS2_FORMAT_Z16) &&
           (c.color.stream == 0 ||
            (stub.has_color && complete(&c.color, 1280, 720, stub.color_format)));
}

rs2_pipeline *rs2_create_pipeline(rs2_context *context, rs2_error **error)
{
    (void)context;
    (void)error;
    return make(sizeof(rs2_pipeline));
}

void rs2_delete_pipeline(rs2_pipeline *pipeline)
{
    drop(pipeline);
}

rs2_pipeline_profile *rs2_pipeline_start_with_config(rs2_pipeline *pipeline, rs2_config *config,
                                                     rs2_error **error)
{
    if (stub.fault.start_fails) {
        fail(error, "device is busy");
        return NULL;
    }
    rs2_config c = *config;
    complete(&c.depth, 848, 480, RS2_FORMAT_Z16);
    complete(&c.color, 1280, 720, stub.color_format);
    pipeline->streams.profiles[0] = c.depth;
    pipeline->streams.profiles[1] = c.color;
    pipeline->streams.count = c.color.stream != 0 ? 2 : 1;
    stub.fault.waits = 0;
    rs2_pipeline_profile *profile = make(sizeof(*profile));
    profile->pipeline = pipeline;
    return profile;
}

void rs2_pipeline_stop(rs2_pipeline *pipeline, rs2_error **error)
{
    (void)pipeline;
    (void)error;
}

rs2_stream_profile_list *rs2_pipeline_profile_get_streams(rs2_pipeline_profile *profile,
                                                          rs2_error **error)
{
    (void)error;
    rs2_stream_profile_list *list = make(sizeof(*list));
    *list = profile->pipeline->streams;
    return list;
}

void rs2_delete_pipeline_profile(rs2_pipeline_profile *profile)
{
    drop(profile);
}

int rs2_get_stream_profiles_count(const rs2_stream_profile_list *list, rs2_error **error)
{
    (void)error;
    return list->count;
}

const rs2_stream_profile *rs2_get_stream_profile(const rs2_stream_profile_list *list, int index,
                                                 rs2_error **error)
{
    (void)error;
    return &list->profiles[index];
}

void rs2_delete_stream_profiles_list(rs2_stream_profile_list *list)
{
    drop(list);
}

void rs2_get_stream_profile_data(const rs2_stream_profile *profile, int *stream, int *format,
                                 int *index, int *id, int *rate, rs2_error **error)
{
    (void)error;
    *stream = profile->stream;
    *format = profile->format;
    *index = 0;
    *id = profile->stream;
    *rate = profile->rate;
}

void rs2_get_video_stream_intrinsics(const rs2_stream_profile *profile, rs2_intrinsics *out,
                                     rs2_error **error)
{
    (void)error;
    const bool is_depth = profile->stream == RS2_STREAM_DEPTH;
    const float f = is_depth ? STUB_RS_DEPTH_FX(profile->width) : STUB_RS_COLOR_FX(profile->width);
    *out = (rs2_intrinsics){.width = profile->width,
                            .height = profile->height,
                            .ppx = (float)profile->width / 2.0F + 1.25F,
                            .ppy = (float)profile->height / 2.0F - 2.5F,
                            .fx = f,
                            .fy = f + 0.5F,
                            .model = RS2_DISTORTION_BROWN_CONRADY};
    if (stub.has_bad_numbers) {
        out->fx = NAN;
    }
    if (!is_depth) {
        out->model = stub.color_model;
        memcpy(out->coeffs, stub.color_coeffs, sizeof(out->coeffs));
    }
}

/* A quarter turn would be seen at once: a tenth of a radian about z, column by column. */
void rs2_get_extrinsics(const rs2_stream_profile *from, const rs2_stream_profile *to,
                        rs2_extrinsics *out, rs2_error **error)
{
    (void)from;
    (void)to;
    (void)error;
    *out = (rs2_extrinsics){
        {0.9950042F, 0.0998334F, 0.0F, -0.0998334F, 0.9950042F, 0.0F, 0.0F, 0.0F, 1.0F},
        {0.015F, -0.002F, 0.001F}};
    if (stub.has_bad_turn) {
        out->rotation[0] = -1.0F;
    }
}

/* As later versions of the library do for every Brown-Conrady lens but the plain one: tangential
 * terms of the point that the radial ones have moved. */
void rs2_project_point_to_pixel(float out[2], const rs2_intrinsics *in, const float point[3])
{
    const float x = point[0] / point[2];
    const float y = point[1] / point[2];
    const float *k = in->coeffs;
    const float r2 = x * x + y * y;
    const float f = 1.0F + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const float a = x * f;
    const float b = y * f;
    out[0] = (a + 2.0F * k[2] * a * b + k[3] * (r2 + 2.0F * a * a)) * in->fx + in->ppx;
    out[1] = (b + 2.0F * k[3] * a * b + k[2] * (r2 + 2.0F * b * b)) * in->fy + in->ppy;
}

static rs2_frame *make_frame(const rs2_stream_profile *profile, const stub_stream *s, int pixel)
{
    rs2_frame *frame = make(sizeof(*frame));
    frame->references = 1;
    frame->profile = profile;
    frame->number = s->number;
    frame->time_us = s->time_us;
    frame->stride = profile != NULL ? profile->width * pixel + 32 : 0; /* rows are padded */
    frame->size = profile != NULL ? frame->stride * profile->height : 0;
    frame->data = calloc(1, (size_t)frame->size + 1);
    return frame;
}

static void paint_depth(rs2_frame *frame)
{
    for (int v = 0; v < frame->profile->height; v++) {
        uint8_t *row = frame->data + (ptrdiff_t)v * frame->stride;
        for (int u = 0; u < frame->profile->width; u++) {
            const uint16_t z = stub_depth_mm(u, v, frame->number);
            memcpy(row + (ptrdiff_t)u * 2, &z, 2);
        }
    }
}

static void paint_color(rs2_frame *frame)
{
    const bool is_yuyv = frame->profile->format == RS2_FORMAT_YUYV;
    const bool is_bgr = frame->profile->format == RS2_FORMAT_BGR8;
    for (int v = 0; v < frame->profile->height; v++) {
        uint8_t *p = frame->data + (ptrdiff_t)v * frame->stride;
        for (int u = 0; u < frame->profile->width; u++) {
            uint8_t rgb[3];
            stub_color(u, v, frame->number, rgb);
            if (is_yuyv) { /* grey: luma 16 + v % 200 */
                *p++ = (uint8_t)(16 + v % 200);
                *p++ = 128;
                continue;
            }
            *p++ = rgb[is_bgr ? 2 : 0];
            *p++ = rgb[1];
            *p++ = rgb[is_bgr ? 0 : 2];
        }
    }
}

static rs2_frame *make_set(const rs2_pipeline *pipeline)
{
    const stub_fault *f = &stub.fault;
    const rs2_stream_profile *p = pipeline->streams.profiles;
    rs2_frame *set = make_frame(NULL, &pipeline->stream, 0);
    set->parts[0] = make_frame(&p[0], &pipeline->stream, 2);
    paint_depth(set->parts[0]);
    set->parts[0]->size -= f->waits == f->damage_depth_at ? set->parts[0]->stride : 0;
    if (pipeline->streams.count > 1 && f->waits != f->no_color_at) {
        set->parts[1] =
            make_frame(&p[1], &pipeline->stream, p[1].format == RS2_FORMAT_YUYV ? 2 : 3);
        set->parts[1]->time_us += STUB_COLOR_LATE_US;
        paint_color(set->parts[1]);
        set->parts[1]->size -= f->waits == f->damage_at ? set->parts[1]->stride : 0;
    }
    for (int i = 0; i < 2 && stub.late_clock_at > 0 && f->waits >= stub.late_clock_at; i++) {
        if (set->parts[i] != NULL) {
            set->parts[i]->domain = 2;
            set->parts[i]->time_us += INT64_C(1700000000000000);
        }
    }
    return set;
}

int rs2_pipeline_try_wait_for_frames(rs2_pipeline *pipeline, rs2_frame **out, unsigned timeout_ms,
                                     rs2_error **error)
{
    (void)error;
    const stub_event event = stub_wait(&stub.fault, &pipeline->stream, (int)timeout_ms);
    if (event != STUB_FRAME) {
        return 0; /* the library says nothing of a pulled plug */
    }
    *out = make_set(pipeline);
    return 1;
}

int rs2_embedded_frames_count(rs2_frame *set, rs2_error **error)
{
    (void)error;
    return set->parts[1] != NULL ? 2 : 1;
}

rs2_frame *rs2_extract_frame(rs2_frame *set, int index, rs2_error **error)
{
    (void)error;
    set->parts[index]->references++;
    return set->parts[index];
}

void rs2_release_frame(rs2_frame *frame)
{
    if (--frame->references > 0) {
        return;
    }
    for (int i = 0; i < 2; i++) {
        if (frame->parts[i] != NULL) {
            rs2_release_frame(frame->parts[i]);
        }
    }
    free(frame->data);
    drop(frame);
}

const rs2_stream_profile *rs2_get_frame_stream_profile(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->profile;
}

unsigned long long rs2_get_frame_number(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->number;
}

double rs2_get_frame_timestamp(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return (double)frame->time_us / 1000.0;
}

int rs2_get_frame_timestamp_domain(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->domain;
}

int rs2_get_frame_width(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->profile->width;
}

int rs2_get_frame_height(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->profile->height;
}

int rs2_get_frame_stride_in_bytes(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->stride;
}

int rs2_get_frame_data_size(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->size;
}

const void *rs2_get_frame_data(const rs2_frame *frame, rs2_error **error)
{
    (void)error;
    return frame->data;
}
