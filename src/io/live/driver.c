/* What all live cameras need. */
#include "io/live/driver.h"
#include "io/calibration/calibration.h"
#include "io/clip/clip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

rlf_result io_mode_get(const rlf_address *address, const char *key, io_mode *out)
{
    const char *text = rlf_address_get(address, key);
    if (text == NULL) {
        return RLF_OK;
    }
    int width = 0;
    int height = 0;
    int rate = 0;
    int used = 0;
    int fields = sscanf(text, "%5dx%5d%n@%4d%n", &width, &height, &used, &rate, &used);
    const bool is_valid = fields >= 2 && text[used] == '\0' && width > 0 && height > 0 &&
                          width <= RLF_IMAGE_SIZE_MAX && height <= RLF_IMAGE_SIZE_MAX &&
                          (fields == 2 || rate > 0);
    if (!is_valid) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: %s is \"%.40s\": it must be WIDTHxHEIGHT@RATE, e.g. 640x480@30",
                        address->source, key, text);
    }
    *out = (io_mode){width, height, rate};
    return RLF_OK;
}

rlf_result io_switch_get(const rlf_address *address, const char *key, int *out)
{
    const char *value = rlf_address_get(address, key);
    if (value != NULL && strcmp(value, "0") != 0 && strcmp(value, "1") != 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s=%.40s: must be 0 or 1", address->source, key,
                        value);
    }
    *out = value != NULL ? value[0] - '0' : *out;
    return RLF_OK;
}

void io_live_opened(const rlf_source_methods *methods, void *self, const char *source,
                    const rlf_rig *rig, double frames_per_second, rlf_opened *out)
{
    memset(out, 0, sizeof(*out));
    out->methods = *methods;
    out->self = self;
    snprintf(out->info.name, sizeof(out->info.name), "%.127s", source);
    out->info.rig = *rig;
    out->info.frame_count = -1;
    out->info.frames_per_second = frames_per_second;
    out->info.is_live = true;
}

rlf_result io_live_make_color(const rlf_rig *rig, rlf_image_rgba8 *out)
{
    const rlf_camera *c = &rig->color;
    if (!rig->has_color) {
        return RLF_OK;
    }
    uint8_t *data = rlf_alloc_array((size_t)c->width * (size_t)c->height, 4);
    *out = (rlf_image_rgba8){data, c->width, c->height, (ptrdiff_t)c->width * 4};
    return data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result check_size(const rlf_address *address, const char *which,
                             const rlf_camera *theirs, const rlf_camera *pictures)
{
    if (theirs->width == pictures->width && theirs->height == pictures->height) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: the calibration's %s pictures are %d x %d, the camera's %d x %d: ask for "
                    "that mode, or calibrate this one",
                    address->source, which, (int)theirs->width, (int)theirs->height,
                    (int)pictures->width, (int)pictures->height);
}

rlf_result io_live_use_rig(const rlf_address *address, rlf_rig *rig)
{
    const rlf_rig *user = address->rig;
    if (user == NULL) {
        return RLF_OK;
    }
    rlf_result result = check_size(address, "depth", &user->depth, &rig->depth);
    if (result == RLF_OK && rig->has_color && user->has_color) {
        result = check_size(address, "colour", &user->color, &rig->color);
    }
    if (result != RLF_OK) {
        return result;
    }
    const bool has_color = rig->has_color && user->has_color;
    *rig = *user;
    rig->has_color = has_color;
    return RLF_OK;
}

/* Deviation from a rotation that single precision and a calibration's rounding can cause. */
#define ROTATION_TOLERANCE 2e-3

bool io_live_pose(const float rotation[9], const float translation[3], double metres, rlf_pose *out)
{
    double rows[9];
    for (int i = 0; i < 9; i++) {
        rows[i] = (double)rotation[i];
    }
    out->p = rlf_scale(
        rlf_vec3_make((double)translation[0], (double)translation[1], (double)translation[2]),
        metres);
    return io_rotation_read(rows, ROTATION_TOLERANCE, &out->q) && rlf_vec3_is_finite(out->p);
}

int64_t io_live_time(uint64_t microseconds)
{
    return microseconds <= RLF_TIME_MAX_NS / 1000 ? (int64_t)microseconds * 1000 : 0;
}

void io_live_count_tell(const io_live_count *c, rlf_source_status *out)
{
    out->lost = c->lost;
    out->doubled = c->doubled;
    out->unpaired = c->unpaired;
    out->damaged = c->damaged;
}

bool io_live_count_frame(io_live_count *c, uint64_t number, int64_t time_ns, rlf_frame *out)
{
    if (c->has_last && number == c->number) {
        c->doubled++;
        return false;
    }
    const bool is_new =
        c->has_last && (c->is_restarted || number < c->number || time_ns <= c->time_ns);
    if (is_new) {
        c->sequence++;
        const int64_t back_ns = io_time_sum(c->time_ns, -time_ns);
        const int64_t step_ns = c->interval_ns > 0 ? c->interval_ns : 1;
        c->offset_ns = io_time_sum(c->offset_ns, io_time_sum(back_ns, step_ns));
        out->flags |= RLF_FRAME_DISCONTINUITY;
    } else if (c->has_last) {
        c->sequence += number - c->number;
        c->lost += number - c->number - 1;
    }
    c->has_last = true;
    c->is_restarted = false;
    c->number = number;
    c->time_ns = time_ns;
    out->sequence = c->sequence;
    out->time_ns = io_time_sum(time_ns, c->offset_ns);
    return true;
}

bool io_live_count_time(io_live_count *c, int64_t time_ns, rlf_frame *out)
{
    uint64_t number = c->number;
    if (c->has_last && time_ns != c->time_ns) {
        const int64_t gap_ns = time_ns - c->time_ns;
        number += 1 + (gap_ns > 0 ? (uint64_t)io_time_lost(gap_ns, c->interval_ns) : 0);
    }
    return io_live_count_frame(c, number, time_ns, out);
}

/* ---- a lens model from fields of view ---------------------------------------------------- */

/* Horizontal focal length over width of PrimeSense cameras: 58.5 degrees (Kinect v1, Xtion). */
#define FOCAL_TYPICAL 0.9

static bool is_angle(double radians)
{
    return radians > 0.1 && radians < 3.0;
}

bool io_camera_from_fov(int32_t width, int32_t height, double fov_x, double fov_y, rlf_camera *out)
{
    const double w = width;
    const double h = height;
    *out = (rlf_camera){.width = width,
                        .height = height,
                        .fx = FOCAL_TYPICAL * w,
                        .fy = FOCAL_TYPICAL * w,
                        .cx = 0.5 * (w - 1.0),
                        .cy = 0.5 * (h - 1.0)};
    if (!is_angle(fov_x) || !is_angle(fov_y)) {
        return false;
    }
    out->fx = 0.5 * w * rlf_cos(0.5 * fov_x) / rlf_sin(0.5 * fov_x);
    out->fy = 0.5 * h * rlf_cos(0.5 * fov_y) / rlf_sin(0.5 * fov_y);
    return true;
}
