/* Azure Kinect and Femto cameras as a back end. */
#include "io/k4a/k4a.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <string.h>

static const io_symbol symbols[] = {
#define SYMBOL(result, name, parameters) {"k4a_" #name, offsetof(k4a_api, name), false},
    IO_K4A_FUNCTIONS(SYMBOL)
#undef SYMBOL
};
static const char *const names[] = {"libk4a.so.1.4", "libk4a.so.1.3", "libk4a.so", NULL};
static k4a_api functions;
static io_library library = {
    .variable = "RELIEF_K4A_LIBRARY",
    .names = names,
    .cure = "install the Azure Kinect SDK, or Orbbec's K4A wrapper for Femto Bolt and Mega, or "
            "name its file in RELIEF_K4A_LIBRARY",
    .symbols = symbols,
    .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0])),
    .table = &functions};

static const char *k4a_unavailable(void)
{
    return io_library_fault(&library);
}

static void read_serial(const k4a_api *api, k4a_device_t device, char out[64])
{
    size_t size = 64;
    if (api->device_get_serialnum(device, out, &size) != K4A_SUCCEEDED) {
        out[0] = '\0';
    }
    out[63] = '\0';
}

/* Only an open camera tells its serial number; another program may have it. */
static int32_t k4a_list(rlf_source_entry *out, int32_t capacity)
{
    const k4a_api *api = &functions;
    const uint32_t count = api->device_get_installed_count();
    for (uint32_t i = 0; i < count && (int64_t)i < capacity; i++) {
        char serial[64] = "";
        k4a_device_t device = NULL;
        const bool is_open = api->device_open(i, &device) == K4A_SUCCEEDED;
        if (is_open) {
            read_serial(api, device, serial);
            api->device_close(device);
        }
        snprintf(out[i].source, sizeof(out[i].source), "k4a:%s", serial);
        snprintf(out[i].description, sizeof(out[i].description),
                 is_open ? "Azure Kinect or Femto, serial %.63s"
                         : "Azure Kinect or Femto, in use by another program%.63s",
                 serial);
    }
    return (int32_t)count;
}

static void k4a_status(void *self, rlf_source_status *out)
{
    io_live_count_tell(&((const k4a *)self)->count, out);
}

static void k4a_destroy(void *self)
{
    k4a *k = self;
    if (k->held != NULL) {
        k->api->image_release(k->held);
    }
    if (k->is_streaming) {
        k->api->device_stop_cameras(k->device);
    }
    if (k->device != NULL) {
        k->api->device_close(k->device);
    }
    rlf_free(k->color.data);
    rlf_free(k);
}

/* Opens the camera with this serial number, or the first that can be opened when it is "". */
static rlf_result open_device(k4a *k, const char *serial)
{
    const uint32_t count = k->api->device_get_installed_count();
    for (uint32_t i = 0; i < count; i++) {
        if (k->api->device_open(i, &k->device) != K4A_SUCCEEDED) {
            k->device = NULL;
            continue;
        }
        read_serial(k->api, k->device, k->serial);
        if (serial[0] == '\0' || strcmp(serial, k->serial) == 0) {
            return RLF_OK;
        }
        k->api->device_close(k->device);
        k->device = NULL;
    }
    return rlf_fail(RLF_ERROR_DEVICE,
                    "%s: no Azure Kinect or Femto camera%s%.64s can be opened (%u are plugged in): "
                    "plug it in with its own power, close other programs that use it",
                    k->source, serial[0] != '\0' ? " with serial number " : "", serial,
                    (unsigned)count);
}

static rlf_result start(k4a *k, const rlf_address *address)
{
    io_mode depth = {0};
    io_mode color = {0};
    const char *serial = rlf_address_get(address, "serial");
    rlf_result result = io_mode_get(address, "mode", &depth);
    result = result == RLF_OK ? io_mode_get(address, "color", &color) : result;
    result = result == RLF_OK ? io_k4a_configure(k, &depth, &color) : result;
    result = result == RLF_OK ? open_device(k, serial != NULL ? serial : address->place) : result;
    result = result == RLF_OK ? io_k4a_read_rig(k) : result;
    result = result == RLF_OK ? io_live_use_rig(address, &k->rig) : result;
    result = result == RLF_OK ? io_live_make_color(&k->rig, &k->color) : result;
    if (result != RLF_OK) {
        return result;
    }
    /* Depth without colour is a frame too: the colour camera slows down in the dark. */
    k->is_streaming = k->api->device_start_cameras(k->device, &k->configuration) == K4A_SUCCEEDED;
    return k->is_streaming
               ? RLF_OK
               : rlf_fail(RLF_ERROR_DEVICE,
                          "%s: the camera %s does not start: plug it into USB 3 with its own "
                          "power, and see that the depth engine is installed",
                          k->source, k->serial);
}

static rlf_result k4a_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = io_k4a_next, .destroy = k4a_destroy, .status = k4a_status};
    k4a *k = rlf_alloc(sizeof(*k));
    if (k == NULL) {
        return RLF_ERROR_MEMORY;
    }
    k->api = &functions;
    snprintf(k->source, sizeof(k->source), "%.255s", address->source);
    rlf_result result = start(k, address);
    io_live_opened(&methods, k, k->source, &k->rig, k->frames_per_second, out);
    snprintf(out->info.device, sizeof(out->info.device), "k4a: serial %s", k->serial);
    return io_open_end(result, k, k4a_destroy);
}

const rlf_backend io_backend_k4a = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "k4a",
    .keys = "serial mode color",
    .summary = "Azure Kinect, Femto Bolt and Mega: k4a:SERIAL?mode=640x576@30&color=1280x720",
    .is_live = true,
    .unavailable = k4a_unavailable,
    .list = k4a_list,
    .open = k4a_open,
};
