/* Kinect v1 through libfreenect. */
#include "io/live/driver.h"
#include "io/freenect/freenect.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EVENTS_MS 20 /* in the library at a time */
#define RATE 30.0
/* The device counts 60 ticks a microsecond: 50 / 3 nanoseconds a tick. */
#define NS_NUMERATOR 50
#define NS_DENOMINATOR 3

static const io_symbol symbols[] = {
#define SYMBOL(result, member, name, parameters)                                                   \
    {"freenect_" name, offsetof(freenect_api, member), false},
#define OPTIONAL(result, member, name, parameters)                                                 \
    {"freenect_" name, offsetof(freenect_api, member), true},
    FREENECT_FUNCTIONS(SYMBOL) FREENECT_OPTIONAL_FUNCTIONS(OPTIONAL)
#undef SYMBOL
#undef OPTIONAL
};

static const char *const names[] = {"libfreenect.so.0.5", "libfreenect.so.0", NULL};
static freenect_api functions;
static io_library library = {
    .variable = "RELIEF_FREENECT_LIBRARY",
    .names = names,
    .cure = "apt install libfreenect0.5, or name its file in RELIEF_FREENECT_LIBRARY",
    .symbols = symbols,
    .symbol_count = (int32_t)(sizeof(symbols) / sizeof(symbols[0])),
    .table = &functions};

typedef struct kinect {
    char source[512];
    const freenect_api *api;
    void *context, *device;
    bool has_color, is_aligned, flips, is_gone;
    rlf_rig rig;
    io_stream_pair pair;
    uint32_t last_ticks; /* of either stream */
    int64_t ticks;       /* the same, counted on */
    bool has_ticks;
    uint16_t depth_mm[FREENECT_RAW_COUNT];
} kinect;

/* The counter wraps every 71 s; both streams share it, and their pictures come nearly in turn. */
static int64_t time_of(kinect *k, uint32_t ticks)
{
    if (!k->has_ticks) {
        k->ticks = ticks;
        k->has_ticks = true;
    } else {
        k->ticks += (int32_t)(ticks - k->last_ticks);
    }
    k->last_ticks = ticks;
    return k->ticks * NS_NUMERATOR / NS_DENOMINATOR;
}

static void on_depth(void *device, void *picture, uint32_t ticks)
{
    kinect *k = functions.get_user(device);
    const uint16_t *in = picture;
    uint16_t *out = io_stream_pair_depth(&k->pair);
    for (int y = 0; y < FREENECT_HEIGHT; y++) {
        uint16_t *row = out + (ptrdiff_t)y * FREENECT_WIDTH;
        io_depth_row(in + (ptrdiff_t)y * FREENECT_WIDTH, FREENECT_WIDTH, k->flips, row);
        for (int x = 0; x < FREENECT_WIDTH && !k->is_aligned; x++) {
            row[x] = row[x] < FREENECT_RAW_COUNT ? k->depth_mm[row[x]] : 0;
        }
    }
    io_stream_pair_push_depth(&k->pair, time_of(k, ticks), -1);
}

static void on_video(void *device, void *picture, uint32_t ticks)
{
    kinect *k = functions.get_user(device);
    const rlf_image_rgba8 out = io_stream_pair_color(&k->pair);
    for (int y = 0; y < FREENECT_HEIGHT; y++) {
        io_rgb_row((const uint8_t *)picture + (ptrdiff_t)y * FREENECT_WIDTH * 3, FREENECT_WIDTH,
                   k->flips, rlf_rgba8_row(&out, y));
    }
    io_stream_pair_push_color(&k->pair, time_of(k, ticks));
}

static void on_log(void *context, int level, const char *line)
{
    (void)context;
    (void)level;
    rlf_log(RLF_LOG_INFO, "libfreenect: %.*s", (int)strcspn(line, "\n"), line);
}

static rlf_result fail_gone(kinect *k)
{
    k->is_gone = true;
    k->pair.status.is_connected = false;
    return rlf_fail(RLF_ERROR_DEVICE,
                    "%s: the Kinect is gone: plug it in again, with its own power supply",
                    k->source);
}

/* The library's events call on_depth and on_video. One call may bring two depth pictures at most:
 * they come 33 ms apart. */
