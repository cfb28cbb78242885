/* Frames from the recordings of Azure Kinect and Femto cameras. */
#include "io/calibration/calibration.h"
#include "io/json.h"
#include "io/formats/matroska.h"
#include "io/picture/picture.h"
#include "io/picture/pixels.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"

#include <stdlib.h>
#include <string.h>

typedef struct stream {
    mkv_track *track;     /* NULL = none */
    const char *encoding; /* NULL = JPEG */
} stream;

typedef struct matroska {
    mkv_file file;
    stream depth, color;
    rlf_rig rig;
    double units_per_metre;
    io_buffer buffer;
} matroska;

/* Random error of the time-of-flight sensor, as Toelgyessy et al. 2021 measured it: 0.8 mm at 1 m,
 * 3 mm at 3 m. */
static const rlf_depth_noise k4a_noise = {0.0005, 0.0, 0.0003};

static rlf_result read_block(matroska *self, const stream *s, int32_t index, io_bytes *out)
{
    const io_shot *shot = &s->track->pictures.items[index];
    return io_file_read_bytes(&self->file.file, shot->position, shot->size, &self->buffer, out);
}

static io_pixels pixels_of(const matroska *self, const stream *s, const io_bytes *bytes)
{
    const mkv_track *track = s->track;
    const bool is_yuv = s->encoding != NULL && strcmp(s->encoding, "yuv422_yuy2") == 0;
    const int64_t size = s == &self->depth || is_yuv         ? 2
                         : strcmp(s->encoding, "bgra8") == 0 ? 4
                                                             : 1;
    const io_pixels pixels = {.name = bytes->name,
                              .encoding = s->encoding,
                              .width = track->width,
                              .height = track->height,
                              .step = track->width * size,
                              .is_bigendian = true,
                              .data = bytes->data,
                              .size = bytes->size};
    return pixels;
}

static rlf_result read_depth(void *context, int32_t index, void *out)
{
    matroska *self = context;
    io_bytes bytes;
    double units = 0.0;
    rlf_result result = read_block(self, &self->depth, index, &bytes);
    if (result != RLF_OK) {
        return result;
    }
    const io_pixels pixels = pixels_of(self, &self->depth, &bytes);
    return io_pixels_to_depth(&pixels, out, &units);
}

static rlf_result read_color(void *context, int32_t index, const rlf_image_rgba8 *out)
{
    matroska *self = context;
    io_bytes bytes;
    rlf_result result = read_block(self, &self->color, index, &bytes);
    if (result != RLF_OK) {
        return result;
    }
    if (self->color.encoding != NULL) {
        const io_pixels pixels = pixels_of(self, &self->color, &bytes);
        return io_pixels_to_rgba(&pixels, out);
    }
    io_picture picture = {
        .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
    return io_jpeg_decode_rgba(&bytes, &picture);
}

static void matroska_destroy(void *context)
{
    matroska *self = context;
    mkv_file_close(&self->file);
    io_buffer_free(&self->buffer);
    rlf_free(self);
}

/* Depth and infrared are both big-endian 16-bit grey. */
static bool is_depth(const mkv_track *t)
{
    return strcmp(t->fourcc, "b16g") == 0 && strcmp(t->name, "IR") != 0;
}

static bool is_color(const mkv_track *t, const char **out_encoding)
{
    static const char *const pairs[][2] = {
        {"NV12", "nv12"}, {"YUY2", "yuv422_yuy2"}, {"BGRA", "bgra8"}};
    *out_encoding = NULL;
    if (strcmp(t->codec, "V_MJPEG") == 0 || strcmp(t->fourcc, "MJPG") == 0) {
        return true;
    }
    for (size_t i = 0; i < sizeof(pairs) / sizeof(pairs[0]); i++) {
        if (strcmp(t->fourcc, pairs[i][0]) == 0) {
            *out_encoding = pairs[i][1];
            return true;
        }
    }
    return false;
}

static rlf_result find_tracks(matroska *self)
{
    self->depth.encoding = "16UC1";
    for (int32_t i = self->file.track_count - 1; i >= 0; i--) {
        mkv_track *t = &self->file.tracks[i];
        const char *encoding = NULL;
        if (is_depth(t)) {
            self->depth.track = t;
        } else if (is_color(t, &encoding)) {
            self->color.track = t;
            self->color.encoding = encoding;
        }
    }
    if (self->depth.track == NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has no depth track (16-bit grey b16g): record with a depth mode",
                        self->file.file.path);
    }
    return RLF_OK;
}

