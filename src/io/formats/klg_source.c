/* Frames from .klg files, the logs of Kintinuous and ElasticFusion. */
#include "io/calibration/calibration.h"
#include "io/source/backends.h"
#include "io/little.h"
#include "io/formats/frame_log.h"
#include "io/clip/clip.h"

#include <string.h>

#define FRAME_HEADER_SIZE 16 /* int64 time, int32 sizes of depth and colour */

/* The file says nothing of its camera. What its programs assume is a Kinect of the first kind. */
static void set_default_rig(io_log *log)
{
    const rlf_camera camera = {
        .width = 640, .height = 480, .fx = 528.0, .fy = 528.0, .cx = 320.0, .cy = 240.0};
    log->rig = rlf_rig_default();
    log->rig.depth = camera;
    log->rig.color = camera;
    log->rig.has_color = true;
    log->units_per_metre = 1000.0;
    rlf_log(RLF_LOG_WARNING,
            "%s: holds no calibration: 640 x 480 with fx 528, fy 528, cx 320, cy 240 is taken, as "
            "its programs do: give the right one with ?camera=FILE",
            log->file.path);
}

static rlf_result read_frames(io_log *log)
{
    int32_t promised = 0;
    if (!io_log_read(log, 0, &promised, sizeof(promised)) || promised < 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is no .klg file: give the right file",
                        log->file.path);
    }
    int64_t position = sizeof(promised);
    rlf_result result = RLF_OK;
    uint8_t header[FRAME_HEADER_SIZE];
    /* A logger that was killed has not written the count: then the file's end decides. */
    while (result == RLF_OK && (promised == 0 || log->count < promised) &&
           io_log_read(log, position, header, sizeof(header))) {
        cursor c = {header, sizeof(header), false};
        io_log_frame frame = {.time_ns = (int64_t)cursor_u64(&c)};
        frame.depth_size = cursor_u32(&c);
        frame.color_size = cursor_u32(&c);
        if (frame.depth_size == 0 || frame.depth_size > INT32_MAX || frame.color_size > INT32_MAX) {
            break;
        }
        result = io_log_add(log, &frame, position + FRAME_HEADER_SIZE, false, &position);
    }
    if (result != RLF_OK && result != RLF_END) {
        return result;
    }
    if (log->count < promised || position < log->file.size) {
        rlf_log(RLF_LOG_WARNING,
                "%s: is damaged or cut short: says %d frames, and %d of them are whole",
                log->file.path, (int)promised, (int)log->count);
    }
    return RLF_OK;
}

static rlf_result read_rig(const rlf_address *address, io_log *log)
{
    bool is_found = false;
    rlf_result result = io_rig_beside(address, &log->rig, &log->units_per_metre, &is_found);
    if (result == RLF_OK && !is_found) {
        set_default_rig(log);
    }
    return result;
}

static rlf_result read_order(const rlf_address *address, io_log *log)
{
    const char *order = rlf_address_get(address, "order");
    log->is_bgr = order != NULL && strcmp(order, "bgr") == 0;
    if (order == NULL || log->is_bgr || strcmp(order, "rgb") == 0) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: order=%.40s: give rgb, or bgr where red and blue are "
                    "swapped",
                    address->source, order);
}

static rlf_result klg_open(const rlf_address *address, rlf_opened *out)
{
    io_log *log = NULL;
    rlf_result result = io_log_open(address->place, &log);
    if (result != RLF_OK) {
        return result;
    }
    result = read_order(address, log);
    result = result == RLF_OK ? read_frames(log) : result;
    result = result == RLF_OK ? read_rig(address, log) : result;
    result = result == RLF_OK ? io_log_to_clip(log, ".klg log", out) : result;
    return io_open_end(result, log, io_log_free);
}

const rlf_backend io_backend_klg = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "klg",
    .extensions = ".klg",
    .keys = "order",
    .summary = "a recording: .klg of Kintinuous and ElasticFusion (order=bgr)",
    .open = klg_open,
};
