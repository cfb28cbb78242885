/* .oni recordings, decoded by OpenNI2: every frame in its turn, as fast as it is asked for. */
#include "io/openni2/player.h"
#include "io/source/backends.h"

#include <stdio.h>
#include <string.h>

#define WAIT_MS 50
/* A player that gives nothing for so long gives nothing more. */
#define SILENCE_MS 5000

static rlf_result file_next(void *self, rlf_frame *out)
{
    openni2_player *o = self;
    int silence_ms = 0;
    for (;;) {
        if (io_stream_pair_take(&o->pair, false, out)) {
            return RLF_OK;
        }
        const bool is_ended = atomic_load(&o->is_ended);
        rlf_result result = openni2_player_wait(o, is_ended ? 0 : WAIT_MS);
        if (result < 0) {
            return result;
        }
        if (result == RLF_OK) {
            silence_ms = 0;
            continue;
        }
        silence_ms += WAIT_MS;
        if (is_ended) {
            return io_stream_pair_take(&o->pair, true, out) ? RLF_OK : RLF_END;
        }
        if (silence_ms >= SILENCE_MS) {
            return rlf_fail(RLF_ERROR_FORMAT,
                            "%s: OpenNI2 stops before the end of the recording: the file is "
                            "damaged, or holds pictures larger than 1600 x 1200",
                            o->source);
        }
    }
}

/* The player cannot go back from the end: the file is opened again. */
static rlf_result file_seek(void *self, int64_t index)
{
    openni2_player *o = self;
    rlf_result result = openni2_player_reopen(o);
    if (result != RLF_OK) {
        return result;
    }
    o->pair.shift_ns = 0;
    o->pair.sequence = index > 0 ? (uint64_t)index - 1 : 0;
    o->pair.is_broken = index > 0;
    openni2_seek seek = {(int)index + 1, o->device.depth.handle};
    if (index > 0 && o->device.api->device_invoke(o->device.handle, OPENNI2_COMMAND_SEEK, &seek,
                                                  sizeof(seek)) != OPENNI2_OK) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: OpenNI2 cannot go to frame %d: %.300s", o->source,
                        (int)index, o->device.api->error());
    }
    return RLF_OK;
}

static rlf_result file_restart(void *self)
{
    return file_seek(self, 0);
}

static rlf_result file_open(const rlf_address *address, rlf_opened *out)
{
    static const rlf_source_methods methods = {.next = file_next,
                                               .restart = file_restart,
                                               .destroy = openni2_player_destroy,
                                               .seek = file_seek,
                                               .status = openni2_player_status};
    openni2_player *o = NULL;
    rlf_result result = openni2_player_create(address, true, &o);
    if (result == RLF_OK) {
        openni2_player_describe(o, &methods, out);
    }
    return result;
}

const rlf_backend io_backend_oni = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "oni",
    .extensions = ".oni",
    .keys = "color aligned mirror",
    .summary = "recordings of OpenNI and OpenNI2",
    .unavailable = openni2_unavailable,
    .open = file_open,
};
