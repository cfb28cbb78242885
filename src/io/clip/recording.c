/* Recordings: what is common to files and folders. */
#define _POSIX_C_SOURCE 200809L
#include "io/clip/sink.h"

#include "base/messages.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#ifndef RLF_HAVE_MCAP
rlf_result io_mcap_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    (void)info, (void)def, (void)out;
    return rlf_fail(
        RLF_ERROR_UNSUPPORTED,
        "%s: this build was made without MCAP: record into a folder, FOLDER/, or " RLF_GET_PART(
            "libzstd-dev liblz4-dev", "script/bootstrap", "RELIEF_WITH_MCAP"),
        path);
}
#endif

#define COOKIE 0x52454331u
#define TIME_MAX_NS INT64_C(4000000000000000000) /* the year 2096; what ROS has room for */

struct rlf_recording {
    io_sink sink;
    rlf_rig rig;
    bool has_first; /* the next two are the first frame's, and all others' */
    bool is_float;
    double units_per_metre;
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

/* No file: the topics of a camera. */
static bool is_ros2(const char *path)
{
    return strncmp(path, "ros2:", 5) == 0;
}

/* A device and a pipe may have any name. */
static bool is_mcap(const char *path)
{
    struct stat status;
    const char *dot = strrchr(path, '.');
    return (dot != NULL && strcasecmp(dot, ".mcap") == 0) ||
           (stat(path, &status) == 0 && !S_ISREG(status.st_mode));
}

static rlf_result check_def(const char *path, const rlf_recording_def *def)
{
    if (def->jpeg_quality < 0 || def->jpeg_quality > 100 || !(def->chunk_s > 0.0)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the quality must be 0 to 100, and a chunk longer "
                        "than 0 s",
                        path);
    }
    if ((unsigned)def->depth_codec > RLF_DEPTH_PNG ||
        (unsigned)def->compression > RLF_COMPRESSION_NONE) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: depth codec %d and compression %d: use values of rlf_depth_codec and "
                        "rlf_compression",
                        path, (int)def->depth_codec, (int)def->compression);
    }
    return is_ros2(path) || is_folder(path) || is_mcap(path)
               ? RLF_OK
               : rlf_fail(RLF_ERROR_INVALID,
                          "%s: is no name of a recording: end it in .mcap, in / for a folder, or "
                          "give ros2:/CAMERA",
                          path);
}

rlf_result rlf_recording_open(const char *path, const rlf_source_info *info,
                              const rlf_recording_def *def, rlf_recording **out)
{
    if (!RLF_ASSERT(path != NULL && info != NULL && def != NULL && out != NULL) ||
        !RLF_ASSERT(def->cookie == COOKIE)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check_def(path, def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_recording *recording = rlf_alloc(sizeof(*recording));
    if (recording == NULL) {
        return RLF_ERROR_MEMORY;
    }
    result = is_ros2(path)     ? io_ros2_sink_open(path, info, def, &recording->sink)
             : is_folder(path) ? io_folder_sink_open(path, info, def, &recording->sink)
                               : io_mcap_sink_open(path, info, def, &recording->sink);
    if (result != RLF_OK) {
        rlf_free(recording);
        return result;
    }
    recording->rig = info->rig;
    *out = recording;
    return RLF_OK;
}

/* All frames of a recording are of one kind, and its times have room for nanoseconds. */
static rlf_result check_frame(const rlf_recording *r, const rlf_frame *f)
{
    rlf_result result = rlf_frame_check(&r->rig, f, "recording");
    if (result != RLF_OK) {
        return result;
    }
    const int64_t color_ns = f->color.data != NULL ? f->color_time_ns : 0;
    if (f->time_ns < 0 || f->time_ns > TIME_MAX_NS || color_ns > TIME_MAX_NS) {
        return rlf_fail(
            RLF_ERROR_INVALID, "recording: frame %llu: its time is %lld ns: use 0 to %lld",
            (unsigned long long)f->sequence,
            (long long)(color_ns > TIME_MAX_NS ? color_ns : f->time_ns), (long long)TIME_MAX_NS);
    }
    const bool is_float = f->depth_f32 != NULL;
    if (r->has_first && (is_float != r->is_float ||
                         (!is_float && f->depth_units_per_metre != r->units_per_metre))) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "recording: frame %llu: its depth is in other units than that of the first "
                        "one: begin another recording",
                        (unsigned long long)f->sequence);
    }
    return RLF_OK;
}

rlf_result rlf_recording_add(rlf_recording *recording, const rlf_frame *frame)
{
    if (!RLF_ASSERT(recording != NULL && frame != NULL)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = check_frame(recording, frame);
    if (result != RLF_OK) {
        return result;
    }
    recording->has_first = true;
    recording->is_float = frame->depth_f32 != NULL;
    recording->units_per_metre = frame->depth_units_per_metre;
    result = recording->sink.add(recording->sink.self, frame);
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
