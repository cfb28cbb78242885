/* Kinect v2 through libfreenect2, behind the C functions of freenect2_shim.h. */
#include "io/live/driver.h"
#include "io/freenect2/freenect2.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <string.h>

static freenect2_api functions;

static const char *check_version(void)
{
    return functions.version() == RELIEF_FREENECT2_VERSION
               ? NULL
               : "librelief_freenect2.so is of another version of Relief: "
                 "install both from one build";
}

static const io_symbol symbols[] = {
#define SYMBOL(result, name, parameters)                                                           \
    {"relief_freenect2_" #name, offsetof(freenect2_api, name), false},
    RELIEF_FREENECT2_FUNCTIONS(SYMBOL)
#undef SYMBOL
};
static const char *const names[] = {"librelief_freenect2.so", RLF_FREENECT2_SHIM_PATH, NULL};
static io_library library = {
    .variable = "RELIEF_FREENECT2_LIBRARY",
    .names = names,
    .cure = "build libfreenect2 from source (github.com/OpenKinect/libfreenect2, not in "
            "Debian), then `cmake --preset release -DRELIEF_WITH_FREENECT2=ON` and build again",
    .symbols = symbols,
    .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0])),
    .table = &functions,
    .check = check_version};

static const char *freenect2_unavailable(void)
{
    return io_library_fault(&library);
}

static int32_t freenect2_list(rlf_source_entry *out, int32_t capacity)
{
    const int count = functions.count();
    for (int32_t i = 0; i < count && i < capacity; i++) {
        char serial[64] = "";
        functions.serial(i, serial, sizeof(serial));
        snprintf(out[i].source, sizeof(out[i].source), "freenect2:%s", serial);
        snprintf(out[i].description, sizeof(out[i].description), "Kinect v2, serial %s", serial);
    }
    return count;
}

static void freenect2_status(void *self, rlf_source_status *out)
{
    io_live_count_tell(&((const freenect2 *)self)->count, out);
}

static void freenect2_destroy(void *self)
{
    freenect2 *k = self;
    if (k->device != NULL) {
        k->api->close(k->device);
    }
    rlf_free(k->depth);
    rlf_free(k->undistorted);
    rlf_free(k->registered);
    rlf_free(k->color.data);
    rlf_free(k);
}

/* align=factory: the pictures that libfreenect2's Registration makes, for work that is compared
 * with it. The colour is then that of the depth pixels. */
static rlf_result read_align(freenect2 *k, const rlf_address *address)
{
    const char *align = rlf_address_get(address, "align");
    k->is_aligned = align != NULL && strcmp(align, "factory") == 0;
    return align == NULL || k->is_aligned || strcmp(align, "none") == 0
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID, "%s: align is \"%.40s\": use none or factory",
                          address->source, align);
}

static rlf_result open_device(freenect2 *k, const rlf_address *address)
{
    char cause[160] = "";
    const char *serial = rlf_address_get(address, "serial");
    serial = serial != NULL ? serial : address->place;
    k->device = k->api->open(serial, cause, sizeof(cause));
    if (k->device == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: %s: plug it into USB 3, close other programs that use it, and see "
                        "`relief list sources`",
                        address->source, cause);
    }
    relief_freenect2_calibration calibration;
    memset(&calibration, 0, sizeof(calibration));
    k->api->get_calibration(k->device, &calibration);
    memcpy(&k->ir, calibration.ir, sizeof(k->ir));
    memcpy(&k->factory, calibration.color, sizeof(k->factory));
    return RLF_OK;
}

static rlf_result make_rig(freenect2 *k, const rlf_address *address)
{
    kinect2_fit fit = {0};
    rlf_result result = kinect2_rig_fit(&k->ir, &k->factory, &k->rig, &fit);
    if (result != RLF_OK) {
        return result;
    }
    if (k->is_aligned) {
        k->rig.depth = kinect2_undistorted_camera(&k->ir);
        k->rig.color = k->rig.depth;
        k->rig.T_color_depth = rlf_pose_identity();
    } else {
        rlf_log(RLF_LOG_INFO,
                "%s: the colour camera fits the factory's mapping to %.2f pixels rms, %.1f at "
                "worst",
                address->source, fit.rms_px, fit.worst_px);
    }
    return result == RLF_OK ? io_live_use_rig(address, &k->rig) : result;
}

static rlf_result allocate(freenect2 *k)
{
    const rlf_rig pictures = {.color = k->rig.color, .has_color = true}; /* also where not used */
    rlf_result result = io_live_make_color(&pictures, &k->color);
    k->depth = rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(k->depth[0]));
    bool is_complete = result == RLF_OK && k->depth != NULL;
    if (k->is_aligned) {
        k->undistorted = rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(k->undistorted[0]));
        k->registered = rlf_alloc_array(KINECT2_DEPTH_PIXELS, sizeof(k->registered[0]));
        is_complete = is_complete && k->undistorted != NULL && k->registered != NULL;
    }
    return is_complete ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result freenect2_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = io_freenect2_next, .destroy = freenect2_destroy, .status = freenect2_status};
    freenect2 *k = rlf_alloc(sizeof(*k));
    if (k == NULL) {
        return RLF_ERROR_MEMORY;
    }
    k->api = &functions;
    k->count.interval_ns = 1000000000 / 30;
    snprintf(k->source, sizeof(k->source), "%.255s", address->source);
    rlf_result result = read_align(k, address);
    result = result == RLF_OK ? open_device(k, address) : result;
    result = result == RLF_OK ? make_rig(k, address) : result;
    result = result == RLF_OK ? allocate(k) : result;
    k->last_frame_ns = rlf_clock_ns();
    io_live_opened(&methods, k, k->source, &k->rig, 30.0, out);
    snprintf(out->info.device, sizeof(out->info.device), "libfreenect2: Kinect v2");
    return io_open_end(result, k, freenect2_destroy);
}

const rlf_backend io_backend_freenect2 = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "freenect2",
    .keys = "serial align",
    .summary = "Kinect v2 through libfreenect2: freenect2:SERIAL?align=factory",
    .is_live = true,
    .unavailable = freenect2_unavailable,
    .list = freenect2_list,
    .open = freenect2_open,
};
