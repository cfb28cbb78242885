/* RealSense cameras as a back end. */
#include "io/realsense/realsense.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <string.h>

static const io_symbol symbols[] = {
#define SYMBOL(result, name, parameters) {"rs2_" #name, offsetof(realsense_api, name), false},
#define OPTIONAL(result, name, parameters) {"rs2_" #name, offsetof(realsense_api, name), true},
    IO_REALSENSE_FUNCTIONS(SYMBOL) IO_REALSENSE_OPTIONAL_FUNCTIONS(OPTIONAL)
#undef SYMBOL
#undef OPTIONAL
};
/* The library's name carries its minor version, and one package has one version. */
static const char *const names[] = {"librealsense2.so.2.%d", "librealsense2.so", NULL};
static realsense_api functions;
static io_library library = {
    .variable = "RELIEF_REALSENSE2_LIBRARY",
    .names = names,
    .newest = 80,
    .oldest = 17,
    .cure = "install Intel's librealsense2, or name its file in RELIEF_REALSENSE2_LIBRARY",
    .symbols = symbols,
    .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0])),
    .table = &functions};

static const char *realsense_unavailable(void)
{
    return io_library_fault(&library);
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
    const realsense_api *api = &functions;
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
    io_live_count_tell(&((const realsense *)self)->count, out);
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
    result = result == RLF_OK ? take_device(r, list, serial) : result;
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
    result = result == RLF_OK ? io_mode_get(address, "color", &color) : result;
    if (result == RLF_OK) {
        result = find_device(r, serial != NULL ? serial : address->place);
    }
    result = result == RLF_OK ? io_realsense_start(r, &depth, &color) : result;
    result = result == RLF_OK ? io_live_use_rig(address, &r->rig) : result;
    return result == RLF_OK ? io_live_make_color(&r->rig, &r->color) : result;
}

static rlf_result realsense_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = io_realsense_next, .destroy = realsense_destroy, .status = realsense_status};
    realsense *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->api = &functions;
    snprintf(r->source, sizeof(r->source), "%.255s", address->source);
    rlf_result result = start(r, address);
    io_live_opened(&methods, r, r->source, &r->rig, r->frames_per_second, out);
    snprintf(out->info.device, sizeof(out->info.device), "librealsense2: %.60s %.40s", r->name,
             r->serial);
    return io_open_end(result, r, realsense_destroy);
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
