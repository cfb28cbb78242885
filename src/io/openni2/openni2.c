/* Cameras through OpenNI2: PrimeSense, Asus Xtion, older Orbbec. */
#include "io/openni2/player.h"
#include "io/source/backends.h"

#include <stdio.h>

#define WAIT_MS 100 /* a call of next takes at most this long */

static rlf_result fail_gone(openni2_player *o)
{
    o->pair.status.is_connected = false;
    return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera is gone: plug it in again", o->source);
}

static rlf_result live_next(void *self, rlf_frame *out)
{
    openni2_player *o = self;
    const int64_t end_ns = rlf_clock_ns() + WAIT_MS * INT64_C(1000000);
    for (;;) {
        if (atomic_load(&o->is_gone)) {
            return fail_gone(o);
        }
        if (io_stream_pair_take(&o->pair, false, out)) {
            return RLF_OK;
        }
        const int64_t left_ms = (end_ns - rlf_clock_ns()) / 1000000;
        if (left_ms <= 0) {
            return io_stream_pair_take(&o->pair, true, out) ? RLF_OK : RLF_NO_FRAME;
        }
        rlf_result result = openni2_player_wait(o, (int)left_ms);
        if (result < 0) {
            return atomic_load(&o->is_gone) ? fail_gone(o) : result;
        }
    }
}

static rlf_result live_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {
        .next = live_next, .destroy = openni2_player_destroy, .status = openni2_player_status};
    openni2_player *o = NULL;
    rlf_result result = openni2_player_create(address, false, &o);
    if (result == RLF_OK) {
        openni2_player_describe(o, &methods, out);
    }
    return result;
}

static int32_t list(rlf_source_entry *out, int32_t capacity)
{
    const openni2_api *api = openni2_begin("openni2:");
    openni2_info *devices = NULL;
    int device_count = 0;
    int32_t count = 0;
    if (api == NULL) {
        return 0;
    }
    if (api->get_devices(&devices, &device_count) == OPENNI2_OK) {
        for (int i = 0; i < device_count; i++) {
            if (openni2_is_test_device(&devices[i])) {
                continue;
            }
            if (count < capacity) {
                rlf_source_entry *e = &out[count];
                snprintf(e->source, sizeof(e->source), "openni2:%.240s", devices[i].uri);
                snprintf(e->description, sizeof(e->description), "%.60s %.60s", devices[i].vendor,
                         devices[i].name);
            }
            count++;
        }
        api->release_devices(devices);
    }
    openni2_end();
    return count;
}

const rlf_backend io_backend_openni2 = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "openni2",
    .keys = "mode color aligned mirror",
    .summary = "a camera of PrimeSense, Asus Xtion or older Orbbec: URI or serial number",
    .is_live = true,
    .unavailable = openni2_unavailable,
    .list = list,
    .open = live_open,
};
