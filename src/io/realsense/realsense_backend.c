/* RealSense cameras as a back end. */
#include "io/realsense/realsense.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <string.h>

static const char *realsense_unavailable(void)
{
    const char *reason;
    io_realsense_api(&reason);
    return reason;
}

static void copy_info(const realsense_api *api, const rs2_device *device, int info, char out[64])
{
    rs2_error *error = NULL;
    out[0] = '\0';
    if (api->supports_device_info(device, info, &error) != 0 && error == NULL) {
        const char *text = api->get_device_info(device, info, &error);
        snprintf(out, 64, "%.63s", error == NULL && text != NULL ? text : "");
    }
    io_realsense_forget(api, &error);
}

static rs2_context *make_context(const realsense_api *api, rs2_error **error)
{
    /* Any version of the library is served with its own. */
    const int version = api->get_api_version(error);
    return *error == NULL ? api->create_context(version, error) : NULL;
}

static int32_t list_devices(const realsense_api *api, const rs2_device_list *list,
                            rlf_source_entry *out, int32_t capacity)
{
    rs2_error *error = NULL;
    const int count = api->get_device_count(list, &error);
    int32_t found = 0;
    for (int i = 0; i < count && error == NULL; i++) {
        rs2_device *device = api->create_device(list, i, &error);
        if (error != NULL) {
            break;
        }
        char name[64];
        char serial[64];
        copy_info(api, device, RS2_INFO_NAME, name);
        copy_info(api, device, RS2_INFO_SERIAL_NUMBER, serial);
        api->delete_device(device);
        if (found < capacity) {
            snprintf(out[found].source, sizeof(out[found].source), "realsense:%s", serial);
            snprintf(out[found].description, sizeof(out[found].description), "%.63s, serial %.40s",
                     name, serial);
        }
        found++;
    }
    io_realsense_forget(api, &error);
    return found;
}

static int32_t realsense_list(rlf_source_entry *out, int32_t capacity)
{
    const char *reason;
    const realsense_api *api = io_realsense_api(&reason);
    if (api == NULL) {
        return 0;
    }
    rs2_error *error = NULL;
    int32_t count = 0;
    rs2_context *context = make_context(api, &error);
    if (error == NULL) {
        rs2_device_list *list = api->query_devices(context, &error);
        if (error == NULL) {
            count = list_devices(api, list, out, capacity);
            api->delete_device_list(list);
        }
    }
    if (context != NULL) {
        api->delete_context(context);
    }
    io_realsense_forget(api, &error);
    return count;
}

static void realsense_status(void *self, rlf_source_status *out)
{
    const realsense *r = self;
    out->lost = r->count.lost;
    out->doubled = r->count.doubled;
    out->unpaired = r->unpaired;
    out->damaged = r->damaged;
}

static void realsense_destroy(void *self)
{
    realsense *r = self;
    rs2_error *error = NULL;
    if (r->held != NULL) {
        r->api->release_frame(r->held);
    }
    if (r->is_streaming) {
        r->api->pipeline_stop(r->pipeline, &error);
        io_realsense_forget(r->api, &error);
    }
    if (r->pipeline != NULL) {
        r->api->delete_pipeline(r->pipeline);
    }
    if (r->device != NULL) {
        r->api->delete_device(r->device);
    }
    if (r->context != NULL) {
        r->api->delete_context(r->context);
    }
    rlf_free(r->color.data);
    rlf_free(r);
}

/* Takes the device with this serial number, or the first one when it is "". */
static rlf_result take_device(realsense *r, const rs2_device_list *list, const char *serial)
{
    rs2_error *error = NULL;
    const int count = r->api->get_device_count(list, &error);
    for (int i = 0; i < count && error == NULL; i++) {
        rs2_device *device = r->api->create_device(list, i, &error);
        if (error != NULL) {
            break;
        }
        copy_info(r->api, device, RS2_INFO_NAME, r->name);
        copy_info(r->api, device, RS2_INFO_SERIAL_NUMBER, r->serial);
        if (serial[0] == '\0' || strcmp(serial, r->serial) == 0) {
            r->device = device;
            return RLF_OK;
        }
        r->api->delete_device(device);
    }
    if (error != NULL) {
        return io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "%s: no RealSense camera%s%.64s is plugged in (%d others are): plug it in, or "
                    "see `relief list sources`",
                    r->source, serial[0] != '\0' ? " with serial number " : "", serial, count);
}

static rlf_result find_device(realsense *r, const char *serial)
{
    rs2_error *error = NULL;
    r->context = make_context(r->api, &error);
    rs2_device_list *list = error == NULL ? r->api->query_devices(r->context, &error) : NULL;
    rlf_result result = io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source,
                                           "check the permissions of /dev/bus/usb");
    if (result == RLF_OK) {
        result = take_device(r, list, serial);
    }
    if (list != NULL) {
        r->api->delete_device_list(list);
    }
    return result;
}

static rlf_result start(realsense *r, const rlf_address *address)
{
    io_mode depth = {0};
    io_mode color = {0};
    const char *serial = rlf_address_get(address, "serial");
    rlf_result result = io_mode_get(address, "mode", &depth);
    if (result == RLF_OK) {
        result = io_mode_get(address, "color", &color);
    }
    if (result == RLF_OK) {
        result = find_device(r, serial != NULL ? serial : address->place);
    }
    if (result == RLF_OK) {
        result = io_realsense_start(r, &depth, &color);
    }
    if (result == RLF_OK) {
        result = io_live_use_rig(address, &r->rig);
    }
    if (result == RLF_OK && r->rig.has_color) {
        const rlf_camera *c = &r->rig.color;
        uint8_t *data = rlf_alloc_array((size_t)c->width * (size_t)c->height, 4);
        r->color = (rlf_image_rgba8){data, c->width, c->height, (ptrdiff_t)c->width * 4};
        result = data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    return result;
}

static void describe(const realsense *r, rlf_opened *out)
{
    memset(out, 0, sizeof(*out));
    out->methods = (rlf_source_methods){
        .next = io_realsense_next, .destroy = realsense_destroy, .status = realsense_status};
    snprintf(out->info.name, sizeof(out->info.name), "%.127s", r->source);
    out->info.rig = r->rig;
    out->info.frame_count = -1;
    out->info.frames_per_second = r->frames_per_second;
    out->info.is_live = true;
    snprintf(out->info.device, sizeof(out->info.device), "librealsense2: %.60s %.40s", r->name,
             r->serial);
}

static rlf_result realsense_open(const rlf_address *address, rlf_opened *out)
{
    const char *reason;
    const realsense_api *api = io_realsense_api(&reason);
    if (api == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED, "%s: %s", address->source, reason);
    }
    realsense *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->api = api;
    snprintf(r->source, sizeof(r->source), "%.255s", address->source);
    rlf_result result = start(r, address);
    if (result != RLF_OK) {
        realsense_destroy(r);
        return result;
    }
    describe(r, out);
    out->self = r;
    return RLF_OK;
}

const rlf_backend io_backend_realsense = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "realsense",
    .keys = "serial mode color",
    .summary = "Intel RealSense: realsense:SERIAL?mode=848x480@30&color=1280x720@30",
    .is_live = true,
    .unavailable = realsense_unavailable,
    .list = realsense_list,
    .open = realsense_open,
};
