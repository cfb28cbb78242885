/* OpenNI2 devices: finding, opening, choosing modes. */
#include "io/live/driver.h"
#include "io/openni2/openni2.h"

#include <stdio.h>
#include <string.h>

#define RATE_WANTED 30

rlf_result openni2_read_wish(const rlf_address *address, openni2_wish *out)
{
    *out = (openni2_wish){.color = 1, .aligned = -1, .mirror = -1};
    if (address->rig != NULL) {
        out->width = address->rig->depth.width;
        out->height = address->rig->depth.height;
        out->color_width = address->rig->has_color ? address->rig->color.width : 0;
        out->color_height = address->rig->has_color ? address->rig->color.height : 0;
    }
    io_mode mode = {out->width, out->height, 0};
    rlf_result result = io_mode_get(address, "mode", &mode);
    out->width = mode.width;
    out->height = mode.height;
    out->fps = mode.frames_per_second;
    result = result == RLF_OK ? io_switch_get(address, "color", &out->color) : result;
    result = result == RLF_OK ? io_switch_get(address, "aligned", &out->aligned) : result;
    return result == RLF_OK ? io_switch_get(address, "mirror", &out->mirror) : result;
}

bool openni2_is_test_device(const openni2_info *info)
{
    return strcmp(info->uri, "Dummy") == 0;
}

int openni2_stream_int(const openni2_device *device, const openni2_stream *stream, int property,
                       int otherwise)
{
    int value = 0;
    int size = sizeof(value);
    const int status = device->api->stream_get(stream->handle, property, &value, &size);
    return status == OPENNI2_OK ? value : otherwise;
}

float openni2_stream_float(const openni2_device *device, const openni2_stream *stream, int property,
                           float otherwise)
{
    float value = 0;
    int size = sizeof(value);
    const int status = device->api->stream_get(stream->handle, property, &value, &size);
    return status == OPENNI2_OK ? value : otherwise;
}

static void read_serial(const openni2_api *api, void *handle, char out[OPENNI2_TEXT_MAX])
{
    int size = OPENNI2_TEXT_MAX;
    memset(out, 0, OPENNI2_TEXT_MAX);
    if (api->device_get(handle, OPENNI2_DEVICE_SERIAL, out, &size) != OPENNI2_OK) {
        out[0] = '\0';
    }
    out[OPENNI2_TEXT_MAX - 1] = '\0';
}

/* The URI of the device with this URI or serial number; "" = of the first that is no test device.
 * False = there is none. */
static bool find_uri(const openni2_api *api, const char *place, const openni2_info *devices,
                     int count, char out[OPENNI2_TEXT_MAX])
{
    for (int i = 0; i < count; i++) {
        const bool is_it = place[0] != '\0' ? strcmp(devices[i].uri, place) == 0
                                            : !openni2_is_test_device(&devices[i]);
        if (is_it) {
            memcpy(out, devices[i].uri, OPENNI2_TEXT_MAX);
            return true;
        }
    }
    for (int i = 0; i < count && place[0] != '\0'; i++) {
        void *handle = NULL;
        char serial[OPENNI2_TEXT_MAX];
        if (openni2_is_test_device(&devices[i]) ||
            api->device_open(devices[i].uri, &handle) != OPENNI2_OK) {
            continue;
        }
        read_serial(api, handle, serial);
        api->device_close(handle);
        if (strcmp(serial, place) == 0) {
            memcpy(out, devices[i].uri, OPENNI2_TEXT_MAX);
            return true;
        }
    }
    return false;
}

static rlf_result find_device(const openni2_api *api, const rlf_address *address,
                              char out_uri[OPENNI2_TEXT_MAX])
{
    openni2_info *devices = NULL;
    int count = 0;
    if (api->get_devices(&devices, &count) != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: OpenNI2 cannot list its devices", address->source);
    }
    const bool is_found = find_uri(api, address->place, devices, count, out_uri);
    api->release_devices(devices);
    if (!is_found) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: no such camera is plugged in: check the cable and the USB rules, "
                        "`relief list sources` lists what OpenNI2 sees",
                        address->source);
    }
    return RLF_OK;
}

static bool is_depth(int format)
{
    return format == OPENNI2_DEPTH_1_MM || format == OPENNI2_DEPTH_100_UM;
}

/* How well a mode fits; < 0 = not at all. Of what fits the wish the largest picture that comes at
 * 30 per second is best, in millimetres, which reach farther. */
