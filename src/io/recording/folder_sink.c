/* Recording into a folder in the TUM RGB-D layout. */
#define _POSIX_C_SOURCE 200809L
#include "io/recording/sink.h"

#include "io/codec/picture_encode.h"
#include "io/file.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <unistd.h>

#define LEVEL 3               /* of zlib, as rlf_png_write has it */
#define FLOAT_COUNTS 5000.0   /* per metre, as TUM has it: up to 13.1 m */
#define FAR_FLOAT_COUNTS 1000 /* for cameras that see farther */

typedef struct folder_sink {
    char path[IO_PATH_MAX];
    rlf_rig rig;
    double units_per_metre;
    int32_t jpeg_quality;
    FILE *depth_list, *color_list;
    io_jpeg_encoder *jpeg;
    io_byte_buffer file;
    void *scratch;    /* rows without padding */
    uint16_t *counts; /* of float depth */
    int64_t frames, colors, last_color_ns;
    uint64_t bytes;
} folder_sink;

static rlf_result fail_write(const folder_sink *s)
{
    return rlf_fail(RLF_ERROR_IO, "%s: cannot be written: %s: free some space or write elsewhere",
                    s->path, strerror(errno));
}

static void print_camera(FILE *file, const rlf_camera *c)
{
    fprintf(file,
            "\"width\": %d, \"height\": %d,\n    \"fx\": %.17g, \"fy\": %.17g, \"cx\": %.17g, "
            "\"cy\": %.17g",
            (int)c->width, (int)c->height, c->fx, c->fy, c->cx, c->cy);
    if (c->distortion_model != RLF_DISTORTION_NONE) {
        const bool is_rational = c->distortion_model == RLF_DISTORTION_RATIONAL_POLYNOMIAL;
        fprintf(file, ",\n    \"distortion_model\": \"%s\", \"distortion\": [",
                is_rational ? "rational_polynomial" : "plumb_bob");
        for (int i = 0; i < (is_rational ? 8 : 5); i++) {
            fprintf(file, "%s%.17g", i > 0 ? ", " : "", c->distortion[i]);
        }
        fprintf(file, "]");
    }
}

static void print_rig(FILE *file, const folder_sink *s)
{
    const rlf_rig *r = &s->rig;
    fprintf(file, "{\n  \"depth\": {");
    print_camera(file, &r->depth);
    fprintf(file,
            ",\n    \"units_per_metre\": %.17g, \"depth_min_m\": %.17g, \"depth_max_m\": %.17g,\n"
            "    \"noise\": [%.17g, %.17g, %.17g]}",
            s->units_per_metre, r->depth_min_m, r->depth_max_m, r->noise.c0, r->noise.c1,
            r->noise.c2);
    if (r->has_color) {
        const rlf_quat q = r->T_color_depth.q;
        const rlf_vec3 x = rlf_rotate(q, rlf_vec3_make(1, 0, 0)); /* the columns */
        const rlf_vec3 y = rlf_rotate(q, rlf_vec3_make(0, 1, 0));
        const rlf_vec3 z = rlf_rotate(q, rlf_vec3_make(0, 0, 1));
        const rlf_vec3 t = r->T_color_depth.p;
        fprintf(file, ",\n  \"color\": {");
        print_camera(file, &r->color);
        fprintf(file, "},\n  \"depth_to_color\": {\"rotation\": [");
        fprintf(file, "[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]", x.x,
                y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
        fprintf(file, "],\n    \"translation\": [%.17g, %.17g, %.17g]}", t.x, t.y, t.z);
    }
    fprintf(file, "\n}\n");
}

/* Opens NAME in the folder for writing. */
static rlf_result open_in(const folder_sink *s, const char *name, FILE **out)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(s->path, name, path);
    int descriptor = -1;
    *out = NULL;
    if (result == RLF_OK) {
        result = io_out_open_in_place(path, &descriptor);
    }
    if (result == RLF_OK && (*out = fdopen(descriptor, "w")) == NULL) {
        result = fail_write(s);
        close(descriptor);
    }
    return result;
}

static rlf_result write_camera(const folder_sink *s)
{
    FILE *file = NULL;
    rlf_result result = open_in(s, "camera.json", &file);
    if (result != RLF_OK) {
        return result;
    }
    print_rig(file, s);
    const bool is_bad = ferror(file) != 0;
    return fclose(file) != 0 || is_bad ? fail_write(s) : RLF_OK;
}

/* Once the first frame says what the depth is. */
static rlf_result start(folder_sink *s, const rlf_frame *frame)
{
    const size_t pixels = (size_t)s->rig.depth.width * (size_t)s->rig.depth.height;
    s->units_per_metre = frame->depth_units_per_metre;
    if (frame->depth_f32 != NULL) {
        s->units_per_metre =
            s->rig.depth_max_m * FLOAT_COUNTS <= UINT16_MAX ? FLOAT_COUNTS : FAR_FLOAT_COUNTS;
        rlf_log(RLF_LOG_INFO, "%s: metres are rounded to 1/%g m", s->path, s->units_per_metre);
    }
    s->scratch = rlf_alloc_array(pixels, 4);
    s->counts = rlf_alloc_array(pixels, 2);
    return s->scratch != NULL && s->counts != NULL ? write_camera(s) : RLF_ERROR_MEMORY;
}

