/* Frames from a folder of pictures, in the TUM layout with camera.json or in those of data sets. */
#include "relief/io.h"
#include "io/folder/folder.h"
#include "io/calibration/calibration.h"
#include "io/picture/picture.h"
#include "io/file.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct folder {
    char path[IO_PATH_MAX];
    rlf_rig rig;
    double units_per_metre;
    uint32_t flags;
    io_layout layout;
    io_clip_origin origin;
    io_frame_note *notes;
    io_reading reading;
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
    rlf_result result = read_entry(self, &self->layout.depth.entries[index],
                                   self->layout.depth_list_name, &file, path);
    if (result != RLF_OK) {
        return result;
    }
    io_picture picture = {
        .width = self->rig.depth.width, .height = self->rig.depth.height, .data = out};
    result = io_png_decode_u16(&file, &picture);
    if (result == RLF_OK && self->layout.missing != 0) {
        uint16_t *depth = out;
        const size_t count = (size_t)picture.width * (size_t)picture.height;
        for (size_t i = 0; i < count; i++) {
            depth[i] = depth[i] == self->layout.missing ? 0 : depth[i];
        }
    }
    return result;
}

static rlf_result read_color(void *context, int32_t index, const rlf_image_rgba8 *out)
{
    folder *self = context;
    char path[IO_PATH_MAX];
    io_bytes file;
    rlf_result result = read_entry(self, &self->layout.color.entries[index],
                                   self->layout.color_list_name, &file, path);
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
    io_layout_free(&self->layout);
    rlf_free(self->notes);
    io_reading_end_folder(&self->reading);
    io_buffer_free(&self->file);
    rlf_free(self);
}

static rlf_result open_depth(folder *self)
{
    rlf_result result = io_layout_read(self->path, &self->layout);
    if (result != RLF_OK) {
        return result;
    }
    if (self->layout.depth.count == 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s/%s: lists no depth pictures: write one \"SECONDS FILE\" line "
                        "per picture there",
                        self->path, self->layout.depth_list_name);
    }
    return io_layout_read_poses(self->path, &self->layout);
}

/* The pictures and the colour camera are both optional; one without the other gives no colour. */
static void check_color(folder *self)
{
    bool has_pictures = self->layout.color.count > 0;
    if (has_pictures && !self->rig.has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s/camera.json: has no \"color\" object, so the pictures of %s are not used",
                self->path, self->layout.color_list_name);
    }
    if (!has_pictures && self->rig.has_color) {
        rlf_log(RLF_LOG_WARNING, "%s/%s: lists no pictures, so there is no colour", self->path,
                self->layout.color_list_name);
    }
    self->rig.has_color = has_pictures && self->rig.has_color;
}

enum { ASKED = 3 }; /* pictures of a list: its first, its middle and its last one */

/* They tell whether the camera's size is right, before memory is asked for that is many times as
 * large. One that differs from the others, or cannot be read, is told when its frame comes. */
static rlf_result check_size(folder *self, const io_frame_list *list, const rlf_camera *camera)
{
    rlf_result result = RLF_OK;
    for (int k = 0; k < ASKED && list->count > 0; k++) {
        char path[IO_PATH_MAX];
        io_bytes file;
        int32_t width = 0;
        int32_t height = 0;
        const io_list_entry *entry = &list->entries[k * (list->count - 1) / (ASKED - 1)];
        if (read_entry(self, entry, "the folder", &file, path) != RLF_OK ||
            !io_picture_size(&file, &width, &height)) {
            continue;
        }
        if (width == camera->width && height == camera->height) {
            return RLF_OK;
        }
        if (result == RLF_OK) {
            result = io_picture_fail_size(path, width, height, camera->width, camera->height);
        }
    }
    return result;
}

static rlf_result check_sizes(folder *self)
{
    rlf_result result = check_size(self, &self->layout.depth, &self->rig.depth);
    return result == RLF_OK && self->rig.has_color
               ? check_size(self, &self->layout.color, &self->rig.color)
               : result;
}

/* The first picture of a list that can be read; the caller frees its data. */
static rlf_result read_first(folder *self, const io_frame_list *list, bool is_depth,
                             io_picture *out)
{
    rlf_result result = RLF_OK;
    for (int k = 0; k < ASKED; k++) {
        char path[IO_PATH_MAX];
        io_bytes file;
        memset(out, 0, sizeof(*out));
        const io_list_entry *entry = &list->entries[k * (list->count - 1) / (ASKED - 1)];
        result = read_entry(self, entry, "the folder", &file, path);
        if (result == RLF_OK) {
            result = is_depth ? io_png_decode_u16(&file, out) : io_picture_decode(&file, out);
        }
        if (result == RLF_OK) {
            return RLF_OK;
        }
    }
    return result;
}