static int64_t rate_mode(const openni2_mode *mode, const openni2_wish *wish, bool wants_depth)
{
    const bool is_readable = wants_depth ? is_depth(mode->format) : mode->format == OPENNI2_RGB888;
    if (!is_readable || mode->width < 1 || mode->height < 1 || mode->width > RLF_IMAGE_SIZE_MAX ||
        mode->height > RLF_IMAGE_SIZE_MAX ||
        (wish->width > 0 && (mode->width != wish->width || mode->height != wish->height)) ||
        (wish->fps > 0 && mode->fps != wish->fps)) {
        return -1;
    }
    const int64_t slow = mode->fps < RATE_WANTED ? RATE_WANTED - mode->fps : 0;
    const int64_t fast = mode->fps > RATE_WANTED ? 1 : 0;
    const int64_t pixels = (int64_t)mode->width * mode->height;
    return (64 - (slow < 64 ? slow : 64)) * (INT64_C(1) << 40) + pixels * 4 +
           (mode->format == OPENNI2_DEPTH_1_MM ? 2 : 0) + (1 - fast);
}

static bool choose_mode(const openni2_sensor *sensor, const openni2_wish *wish, bool wants_depth,
                        openni2_mode *out)
{
    int64_t best = -1;
    for (int i = 0; i < sensor->mode_count; i++) {
        const int64_t score = rate_mode(&sensor->modes[i], wish, wants_depth);
        if (score > best) {
            best = score;
            *out = sensor->modes[i];
        }
    }
    return best >= 0;
}

/* Colour at the depth picture's size where it comes so; else of any size. */
static bool choose_color(const openni2_sensor *sensor, const openni2_wish *wish,
                         const openni2_mode *depth, openni2_mode *out)
{
    const bool is_told = wish->color_width > 0;
    const openni2_wish wanted = {.fps = wish->fps,
                                 .width = is_told ? wish->color_width : depth->width,
                                 .height = is_told ? wish->color_height : depth->height};
    const openni2_wish any = {.fps = wish->fps};
    return choose_mode(sensor, &wanted, false, out) ||
           (!is_told && choose_mode(sensor, &any, false, out));
}

static void set_mirror(const openni2_device *device, const openni2_wish *wish,
                       openni2_stream *stream)
{
    const int off = 0;
    if (wish->mirror < 0) {
        (void)device->api->stream_set(stream->handle, OPENNI2_STREAM_MIRROR, &off, sizeof(off));
    }
    const int told = openni2_stream_int(device, stream, OPENNI2_STREAM_MIRROR, 0);
    stream->flips = wish->mirror >= 0 ? wish->mirror == 1 : told != 0;
}

static rlf_result open_stream(const rlf_address *address, const openni2_wish *wish,
                              openni2_device *device, bool wants_depth)
{
    const openni2_api *api = device->api;
    const char *what = wants_depth ? "depth" : "colour";
    const int type = wants_depth ? OPENNI2_DEPTH : OPENNI2_COLOR;
    openni2_stream *stream = wants_depth ? &device->depth : &device->color;
    const openni2_sensor *sensor = api->device_sensor(device->handle, type);
    if (sensor == NULL || api->device_stream(device->handle, type, &stream->handle) != OPENNI2_OK) {
        stream->handle = NULL;
        return rlf_fail(RLF_ERROR_DEVICE, "%s: has no %s stream", address->source, what);
    }
    int size = sizeof(stream->mode);
    if (!(wants_depth ? choose_mode(sensor, wish, true, &stream->mode)
                      : choose_color(sensor, wish, &device->depth.mode, &stream->mode))) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the camera has no such %s mode: leave mode= out, or give a size and "
                        "rate that it has",
                        address->source, what);
    }
    if (api->stream_set(stream->handle, OPENNI2_STREAM_MODE, &stream->mode, size) != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera refuses %dx%d@%d for %s: %.200s",
                        address->source, stream->mode.width, stream->mode.height, stream->mode.fps,
                        what, api->error());
    }
    set_mirror(device, wish, stream);
    return RLF_OK;
}

/* Depth warped into the colour camera by the device. Without a calibration of the user's this is
 * the only way to know how the two cameras stand. */
static rlf_result set_aligned(const rlf_address *address, const openni2_wish *wish,
                              openni2_device *device)
{
    const bool has_color = device->color.handle != NULL;
    const bool can = device->api->device_can_register(device->handle, 1) != 0;
    if (wish->aligned == 1 && has_color && !can) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the camera cannot align depth with colour: leave aligned=1 out and "
                        "give a calibration with ?camera=FILE",
                        address->source);
    }
    const bool is_best = can && address->rig == NULL;
    const int wanted = has_color && (wish->aligned >= 0 ? wish->aligned == 1 : is_best) ? 1 : 0;
    if (can && device->api->device_set(device->handle, OPENNI2_DEVICE_REGISTRATION, &wanted,
                                       sizeof(wanted)) != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera refuses aligned=%d: %.200s",
                        address->source, wanted, device->api->error());
    }
    device->can_align = can;
    device->is_aligned = wanted != 0;
    return RLF_OK;
}

