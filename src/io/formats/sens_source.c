/* Frames from ScanNet's .sens files (version 4). */
#include "io/calibration/calibration.h"
#include "io/source/backends.h"
#include "io/little.h"
#include "io/formats/frame_log.h"

#include <string.h>

/* Deviation from a rotation that rounding can cause. */
#define ROTATION_TOLERANCE 1e-2

#define VERSION 4
#define NAME_MAX_BYTES 4096
#define MATRIX_SIZE 64       /* 4 x 4 floats, row by row */
#define FRAME_HEADER_SIZE 96 /* a matrix, u64 times and sizes of colour and depth */

enum { DEPTH_RAW = 0, DEPTH_ZLIB = 1 };

/* What stands behind the name. Matrices are 4 x 4, row by row. */
typedef struct sens_header {
    float color_intrinsic[16], color_extrinsic[16], depth_intrinsic[16], depth_extrinsic[16];
    uint32_t depth_packing;
    uint32_t color_width, color_height, depth_width, depth_height;
    float depth_shift; /* counts per metre */
    uint64_t frame_count;
} sens_header;

#define HEADER_SIZE (4 * MATRIX_SIZE + 6 * 4 + 4 + 8)

static void take_matrix(cursor *c, float out[16])
{
    for (int i = 0; i < 16; i++) {
        out[i] = cursor_f32(c);
    }
}

static void parse_header(cursor *c, sens_header *out)
{
    take_matrix(c, out->color_intrinsic);
    take_matrix(c, out->color_extrinsic);
    take_matrix(c, out->depth_intrinsic);
    take_matrix(c, out->depth_extrinsic);
    cursor_u32(c); /* packing of colour, which its first bytes tell too */
    out->depth_packing = cursor_u32(c);
    out->color_width = cursor_u32(c);
    out->color_height = cursor_u32(c);
    out->depth_width = cursor_u32(c);
    out->depth_height = cursor_u32(c);
    out->depth_shift = cursor_f32(c);
    out->frame_count = cursor_u64(c);
}

static rlf_result read_header(const io_log *log, sens_header *out, int64_t *out_end)
{
    uint32_t version = 0;
    uint64_t length = 0;
    uint8_t data[HEADER_SIZE];
    if (!io_log_read(log, 0, &version, 4) || version != VERSION) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is no .sens file of version %d: give the right file",
                        log->file.path, VERSION);
    }
    if (!io_log_read(log, 4, &length, 8) || length > NAME_MAX_BYTES ||
        !io_log_read(log, 12 + (int64_t)length, data, sizeof(data))) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: its header is cut short: copy it again",
                        log->file.path);
    }
    cursor c = {data, sizeof(data), false};
    parse_header(&c, out);
    *out_end = 12 + (int64_t)length + HEADER_SIZE;
    return RLF_OK;
}

static bool read_pose(const float *m, rlf_pose *out)
{
    const double rows[9] = {(double)m[0], (double)m[1], (double)m[2], (double)m[4], (double)m[5],
                            (double)m[6], (double)m[8], (double)m[9], (double)m[10]};
    /* A frame that was lost has a matrix of minus infinities. */
    if (!io_rotation_read(rows, ROTATION_TOLERANCE, &out->q)) {
        return false;
    }
    out->p = rlf_vec3_make((double)m[3], (double)m[7], (double)m[11]);
    return rlf_vec3_is_finite(out->p);
}

static void set_camera(const float *m, uint32_t width, uint32_t height, rlf_camera *out)
{
    /* Sizes that do not fit become 0, which the clip refuses with a line. */
    out->width = width <= RLF_IMAGE_SIZE_MAX ? (int32_t)width : 0;
    out->height = height <= RLF_IMAGE_SIZE_MAX ? (int32_t)height : 0;
    out->fx = (double)m[0];
    out->fy = (double)m[5];
    out->cx = (double)m[2];
    out->cy = (double)m[6];
}