static rlf_result pump(void *self, int32_t wait_ms)
{
    kinect *k = self;
    struct timeval timeout = {0, (wait_ms < EVENTS_MS ? wait_ms : EVENTS_MS) * 1000};
    return k->is_gone || k->api->process(k->context, &timeout) < 0 ? fail_gone(k) : RLF_OK;
}

static rlf_result kinect_next(void *self, rlf_frame *out)
{
    return io_stream_pair_next(&((kinect *)self)->pair, pump, self, out);
}

static void kinect_status(void *self, rlf_source_status *out)
{
    *out = ((const kinect *)self)->pair.status;
}

static void kinect_destroy(void *self)
{
    kinect *k = self;
    if (k->device != NULL) {
        (void)k->api->stop_depth(k->device);
        (void)k->api->stop_video(k->device);
        (void)k->api->close(k->device);
    }
    if (k->context != NULL) {
        (void)k->api->shutdown(k->context);
    }
    io_stream_pair_finish(&k->pair);
    rlf_free(k);
}

static rlf_result open_context(kinect *k, const char *source)
{
    k->api = &functions;
    if (k->api->init(&k->context, NULL) < 0) {
        k->context = NULL;
        return rlf_fail(RLF_ERROR_DEVICE, "%s: libfreenect cannot use USB", source);
    }
    k->api->set_log(k->context, on_log);
    k->api->select_subdevices(k->context, FREENECT_CAMERA);
    return RLF_OK;
}

static rlf_result open_device(kinect *k, const rlf_address *address)
{
    const int count = k->api->count_devices(k->context);
    if (count < 1) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: no Kinect is plugged in: check its cable and its power supply",
                        address->source);
    }
    const char *place = address->place;
    char *end = NULL;
    const long index = strtol(place, &end, 10);
    const bool is_index = *end == '\0' && strlen(place) < 3;
    const int status = is_index ? k->api->open(k->context, &k->device, (int)index)
                                : k->api->open_serial(k->context, &k->device, place);
    if (status < 0 || k->device == NULL) {
        k->device = NULL;
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: the Kinect cannot be opened: check the number or serial number "
                        "(`relief list sources`), that no other program uses it, and the kernel's "
                        "driver gspca_kinect",
                        address->source);
    }
    k->api->set_user(k->device, k);
    return RLF_OK;
}

static rlf_result read_keys(kinect *k, const rlf_address *address)
{
    int color = 1, aligned = 0, mirror = 0;
    rlf_result result = io_switch_get(address, "color", &color);
    result = result == RLF_OK ? io_switch_get(address, "aligned", &aligned) : result;
    result = result == RLF_OK ? io_switch_get(address, "mirror", &mirror) : result;
    k->has_color = color == 1;
    k->is_aligned = aligned == 1;
    k->flips = mirror == 1;
    return result;
}

/* Depth warped by the library lies in the colour camera. */
static void use_factory(kinect *k, const rlf_address *address, const freenect_registration *r)
{
    double error = -1.0;
    freenect_make_rig(r, &k->rig, &error);
    k->rig.has_color = k->has_color;
    if (k->is_aligned) {
        k->rig.depth = k->rig.color;
        k->rig.T_color_depth = rlf_pose_identity();
    }
    if (address->rig != NULL) {
        return;
    }
    if (error < 0.0) {
        rlf_log(RLF_LOG_WARNING,
                "%s: the factory's calibration cannot be read: that of a typical Kinect is taken; "
                "give your own with ?camera=FILE",
                address->source);
    } else {
        rlf_log(RLF_LOG_INFO, "%s: factory calibration, fitted to %.1f colour pixels",
                address->source, error);
    }
}

static rlf_result make_rig(kinect *k, const rlf_address *address)
{
    freenect_registration r = {0};
    const bool has = k->api->copy_registration != NULL && k->api->destroy_registration != NULL;
    if (k->is_aligned && !has) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: this libfreenect cannot align depth with colour: leave aligned=1 out",
                        address->source);
    }
    if (has) {
        r = k->api->copy_registration(k->device);
    }
    freenect_depth_table(has ? &r : NULL, k->depth_mm);
    use_factory(k, address, has ? &r : NULL);
    if (has) {
        (void)k->api->destroy_registration(&r);
    }
    return io_live_use_rig(address, &k->rig);
}