static rlf_result make_depth_camera(folder *self)
{
    io_picture depth;
    rlf_result result = read_first(self, &self->layout.depth, true, &depth);
    if (result == RLF_OK) {
        result = io_layout_camera(self->path, &self->layout, depth.width, depth.height,
                                  &self->rig.depth);
        self->units_per_metre = self->layout.units_per_metre;
        if (self->units_per_metre <= 0.0) {
            self->units_per_metre =
                io_guess_units(depth.data, (size_t)depth.width * (size_t)depth.height);
            rlf_log(RLF_LOG_WARNING, "%s: depth is taken to have %g counts a metre", self->path,
                    self->units_per_metre);
        }
        rlf_free(depth.data);
    }
    return result;
}

/* Pictures of one shape are taken to be aligned, as in all these data sets. */
static rlf_result make_color_camera(folder *self)
{
    rlf_rig *rig = &self->rig;
    io_picture color;
    if (read_first(self, &self->layout.color, false, &color) != RLF_OK) {
        return RLF_OK; /* each is told when its frame comes */
    }
    rlf_free(color.data);
    const double shape = (double)color.width / color.height;
    const double ours = (double)rig->depth.width / rig->depth.height;
    rig->has_color = fabs(shape - ours) < 0.02 * ours;
    if (rig->has_color) {
        rig->color = rlf_camera_resize(&rig->depth, color.width, color.height);
    } else {
        rlf_log(RLF_LOG_WARNING,
                "%s: colour is left out: its pictures of %d x %d are not aligned to depth's %d x "
                "%d, and without a camera.json nothing tells where its camera is",
                self->path, (int)color.width, (int)color.height, (int)rig->depth.width,
                (int)rig->depth.height);
        io_frame_list_free(&self->layout.color);
    }
    return RLF_OK;
}

/* Without camera.json: one camera for both pictures. */
static rlf_result make_rig(folder *self)
{
    self->rig = rlf_rig_default();
    rlf_result result = make_depth_camera(self);
    if (result == RLF_OK && self->layout.color.count > 0) {
        result = make_color_camera(self);
    }
    self->flags = RLF_FRAME_ALIGNED;
    return result;
}

static rlf_result load_rig(const rlf_address *address, folder *self)
{
    if (address->rig != NULL) {
        self->rig = *address->rig;
        self->units_per_metre = address->units_per_metre;
        return RLF_OK;
    }
    if (!io_folder_has(self->path, "camera.json")) {
        return make_rig(self);
    }
    char camera_path[IO_PATH_MAX];
    rlf_result result = io_path_join(self->path, "camera.json", camera_path);
    return result == RLF_OK ? rlf_rig_load(camera_path, &self->rig, &self->units_per_metre)
                            : result;
}

static io_times times_of(const io_frame_list *list)
{
    return (io_times){list->entries, sizeof(list->entries[0]), list->count};
}

static rlf_result open_clip(folder *self, rlf_opened *out)
{
    const io_clip_def def = {.name = self->path,
                             .device = self->layout.description,
                             .rig = self->rig,
                             .units_per_metre = self->units_per_metre,
                             .depth = times_of(&self->layout.depth),
                             .color = times_of(&self->layout.color),
                             .poses = self->layout.poses,
                             .flags = self->flags,
                             .origin = self->origin,
                             .read_depth = read_depth,
                             .read_color = read_color,
                             .destroy = folder_destroy,
                             .self = self};
    return io_clip_open(&def, out);
}

static rlf_result open_all(const rlf_address *address, folder *self, rlf_opened *out)
{
    rlf_result result = open_depth(self);
    result = result == RLF_OK ? load_rig(address, self) : result;
    if (result == RLF_OK) {
        check_color(self);
        result = check_sizes(self);
    }
    if (result == RLF_OK) {
        result = io_folder_read_origin(self->path, &self->origin, &self->flags, &self->notes);
    }
    if (result == RLF_OK) {
        /* Pictures rarely come out larger than their pixels: one reservation serves the clip. */
        const size_t pixels = (size_t)self->rig.depth.width * (size_t)self->rig.depth.height;
        result = io_buffer_reserve(&self->file, pixels * 2 + 65536);
    }
    return result == RLF_OK ? open_clip(self, out) : result;
}

static rlf_result check_is_folder(const char *path)
{
    if (!io_path_exists(path)) {
        return rlf_fail(RLF_ERROR_IO,
                        "%s: no such file or folder: give a folder with depth.txt and "
                        "camera.json, or synthetic:room",
                        path);
    }
    if (!io_path_is_folder(path)) {
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
    self->reading = io_reading_begin_folder(path);
    return io_open_end(open_all(address, self, out), self, folder_destroy);
}

const rlf_backend io_backend_folder = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "folder",
    .summary = "a clip of PNG/JPEG: depth.txt, rgb.txt, camera.json (TUM), or as in ICL-NUIM, "
               "Open3D/Redwood, 7-Scenes",
    .recognises = io_path_is_folder, /* any: what is missing in it is told when it is opened */
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