static rlf_result set_rig(const rlf_address *address, const sens_header *h, io_log *log)
{
    if (address->rig != NULL) {
        log->rig = *address->rig;
        log->units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    log->rig = rlf_rig_default();
    set_camera(h->depth_intrinsic, h->depth_width, h->depth_height, &log->rig.depth);
    set_camera(h->color_intrinsic, h->color_width, h->color_height, &log->rig.color);
    log->rig.has_color = h->color_width > 0;
    log->units_per_metre = (double)h->depth_shift;
    if (!(log->units_per_metre >= 1.0 && log->units_per_metre <= 1e6)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has a depth shift of %g counts per metre: give the calibration with "
                        "?camera=FILE",
                        log->file.path, log->units_per_metre);
    }
    /* Both are poses of a camera in the device. */
    rlf_pose T_device_color;
    rlf_pose T_device_depth;
    if (read_pose(h->color_extrinsic, &T_device_color) &&
        read_pose(h->depth_extrinsic, &T_device_depth)) {
        const rlf_pose T_color_device = rlf_pose_invert(&T_device_color);
        log->rig.T_color_depth = rlf_pose_mul(&T_color_device, &T_device_depth);
    }
    return RLF_OK;
}

static rlf_result check_header(const sens_header *h, const io_log *log)
{
    if (h->depth_packing != DEPTH_RAW && h->depth_packing != DEPTH_ZLIB) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: its depth is packed in a way (%d) that cannot be read: convert it to "
                        "zlib with ScanNet's tools",
                        log->file.path, (int)h->depth_packing);
    }
    return RLF_OK;
}

/* Pose, times, sizes. */
static bool parse_frame(const uint8_t *data, io_log_frame *out)
{
    cursor c = {data, FRAME_HEADER_SIZE, false};
    float pose[16];
    memset(out, 0, sizeof(*out));
    take_matrix(&c, pose);
    if (!read_pose(pose, &out->pose)) {
        memset(&out->pose, 0, sizeof(out->pose));
    }
    cursor_u64(&c); /* time of colour: the file pairs the two itself */
    out->time_ns = (int64_t)cursor_u64(&c);
    const uint64_t color_size = cursor_u64(&c);
    const uint64_t depth_size = cursor_u64(&c);
    out->color_size = (uint32_t)color_size;
    out->depth_size = (uint32_t)depth_size;
    return color_size <= INT32_MAX && depth_size <= INT32_MAX && depth_size > 0;
}

static rlf_result read_frames(io_log *log, uint64_t promised, int64_t position)
{
    uint8_t data[FRAME_HEADER_SIZE];
    rlf_result result = RLF_OK;
    io_log_frame frame;
    while (result == RLF_OK && (uint64_t)log->count < promised &&
           io_log_read(log, position, data, sizeof(data)) && parse_frame(data, &frame)) {
        result = io_log_add(log, &frame, position + FRAME_HEADER_SIZE, true, &position);
    }
    if (result != RLF_OK && result != RLF_END) {
        return result;
    }
    if ((uint64_t)log->count < promised) {
        rlf_log(RLF_LOG_WARNING,
                "%s: is damaged or cut short: says %llu frames, and %d of them are whole",
                log->file.path, (unsigned long long)promised, (int)log->count);
    }
    return RLF_OK;
}

static rlf_result sens_open(const rlf_address *address, rlf_opened *out)
{
    io_log *log = NULL;
    sens_header header = {0};
    int64_t end = 0;
    rlf_result result = io_log_open(address->place, &log);
    if (result != RLF_OK) {
        return result;
    }
    result = read_header(log, &header, &end);
    result = result == RLF_OK ? check_header(&header, log) : result;
    result = result == RLF_OK ? set_rig(address, &header, log) : result;
    result = result == RLF_OK ? read_frames(log, header.frame_count, end) : result;
    if (result == RLF_OK) {
        log->has_poses = true;
        result = io_log_to_clip(log, "ScanNet .sens", out);
    }
    return io_open_end(result, log, io_log_free);
}

const rlf_backend io_backend_sens = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "sens",
    .extensions = ".sens",
    .summary = "a recording: ScanNet's .sens",
    .open = sens_open,
};