static rlf_result open_streams(const rlf_address *address, const openni2_wish *wish,
                               openni2_device *device)
{
    rlf_result result = open_stream(address, wish, device, true);
    if (result != RLF_OK) {
        return result;
    }
    if (wish->color == 1 && device->api->device_sensor(device->handle, OPENNI2_COLOR) != NULL) {
        result = open_stream(address, wish, device, false);
    }
    return result == RLF_OK ? set_aligned(address, wish, device) : result;
}

rlf_result openni2_device_open(const rlf_address *address, const openni2_wish *wish,
                               openni2_device *device)
{
    const openni2_api *api = device->api;
    char uri[OPENNI2_TEXT_MAX] = "";
    rlf_result result = find_device(api, address, uri);
    if (result != RLF_OK) {
        return result;
    }
    if (api->device_open(uri, &device->handle) != OPENNI2_OK) {
        device->handle = NULL;
        return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera cannot be opened: %.300s",
                        address->source, api->error());
    }
    (void)api->device_info(device->handle, &device->info);
    read_serial(api, device->handle, device->serial);
    return open_streams(address, wish, device);
}

rlf_result openni2_device_start(const rlf_address *address, openni2_device *device)
{
    void *const streams[2] = {device->depth.handle, device->color.handle};
    for (int i = 0; i < 2; i++) {
        if (streams[i] != NULL && device->api->stream_start(streams[i]) != OPENNI2_OK) {
            return rlf_fail(RLF_ERROR_DEVICE, "%s: the %s stream does not start: %.300s",
                            address->source, i == 0 ? "depth" : "colour", device->api->error());
        }
    }
    return RLF_OK;
}

void openni2_device_close(openni2_device *device)
{
    openni2_stream *const streams[2] = {&device->color, &device->depth};
    for (int i = 0; i < 2; i++) {
        if (streams[i]->handle != NULL) {
            device->api->stream_stop(streams[i]->handle);
            device->api->stream_destroy(streams[i]->handle);
            streams[i]->handle = NULL;
        }
    }
    if (device->handle != NULL) {
        device->api->device_close(device->handle);
        device->handle = NULL;
    }
}

/* ---- cameras of the open streams --------------------------------------------------------- */

#define DEPTH_LIMIT_M 20.0 /* what a device says beyond this is no depth */

double openni2_units(const openni2_device *device)
{
    return device->depth.mode.format == OPENNI2_DEPTH_100_UM ? 10000.0 : 1000.0;
}

/* Returns whether the stream tells its field of view. */
static bool camera_of(const openni2_device *device, const openni2_stream *stream,
                      const openni2_stream *size, rlf_camera *out)
{
    return io_camera_from_fov(size->mode.width, size->mode.height,
                              openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_X, 0.0f),
                              openni2_stream_float(device, stream, OPENNI2_STREAM_FOV_Y, 0.0f),
                              out);
}

/* Depth that is warped into the colour camera has the colour camera's lens. Returns whether the
 * device tells its field of view. */
static bool cameras_of(const openni2_device *device, rlf_rig *out)
{
    const openni2_stream *depth = &device->depth;
    const openni2_stream *color = &device->color;
    const bool is_told = camera_of(device, depth, depth, &out->depth);
    out->has_color = color->handle != NULL;
    if (out->has_color && !camera_of(device, color, color, &out->color) && is_told) {
        (void)camera_of(device, depth, color, &out->color);
    }
    if (device->is_aligned) {
        out->depth = rlf_camera_resize(&out->color, depth->mode.width, depth->mode.height);
    }
    return is_told;
}

static void warn(const char *source, const openni2_device *device, bool has_color, bool is_told)
{
    if (has_color && !device->is_aligned) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the depth pictures are not aligned with colour, and OpenNI2 does not tell "
                "how the two cameras stand: give a calibration with ?camera=FILE%s",
                source, device->can_align ? ", or leave aligned=0 out" : "");
    }
    if (!is_told) {
        rlf_log(RLF_LOG_WARNING,
                "%s: does not tell its field of view: 58 degrees are taken; give a calibration "
                "with ?camera=FILE",
                source);
    }
}

rlf_result openni2_make_rig(const rlf_address *address, const openni2_device *device, rlf_rig *out)
{
    *out = rlf_rig_default();
    const bool is_told = cameras_of(device, out);
    if (address->rig == NULL) {
        warn(address->source, device, out->has_color, is_told);
    }
    const double farthest =
        openni2_stream_int(device, &device->depth, OPENNI2_STREAM_MAX, 0) / openni2_units(device);
    if (farthest > out->depth_min_m && farthest < DEPTH_LIMIT_M) {
        out->depth_max_m = farthest;
    }
    return io_live_use_rig(address, out);
}
