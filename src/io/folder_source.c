/* Frames from a folder in the TUM RGB-D layout: depth.txt, rgb.txt, camera.json and pictures. */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"
#include "io/frame_list.h"
#include "io/picture.h"

#include <string.h>
#include <sys/stat.h>

/* Colour farther in time than this shows something else than the depth (one and a half frames at
 * 30 per second; TUM clips differ by up to 20 ms). */
#define COLOR_GAP_MAX_NS 50000000

typedef struct folder {
    char path[IO_PATH_MAX];
    rlf_rig rig;
    double units_per_metre;
    io_frame_list depth_list;
    io_frame_list color_list;
    int32_t next;          /* into depth_list */
    int32_t shown_color;   /* index whose picture is in `color`; -1 = none */
    uint16_t *depth;       /* rig.depth.width x height */
    rlf_image_rgba8 color; /* rig.color.width x height */
    io_buffer file;        /* of the picture being decoded */
} folder;

/* Reads the picture that an entry of `list_name` names. */
static rlf_result read_entry(folder *self, const io_list_entry *entry, const char *list_name,
                             io_bytes *out, char path[IO_PATH_MAX])
{
    rlf_result result = io_path_join(self->path, entry->name, path);
    if (result != RLF_OK) {
        return result;
    }
    char cure[96];
    snprintf(cure, sizeof(cure), "put the file there, or take line %d out of %s", (int)entry->line,
             list_name);
    return io_file_read(path, IO_PICTURE_FILE_MAX, cure, &self->file, out);
}

static rlf_result read_depth(folder *self, const io_list_entry *entry)
{
    char path[IO_PATH_MAX];
    io_bytes file;
    rlf_result result = read_entry(self, entry, "depth.txt", &file, path);
    if (result != RLF_OK) {
        return result;
    }
    io_picture picture = {
        .width = self->rig.depth.width, .height = self->rig.depth.height, .data = self->depth};
    return io_png_decode_u16(&file, &picture);
}

static rlf_result read_color(folder *self, int32_t index)
{
    if (index == self->shown_color) {
        return RLF_OK;
    }
    self->shown_color = -1; /* a failed decoding may leave half a picture */
    char path[IO_PATH_MAX];
    io_bytes file;
    rlf_result result = read_entry(self, &self->color_list.entries[index], "rgb.txt", &file, path);
    if (result != RLF_OK) {
        return result;
    }
    io_picture picture = {.width = self->color.width,
                          .height = self->color.height,
                          .data = self->color.data,
                          .is_opaque = true};
    result = io_picture_decode(&file, &picture);
    if (result == RLF_OK) {
        self->shown_color = index;
    }
    return result;
}

static rlf_result folder_next(void *context, rlf_frame *out)
{
    folder *self = context;
    if (self->next >= self->depth_list.count) {
        return RLF_END;
    }
    /* A frame that fails is passed over by the next call: the caller decides whether to go on. */
    int32_t index = self->next++;
    const io_list_entry *entry = &self->depth_list.entries[index];
    rlf_result result = read_depth(self, entry);
    int32_t color_index = -1;
    if (result == RLF_OK && self->rig.has_color) {
        color_index = io_frame_list_nearest(&self->color_list, entry->time_ns, COLOR_GAP_MAX_NS);
    }
    if (color_index >= 0) {
        result = read_color(self, color_index);
    }
    if (result != RLF_OK) {
        return result;
    }
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)index;
    out->time_ns = entry->time_ns;
    out->depth_u16 = self->depth;
    out->depth_stride = (ptrdiff_t)self->rig.depth.width * 2;
    out->depth_units_per_metre = self->units_per_metre;
    if (color_index >= 0) {
        out->color = self->color;
    }
    return RLF_OK;
}

static rlf_result folder_restart(void *context)
{
    folder *self = context;
    self->next = 0;
    return RLF_OK;
}

static void folder_destroy(void *context)
{
    folder *self = context;
    io_frame_list_free(&self->depth_list);
    io_frame_list_free(&self->color_list);
    io_buffer_free(&self->file);
    rlf_free(self->depth);
    rlf_free(self->color.data);
    rlf_free(self);
}

static rlf_result read_list(folder *self, const char *name, const char *cure, io_frame_list *out)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(self->path, name, path);
    io_bytes file;
    if (result == RLF_OK) {
        result = io_file_read(path, IO_LIST_FILE_MAX, cure, &self->file, &file);
    }
    return result == RLF_OK ? io_frame_list_parse(&file, out) : result;
}