static rlf_result start(kinect *k, const rlf_address *address)
{
    const freenect_api *api = k->api;
    const freenect_mode depth =
        api->find_depth(FREENECT_MEDIUM, k->is_aligned ? FREENECT_REGISTERED : FREENECT_RAW_11);
    const freenect_mode video = api->find_video(FREENECT_MEDIUM, FREENECT_RGB);
    const bool is_usable = depth.is_valid != 0 && depth.width == FREENECT_WIDTH &&
                           depth.height == FREENECT_HEIGHT && video.is_valid != 0 &&
                           video.width == FREENECT_WIDTH && video.height == FREENECT_HEIGHT;
    api->on_depth(k->device, on_depth);
    api->on_video(k->device, on_video);
    if (!is_usable || api->set_depth(k->device, depth) < 0 || api->start_depth(k->device) < 0 ||
        (k->rig.has_color &&
         (api->set_video(k->device, video) < 0 || api->start_video(k->device) < 0))) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "%s: the Kinect does not start: a USB 2 port of its own, and its power "
                        "supply, are what it needs",
                        address->source);
    }
    return RLF_OK;
}

static rlf_result open_all(kinect *k, const rlf_address *address)
{
    rlf_result result = read_keys(k, address);
    result = result == RLF_OK ? open_context(k, address->source) : result;
    result = result == RLF_OK ? open_device(k, address) : result;
    result = result == RLF_OK ? make_rig(k, address) : result;
    if (result == RLF_OK) {
        result = io_stream_pair_init(&k->pair, &k->rig, FREENECT_UNITS_PER_METRE, RATE);
        k->pair.flags = (k->flips ? (uint32_t)RLF_FRAME_UNMIRRORED : 0u) |
                        (k->is_aligned ? (uint32_t)RLF_FRAME_ALIGNED : 0u);
    }
    return result == RLF_OK ? start(k, address) : result;
}

static rlf_result kinect_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = kinect_next, .destroy = kinect_destroy, .status = kinect_status};
    kinect *k = rlf_alloc(sizeof(*k));
    if (k == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(k->source, sizeof(k->source), "%.511s", address->source);
    rlf_result result = open_all(k, address);
    io_live_opened(&methods, k, k->source, &k->rig, RATE, out);
    snprintf(out->info.device, sizeof(out->info.device), "Kinect v1 (libfreenect)");
    return io_open_end(result, k, kinect_destroy);
}

static void describe(rlf_source_entry *entry, int32_t index, const char *serial)
{
    if (serial != NULL && serial[0] != '\0') {
        snprintf(entry->source, sizeof(entry->source), "freenect:%.200s", serial);
        snprintf(entry->description, sizeof(entry->description), "Kinect v1, serial %.80s", serial);
    } else {
        snprintf(entry->source, sizeof(entry->source), "freenect:%d", (int)index);
        snprintf(entry->description, sizeof(entry->description), "Kinect v1");
    }
}

static int32_t kinect_list(rlf_source_entry *out, int32_t capacity)
{
    kinect k = {0};
    if (open_context(&k, "freenect:") != RLF_OK) {
        return 0;
    }
    const int32_t count = k.api->count_devices(k.context);
    freenect_attributes *list = NULL;
    if (k.api->list_attributes != NULL && k.api->free_attributes != NULL &&
        k.api->list_attributes(k.context, &list) < 0) {
        list = NULL;
    }
    const freenect_attributes *a = list;
    for (int32_t i = 0; i < count && i < capacity; i++) {
        describe(&out[i], i, a != NULL ? a->serial : NULL);
        a = a != NULL ? a->next : NULL;
    }
    if (list != NULL) {
        k.api->free_attributes(list);
    }
    (void)k.api->shutdown(k.context);
    return count > 0 ? count : 0;
}

static const char *unavailable(void)
{
    return io_library_fault(&library);
}

const rlf_backend io_backend_freenect = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "freenect",
    .keys = "color aligned mirror",
    .summary = "Kinect v1 (Xbox 360) through libfreenect: number or serial number",
    .is_live = true,
    .unavailable = unavailable,
    .list = kinect_list,
    .open = kinect_open,
};
