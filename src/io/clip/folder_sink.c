/* Recording into a folder in the TUM RGB-D layout. */
#define _POSIX_C_SOURCE 200809L
#include "io/clip/sink.h"

#include "io/clip/clip.h"
#include "io/picture/picture.h"
#include "io/file.h"
#include "io/folder/folder.h"

#include <errno.h>
#include <inttypes.h>
#include <unistd.h>

#define LINE_SIZE 512
#define LEVEL 3               /* of zlib, as rlf_png_write has it */
#define FLOAT_COUNTS 5000.0   /* per metre, as TUM has it: up to 13.1 m */
#define FAR_FLOAT_COUNTS 1000 /* for cameras that see farther */

/* A file of lines, each of which is there whole or not at all. */
typedef struct text_list {
    int descriptor; /* -1 = none */
    int64_t size;   /* bytes of whole lines */
} text_list;

typedef struct folder_sink {
    char path[IO_PATH_MAX];
    rlf_source_info info;
    rlf_rig rig;
    double units_per_metre;
    int32_t jpeg_quality;
    text_list depth_list, color_list, pose_list, note_list;
    io_frame_notes notes;
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

/* Opens NAME in the folder for writing, unless it is open. */
static rlf_result open_list(const folder_sink *s, const char *name, text_list *list)
{
    char path[IO_PATH_MAX];
    if (list->descriptor >= 0) {
        return RLF_OK;
    }
    rlf_result result = io_path_join(s->path, name, path);
    return result == RLF_OK ? io_out_open_in_place(path, &list->descriptor) : result;
}

static rlf_result add_line(const folder_sink *s, text_list *list, const char *line)
{
    const size_t length = strlen(line);
    size_t done = 0;
    while (done < length) {
        const ssize_t got = write(list->descriptor, line + done, length - done);
        if (got < 0 && errno != EINTR) {
            rlf_result result = fail_write(s);
            if (ftruncate(list->descriptor, (off_t)list->size) == 0) {
                lseek(list->descriptor, (off_t)list->size, SEEK_SET);
            }
            return result;
        }
        done += got > 0 ? (size_t)got : 0;
    }
    list->size += (int64_t)length;
    return RLF_OK;
}

/* The offset is taken away from what is recorded. */
static rlf_result write_camera(const folder_sink *s)
{
    char path[IO_PATH_MAX];
    rlf_rig rig = s->rig;
    rig.depth_offset_m = 0.0;
    rlf_result result = io_path_join(s->path, "camera.json", path);
    return result == RLF_OK ? rlf_rig_save(path, RLF_RIG_RELIEF, &rig, s->units_per_metre, NULL)
                            : result;
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
    if (s->scratch == NULL || s->counts == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->notes.has_color_camera = s->rig.has_color;
    s->notes.flags = frame->flags & (RLF_FRAME_UNMIRRORED | RLF_FRAME_ALIGNED);
    rlf_result result = write_camera(s);
    return result == RLF_OK ? io_folder_write_origin(s->path, &s->info, s->notes.flags) : result;
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
static rlf_result add_file(folder_sink *s, text_list *list, const char *name, int64_t time_ns)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(s->path, name, path);
    result = result == RLF_OK ? rlf_file_write(path, s->file.data, s->file.size) : result;
    if (result != RLF_OK) {
        return result;
    }
    s->bytes += s->file.size;
    const int64_t time = time_ns > 0 ? time_ns : 0;
    char line[LINE_SIZE];
    snprintf(line, sizeof(line), "%" PRId64 ".%09" PRId64 " %s\n", time / 1000000000,
             time % 1000000000, name);
    return add_line(s, list, line);
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
    result = result == RLF_OK ? add_file(s, &s->color_list, name, time_ns) : result;
    s->last_color_ns = time_ns;
    s->colors += result == RLF_OK ? 1 : 0;
    return result;
}

static rlf_result add_pose(folder_sink *s, const rlf_frame *frame)
{
    const rlf_pose *T = &frame->T_world_camera;
    const int64_t time = frame->time_ns > 0 ? frame->time_ns : 0;
    char line[LINE_SIZE];
    snprintf(line, sizeof(line),
             "%" PRId64 ".%09" PRId64 " %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n",
             time / 1000000000, time % 1000000000, T->p.x, T->p.y, T->p.z, T->q.x, T->q.y, T->q.z,
             T->q.w);
    rlf_result result = open_list(s, IO_FOLDER_POSES, &s->pose_list);
    return result == RLF_OK ? add_line(s, &s->pose_list, line) : result;
}

static rlf_result add_notes(folder_sink *s, const rlf_frame *frame)
{
    io_frame_note notes[2];
    const int32_t count = io_frame_notes_add(&s->notes, frame, notes);
    rlf_result result = open_list(s, IO_FOLDER_FRAMES, &s->note_list);
    for (int32_t i = 0; i < count && result == RLF_OK; i++) {
        char text[IO_FRAME_NOTE_TEXT];
        char line[LINE_SIZE];
        io_frame_note_print(&notes[i], text);
        snprintf(line, sizeof(line), "%s\n", text);
        result = add_line(s, &s->note_list, line);
    }
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
    result = frame->has_pose ? add_pose(s, frame) : RLF_OK;
    result = result == RLF_OK ? add_notes(s, frame) : result;
    s->file.size = 0;
    result = result == RLF_OK ? io_png_encode(&def, &s->file) : result;
    if (result == RLF_OK) { /* last: a frame that is listed is whole */
        result = add_file(s, &s->depth_list, name, frame->time_ns);
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
    text_list *const lists[4] = {&s->depth_list, &s->color_list, &s->pose_list, &s->note_list};
    bool is_bad = false;
    for (int i = 0; i < 4; i++) {
        is_bad = (lists[i]->descriptor >= 0 && close(lists[i]->descriptor) != 0) || is_bad;
    }
    rlf_result result = is_bad ? fail_write(s) : RLF_OK;
    status->frames = (uint64_t)s->frames;
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

/* Of an earlier recording: they would be taken for this one's. */
static void remove_old(const folder_sink *s)
{
    static const char *const names[3] = {IO_FOLDER_POSES, IO_FOLDER_SOURCE, IO_FOLDER_FRAMES};
    for (int i = 0; i < 3; i++) {
        char path[IO_PATH_MAX];
        if (io_path_join(s->path, names[i], path) == RLF_OK) {
            (void)unlink(path);
        }
    }
}

static rlf_result open_all(folder_sink *s)
{
    rlf_result result = rlf_make_folder(s->path);
    result = result == RLF_OK ? make_folders(s) : result;
    result = result == RLF_OK ? open_list(s, "depth.txt", &s->depth_list) : result;
    if (result == RLF_OK && s->rig.has_color) {
        result = open_list(s, "rgb.txt", &s->color_list);
    }
    if (result == RLF_OK) {
        remove_old(s);
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
    s->depth_list.descriptor = s->color_list.descriptor = -1;
    s->pose_list.descriptor = s->note_list.descriptor = -1;
    s->info = *info;
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