/* Device time of the first block, which the tracks count from. */
static int64_t start_of(const mkv_file *file)
{
    const char *text = mkv_file_tag(file, "K4A_START_OFFSET_NS");
    const long long value = text != NULL ? strtoll(text, NULL, 10) : 0;
    return value > 0 && value < INT64_MAX / 4 ? (int64_t)value : 0;
}

static void set_size(const mkv_track *track, rlf_camera *out)
{
    out->width = (int32_t)track->width;
    out->height = (int32_t)track->height;
}

static rlf_result read_attached(matroska *self)
{
    mkv_file *f = &self->file;
    self->rig = rlf_rig_default();
    self->rig.noise = k4a_noise;
    self->rig.has_color = self->color.track != NULL;
    set_size(self->depth.track, &self->rig.depth);
    if (self->rig.has_color) {
        set_size(self->color.track, &self->rig.color);
    }
    if (f->attached_name[0] == '\0') {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: has no attached calibration.json: give the calibration with "
                        "?camera=FILE",
                        f->file.path);
    }
    if (f->attached_size > (int64_t)IO_JSON_FILE_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the attached calibration has %lld bytes: give one "
                        "with ?camera=FILE",
                        f->file.path, (long long)f->attached_size);
    }
    io_bytes bytes;
    rlf_result result = io_file_read_bytes(&f->file, f->attached_position, (size_t)f->attached_size,
                                           &self->buffer, &bytes);
    return result == RLF_OK ? k4a_calibration_read(&bytes, &self->rig) : result;
}

/* The camera's own calibration, unless the user gave one or the file holds none. */
static rlf_result read_rig(const rlf_address *address, matroska *self)
{
    bool is_found = false;
    self->units_per_metre = 1000.0;
    if (address->rig != NULL || self->file.attached_name[0] == '\0') {
        rlf_result result = io_rig_beside(address, &self->rig, &self->units_per_metre, &is_found);
        if (result != RLF_OK) {
            return result;
        }
    }
    rlf_result result = is_found ? RLF_OK : read_attached(self);
    const mkv_track *depth = self->depth.track;
    if (result == RLF_OK) {
        result = io_rig_check_size(self->file.file.path, "depth", depth->width, depth->height,
                                   &self->rig.depth);
    }
    self->rig.has_color = self->rig.has_color && self->color.track != NULL;
    return result;
}

/* Tracks count from the device's start. */
static io_times times_of(mkv_track *track, int64_t start_ns)
{
    for (int32_t i = 0; track != NULL && i < track->pictures.count; i++) {
        track->pictures.items[i].time_ns += start_ns;
    }
    if (track != NULL) {
        (void)io_shots_sort(&track->pictures);
    }
    return track != NULL ? io_shots_times(&track->pictures) : (io_times){.count = 0};
}

static rlf_result open_clip(const rlf_address *address, matroska *self, rlf_opened *out)
{
    const int64_t start_ns = start_of(&self->file);
    const char *mode = mkv_file_tag(&self->file, "K4A_DEPTH_MODE");
    const char *serial = mkv_file_tag(&self->file, "K4A_DEVICE_SERIAL_NUMBER");
    char device[256];
    snprintf(device, sizeof(device), "Azure Kinect recording%s%s%s%s", mode != NULL ? ", " : "",
             mode != NULL ? mode : "", serial != NULL ? ", serial number " : "",
             serial != NULL ? serial : "");
    const io_clip_def def = {.name = address->place,
                             .device = device,
                             .rig = self->rig,
                             .units_per_metre = self->units_per_metre,
                             .depth = times_of(self->depth.track, start_ns),
                             .color = times_of(self->color.track, start_ns),
                             .read_depth = read_depth,
                             .read_color = read_color,
                             .destroy = matroska_destroy,
                             .self = self};
    return io_clip_open(&def, out);
}

static rlf_result open_all(const rlf_address *address, matroska *self, rlf_opened *out)
{
    rlf_result result = mkv_file_open(address->place, &self->file);
    result = result == RLF_OK ? find_tracks(self) : result;
    result = result == RLF_OK ? read_rig(address, self) : result;
    return result == RLF_OK ? open_clip(address, self, out) : result;
}

static rlf_result matroska_open(const rlf_address *address, rlf_opened *out)
{
    matroska *self = rlf_alloc(sizeof(*self));
    return io_open_end(self != NULL ? open_all(address, self, out) : RLF_ERROR_MEMORY, self,
                       matroska_destroy);
}

const rlf_backend io_backend_matroska = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "k4a-mkv",
    .extensions = ".mkv",
    .summary = "a recording: .mkv of an Azure Kinect or a Femto camera",
    .open = matroska_open,
};
