/* Frames from a folder in the TUM RGB-D layout: depth.txt, rgb.txt, camera.json and pictures. */
#define _POSIX_C_SOURCE 200809L
#include "relief/io.h"
#include "io/folder/frame_list.h"
#include "io/picture.h"
#include "io/source/backends.h"
#include "io/source/clip.h"

#include <string.h>
#include <sys/stat.h>

typedef struct folder {
    char path[IO_PATH_MAX];
    rlf_rig rig;
    double units_per_metre;
    io_frame_list depth_list;
    io_frame_list color_list;
    io_buffer file; /* of the picture being decoded */
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

static rlf_result read_depth(void *context, int32_t index, void *out)
{
    folder *self = context;
    char path[IO_PATH_MAX];
    io_bytes file;
    rlf_result result =
        read_entry(self, &self->depth_list.entries[index], "depth.txt", &file, path);
    if (result != RLF_OK) {
        return result;
    }
    io_picture picture = {
        .width = self->rig.depth.width, .height = self->rig.depth.height, .data = out};
    return io_png_decode_u16(&file, &picture);
}

static rlf_result read_color(void *context, int32_t index, const rlf_image_rgba8 *out)
{
    folder *self = context;
    char path[IO_PATH_MAX];
    io_bytes file;
    rlf_result result = read_entry(self, &self->color_list.entries[index], "rgb.txt", &file, path);
    if (result != RLF_OK) {
        return result;
    }
    io_picture picture = {
        .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
    return io_picture_decode(&file, &picture);
}

static void folder_destroy(void *context)
{
    folder *self = context;
    io_frame_list_free(&self->depth_list);
    io_frame_list_free(&self->color_list);
    io_buffer_free(&self->file);
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
    return RLF_OK;
}

static rlf_result load_rig(const rlf_address *address, folder *self)
{
    if (address->rig != NULL) {
        self->rig = *address->rig;
        self->units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    char camera_path[IO_PATH_MAX];
    rlf_result result = io_path_join(self->path, "camera.json", camera_path);
    return result == RLF_OK ? rlf_rig_load(camera_path, &self->rig, &self->units_per_metre)
                            : result;
}

/* New array of a list's times. */
static int64_t *times_of(const io_frame_list *list)
{
    int64_t *times = rlf_alloc_array((size_t)list->count, sizeof(times[0]));
    for (int32_t i = 0; times != NULL && i < list->count; i++) {
        times[i] = list->entries[i].time_ns;
    }
    return times;
}

static rlf_result open_clip(folder *self, rlf_opened *out)
{
    int64_t *depth_times = times_of(&self->depth_list);
    int64_t *color_times = times_of(&self->color_list);
    rlf_result result = RLF_ERROR_MEMORY;
    if (depth_times != NULL && color_times != NULL) {
        const io_clip_def def = {.name = self->path,
                                 .rig = self->rig,
                                 .units_per_metre = self->units_per_metre,
                                 .depth_times = depth_times,
                                 .color_times = color_times,
                                 .depth_count = self->depth_list.count,
                                 .color_count = self->color_list.count,
                                 .read_depth = read_depth,
                                 .read_color = read_color,
                                 .destroy = folder_destroy,
                                 .self = self};
        result = io_clip_open(&def, out);
    }
    rlf_free(depth_times);
    rlf_free(color_times);
    return result;
}

static rlf_result open_all(const rlf_address *address, folder *self, rlf_opened *out)
{
    rlf_result result = load_rig(address, self);
    if (result == RLF_OK) {
        result = open_depth(self);
    }
    if (result == RLF_OK) {
        result = open_color(self);
    }
    return result == RLF_OK ? open_clip(self, out) : result;
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

static rlf_result folder_open(const rlf_address *address, rlf_opened *out)
{
    const char *path = address->place;
    rlf_result result = check_is_folder(path);
    if (result != RLF_OK) {
        return result;
    }
    folder *self = rlf_alloc(sizeof(*self));
    if (self == NULL) {
        return RLF_ERROR_MEMORY;
    }
    memcpy(self->path, path, strlen(path) + 1);
    result = open_all(address, self, out);
    if (result != RLF_OK) {
        folder_destroy(self);
        return result;
    }
    snprintf(out->info.device, sizeof(out->info.device), "folder in the TUM layout");
    return RLF_OK;
}

/* Any folder: what is missing in it is told when it is opened. */
static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

const rlf_backend io_backend_folder = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "folder",
    .summary = "a clip: depth.txt, rgb.txt, PNG/JPEG, camera.json (TUM layout)",
    .recognises = is_folder,
    .open = folder_open,
};

rlf_result rlf_folder_source_open(const char *path, rlf_source **out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    const rlf_address address = {.source = path, .place = path};
    rlf_opened opened;
    rlf_result result = folder_open(&address, &opened);
    return result == RLF_OK ? io_source_create(&opened, out) : result;
}
