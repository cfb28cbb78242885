/* Recordings: what is common to files and folders. */
#define _POSIX_C_SOURCE 200809L
#include "io/recording/sink.h"

#include <string.h>

#include <sys/stat.h>

#define COOKIE 0x52454331u

struct rlf_recording {
    io_sink sink;
    rlf_recording_status status;
};

rlf_recording_def rlf_recording_def_default(void)
{
    return (rlf_recording_def){.cookie = COOKIE,
                               .depth_codec = RLF_DEPTH_RVL,
                               .compression = RLF_COMPRESSION_ZSTD,
                               .jpeg_quality = 90,
                               .chunk_s = 1.0};
}

static bool is_folder(const char *path)
{
    struct stat status;
    const size_t length = strlen(path);
    return (length > 0 && path[length - 1] == '/') ||
           (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

rlf_result rlf_recording_open(const char *path, const rlf_source_info *info,
                              const rlf_recording_def *def, rlf_recording **out)
{
    if (!RLF_ASSERT(path != NULL && info != NULL && def != NULL && out != NULL) ||
        !RLF_ASSERT(def->cookie == COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    if (def->jpeg_quality < 0 || def->jpeg_quality > 100 || !(def->chunk_s > 0.0)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the quality must be 0 to 100, and a chunk longer "
                        "than 0 s",
                        path);
    }
    rlf_recording *recording = rlf_alloc(sizeof(*recording));
    if (recording == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = is_folder(path) ? io_folder_sink_open(path, info, def, &recording->sink)
                                        : io_mcap_sink_open(path, info, def, &recording->sink);
    if (result != RLF_OK) {
        rlf_free(recording);
        return result;
    }
    *out = recording;
    return RLF_OK;
}

rlf_result rlf_recording_add(rlf_recording *recording, const rlf_frame *frame)
{
    if (!RLF_ASSERT(recording != NULL && frame != NULL) ||
        !RLF_ASSERT(frame->depth_u16 != NULL || frame->depth_f32 != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = recording->sink.add(recording->sink.self, frame);
    recording->status.frames += result == RLF_OK ? 1 : 0;
    recording->status.bytes = recording->sink.bytes(recording->sink.self);
    return result;
}

rlf_result rlf_recording_add_bodies(rlf_recording *recording, int64_t time_ns,
                                    const rlf_snapshot *snapshot)
{
    if (!RLF_ASSERT(recording != NULL && snapshot != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const io_sink *sink = &recording->sink;
    return sink->add_bodies != NULL ? sink->add_bodies(sink->self, time_ns, snapshot) : RLF_OK;
}

rlf_recording_status rlf_recording_get_status(const rlf_recording *recording)
{
    return RLF_ASSERT(recording != NULL) ? recording->status : (rlf_recording_status){0};
}

rlf_result rlf_recording_close(rlf_recording **recording, rlf_recording_status *out)
{
    if (recording == NULL || *recording == NULL) {
        return RLF_OK;
    }
    rlf_recording *r = *recording;
    *recording = NULL;
    rlf_result result = r->sink.close(r->sink.self, &r->status);
    if (out != NULL) {
        *out = r->status;
    }
    rlf_free(r);
    return result;
}