static rlf_result open_depth(folder *self)
{
    rlf_result result =
        read_list(self, "depth.txt", "write one \"SECONDS FILE\" line per depth picture there",
                  &self->depth_list);
    if (result != RLF_OK) {
        return result;
    }
    if (self->depth_list.count == 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s/depth.txt: lists no depth pictures: write one \"SECONDS FILE\" line "
                        "per picture there",
                        self->path);
    }
    size_t pixels = (size_t)self->rig.depth.width * (size_t)self->rig.depth.height;
    self->depth = rlf_alloc_array(pixels, sizeof(self->depth[0]));
    if (self->depth == NULL) {
        return RLF_ERROR_MEMORY;
    }
    /* Pictures rarely come out larger than their pixels: one reservation serves the whole clip. */
    return io_buffer_reserve(&self->file, pixels * 2 + 65536);
}

static bool exists(const folder *self, const char *name)
{
    char path[IO_PATH_MAX];
    struct stat status;
    return io_path_join(self->path, name, path) == RLF_OK && stat(path, &status) == 0;
}

/* rgb.txt and the colour camera are both optional; one without the other gives no colour. */
static rlf_result open_color(folder *self)
{
    if (exists(self, "rgb.txt")) {
        rlf_result result = read_list(self, "rgb.txt", "check the file", &self->color_list);
        if (result != RLF_OK) {
            return result;
        }
    }
    bool has_pictures = self->color_list.count > 0;
    if (has_pictures && !self->rig.has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s/camera.json: has no \"color\" object, so the pictures of rgb.txt are not used",
                self->path);
    }
    if (!has_pictures && self->rig.has_color) {
        rlf_log(RLF_LOG_WARNING, "%s/rgb.txt: lists no pictures, so there is no colour",
                self->path);
    }
    self->rig.has_color = has_pictures && self->rig.has_color;
    if (!self->rig.has_color) {
        return RLF_OK;
    }
    int32_t width = self->rig.color.width;
    int32_t height = self->rig.color.height;
    uint8_t *data = rlf_alloc_array((size_t)width * (size_t)height, 4);
    self->color = (rlf_image_rgba8){data, width, height, (ptrdiff_t)width * 4};
    return data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

static rlf_result open_all(folder *self, rlf_source_info *info)
{
    char camera_path[IO_PATH_MAX];
    rlf_result result = io_path_join(self->path, "camera.json", camera_path);
    if (result == RLF_OK) {
        result = rlf_rig_load(camera_path, &self->rig, &self->units_per_metre);
    }
    if (result == RLF_OK) {
        result = open_depth(self);
    }
    if (result == RLF_OK) {
        result = open_color(self);
    }
    if (result == RLF_OK) {
        result = io_frame_list_rate(&self->depth_list, &info->frames_per_second);
    }
    snprintf(info->name, sizeof(info->name), "%.127s", self->path);
    info->rig = self->rig;
    info->frame_count = self->depth_list.count;
    info->is_live = false;
    return result;
}

static rlf_result check_is_folder(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: no such file or folder: give a folder with depth.txt and "
                        "camera.json, or synthetic:room",
                        path);
    }
    if (!S_ISDIR(status.st_mode)) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: is a file, and this build reads folders: give the folder that holds "
                        "depth.txt and camera.json",
                        path);
    }
    if (strlen(path) >= IO_PATH_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "%.100s...: the path is too long: use a shorter one",
                        path);
    }
    return RLF_OK;
}

rlf_result rlf_folder_source_open(const char *path, rlf_source **out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = check_is_folder(path);
    if (result != RLF_OK) {
        return result;
    }
    folder *self = rlf_alloc(sizeof(*self));
    if (self == NULL) {
        return RLF_ERROR_MEMORY;
    }
    memcpy(self->path, path, strlen(path) + 1);
    self->shown_color = -1;
    rlf_source_info info = {0};
    result = open_all(self, &info);
    if (result == RLF_OK) {
        static const rlf_source_methods methods = {
            .next = folder_next, .restart = folder_restart, .destroy = folder_destroy};
        result = rlf_source_create_custom(&methods, &info, self, out);
    }
    if (result != RLF_OK) {
        folder_destroy(self);
    }
    return result;
}