static const uint16_t *counts_of(folder_sink *s, const rlf_frame *frame)
{
    const void *rows = io_depth_rows(frame, &s->rig, s->scratch);
    if (frame->depth_u16 != NULL) {
        return rows;
    }
    const float *metres = rows;
    const size_t pixels = (size_t)s->rig.depth.width * (size_t)s->rig.depth.height;
    for (size_t i = 0; i < pixels; i++) {
        const double count = metres[i] * s->units_per_metre + 0.5;
        s->counts[i] = count >= 1.0 && count <= UINT16_MAX ? (uint16_t)count : 0;
    }
    return s->counts;
}

/* The file, and a line in the list: in this order, so that the list never names what is not there.
 */
static rlf_result add_file(folder_sink *s, FILE *list, const char *name, int64_t time_ns)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(s->path, name, path);
    if (result == RLF_OK) {
        result = rlf_file_write(path, s->file.data, s->file.size);
    }
    if (result != RLF_OK) {
        return result;
    }
    s->bytes += s->file.size;
    const int64_t time = time_ns > 0 ? time_ns : 0;
    fprintf(list, "%" PRId64 ".%09" PRId64 " %s\n", time / 1000000000, time % 1000000000, name);
    return fflush(list) == 0 ? RLF_OK : fail_write(s);
}

static rlf_result add_color(folder_sink *s, const rlf_frame *frame)
{
    const int64_t time_ns = frame->color_time_ns != 0 ? frame->color_time_ns : frame->time_ns;
    if (s->colors > 0 && time_ns == s->last_color_ns) {
        return RLF_OK; /* the same picture again */
    }
    char name[64];
    const rlf_image_rgba8 *c = &frame->color;
    const bool is_jpeg = s->jpeg_quality > 0;
    snprintf(name, sizeof(name), "rgb/%06" PRId64 ".%s", s->colors, is_jpeg ? "jpg" : "png");
    s->file.size = 0;
    rlf_result result;
    if (is_jpeg) {
        result = io_jpeg_encode(s->jpeg, c, s->jpeg_quality, &s->file);
    } else {
        const io_png_def def = {name, c->data, c->width, c->height, c->stride, IO_PNG_RGB, LEVEL};
        result = io_png_encode(&def, &s->file);
    }
    if (result == RLF_OK) {
        result = add_file(s, s->color_list, name, time_ns);
    }
    s->last_color_ns = time_ns;
    s->colors += result == RLF_OK ? 1 : 0;
    return result;
}

static rlf_result folder_add(void *self, const rlf_frame *frame)
{
    folder_sink *s = self;
    rlf_result result = s->frames == 0 && s->scratch == NULL ? start(s, frame) : RLF_OK;
    if (result == RLF_OK && s->rig.has_color && frame->color.data != NULL) {
        result = add_color(s, frame);
    }
    if (result != RLF_OK) {
        return result;
    }
    char name[64];
    snprintf(name, sizeof(name), "depth/%06" PRId64 ".png", s->frames);
    const io_png_def def = {name,
                            counts_of(s, frame),
                            s->rig.depth.width,
                            s->rig.depth.height,
                            (ptrdiff_t)s->rig.depth.width * 2,
                            IO_PNG_GREY_U16,
                            LEVEL};
    s->file.size = 0;
    result = io_png_encode(&def, &s->file);
    if (result == RLF_OK) {
        result = add_file(s, s->depth_list, name, frame->time_ns);
    }
    s->frames += result == RLF_OK ? 1 : 0;
    return result;
}

static uint64_t folder_bytes(const void *self)
{
    return ((const folder_sink *)self)->bytes;
}

static rlf_result folder_close(void *self, rlf_recording_status *status)
{
    folder_sink *s = self;
    bool is_bad = s->depth_list != NULL && fclose(s->depth_list) != 0;
    is_bad = (s->color_list != NULL && fclose(s->color_list) != 0) || is_bad;
    rlf_result result = is_bad ? fail_write(s) : RLF_OK;
    status->bytes = s->bytes;
    io_jpeg_encoder_destroy(&s->jpeg);
    io_byte_buffer_free(&s->file);
    rlf_free(s->scratch);
    rlf_free(s->counts);
    rlf_free(s);
    return result;
}

static rlf_result make_folders(const folder_sink *s)
{
    static const char *const names[2] = {"depth", "rgb"};
    rlf_result result = RLF_OK;
    for (int i = 0; i < (s->rig.has_color ? 2 : 1) && result == RLF_OK; i++) {
        char path[IO_PATH_MAX];
        result = io_path_join(s->path, names[i], path);
        result = result == RLF_OK ? rlf_make_folder(path) : result;
    }
    return result;
}

static rlf_result open_all(folder_sink *s)
{
    rlf_result result = make_folders(s);
    if (result == RLF_OK) {
        result = open_in(s, "depth.txt", &s->depth_list);
    }
    if (result == RLF_OK && s->rig.has_color) {
        result = open_in(s, "rgb.txt", &s->color_list);
    }
    return result == RLF_OK ? io_jpeg_encoder_create(&s->jpeg) : result;
}

rlf_result io_folder_sink_open(const char *path, const rlf_source_info *info,
                               const rlf_recording_def *def, io_sink *out)
{
    folder_sink *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    snprintf(s->path, sizeof(s->path), "%s", path);
    s->rig = info->rig;
    s->jpeg_quality = def->jpeg_quality;
    *out = (io_sink){.add = folder_add, .close = folder_close, .bytes = folder_bytes, .self = s};
    rlf_result result = open_all(s);
    if (result != RLF_OK) {
        rlf_recording_status status;
        folder_close(s, &status);
    }
    return result;
}
