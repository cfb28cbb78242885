/* The poses that lie beside the pictures of a folder. */
#define _POSIX_C_SOURCE 200809L
#include "io/folder/folder.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

#define TUM_GAP_NS 20000000 /* a pose farther in time is of another place */

/* Name of a file in the folder that ends so; false when there is none. The first by name. */
static bool find_ending(const char *folder, const char *ending, char out[IO_PATH_MAX])
{
    DIR *directory = opendir(folder);
    bool is_found = false;
    const size_t length = strlen(ending);
    for (struct dirent *e = directory != NULL ? readdir(directory) : NULL; e != NULL;
         e = readdir(directory)) {
        const size_t size = strlen(e->d_name);
        if (size > length && size < IO_PATH_MAX && strcmp(e->d_name + size - length, ending) == 0 &&
            (!is_found || strcmp(e->d_name, out) < 0)) {
            memcpy(out, e->d_name, size + 1);
            is_found = true;
        }
    }
    if (directory != NULL) {
        closedir(directory);
    }
    return is_found;
}

static rlf_result read_whole(const char *folder, const char *name, io_buffer *buffer, io_bytes *out,
                             char path[IO_PATH_MAX])
{
    rlf_result result = io_path_join(folder, name, path);
    if (result == RLF_OK) {
        result = io_file_read(path, IO_POSE_FILE_MAX, "put the file there", buffer, out);
    }
    if (result == RLF_OK) {
        *out = io_bytes_unmarked(out);
    }
    return result;
}

/* groundtruth.txt, or what ICL-NUIM calls traj0.gt.freiburg. */
static rlf_result read_tum(const char *folder, io_layout *layout)
{
    char name[IO_PATH_MAX] = "groundtruth.txt";
    if (!io_folder_has(folder, name) && !find_ending(folder, ".gt.freiburg", name)) {
        return RLF_NO_FRAME;
    }
    const bool is_icl = layout->kind == IO_LAYOUT_ICL;
    char path[IO_PATH_MAX];
    io_buffer buffer = {0};
    io_bytes file;
    io_pose_list list = {0};
    rlf_result result = read_whole(folder, name, &buffer, &file, path);
    if (result == RLF_OK) {
        const io_frame_list *d = &layout->depth;
        const double scale = is_icl ? 1e-9 * IO_NUMBERED_RATE : 1e-9;
        const double first_s = d->count > 0 ? scale * (double)d->entries[0].time_ns : 0.0;
        const double last_s = d->count > 0 ? scale * (double)d->entries[d->count - 1].time_ns : 0.0;
        result = io_pose_list_tum(&file, first_s, last_s, &list);
    }
    /* Those of a recording have the times of its frames, or there is none. */
    const int64_t gap_ns = io_folder_has(folder, IO_FOLDER_SOURCE) ? 0
                           : is_icl                                ? TUM_GAP_NS / 2
                                                                   : TUM_GAP_NS;
    for (int32_t i = 0; i < list.count && is_icl; i++) {
        list.times[i] /= IO_NUMBERED_RATE; /* frame numbers there, too */
        list.poses[i] = io_pose_flip_y(&list.poses[i]);
    }
    for (int32_t i = 0; result == RLF_OK && i < layout->depth.count; i++) {
        layout->poses[i] = io_pose_list_at(&list, layout->depth.entries[i].time_ns, gap_ns);
    }
    io_pose_list_free(&list);
    io_buffer_free(&buffer);
    return result;
}

/* The k-th pose is that of the k-th picture. */
static rlf_result read_log(const char *folder, io_layout *layout)
{
    char name[IO_PATH_MAX];
    if (!find_ending(folder, ".log", name)) {
        return RLF_NO_FRAME;
    }
    char path[IO_PATH_MAX];
    io_buffer buffer = {0};
    io_bytes file;
    io_pose_list list = {0};
    rlf_result result = read_whole(folder, name, &buffer, &file, path);
    result = result == RLF_OK ? io_pose_list_log(&file, &list) : result;
    for (int32_t i = 0; result == RLF_OK && i < layout->depth.count && i < list.count; i++) {
        layout->poses[i] = list.poses[i];
    }
    if (result == RLF_OK && list.count != layout->depth.count) {
        rlf_log(RLF_LOG_WARNING, "%s: holds %d poses for %d depth pictures", path, (int)list.count,
                (int)layout->depth.count);
    }
    io_pose_list_free(&list);
    io_buffer_free(&buffer);
    return result;
}

/* frame-000012.depth.png has its pose in frame-000012.pose.txt. */
static rlf_result read_scenes7(const char *folder, io_layout *layout)
{
    io_buffer buffer = {0};
    for (int32_t i = 0; i < layout->depth.count; i++) {
        char name[IO_PATH_MAX];
        char path[IO_PATH_MAX];
        io_bytes file;
        const char *picture = layout->depth.entries[i].name;
        const size_t stem = strcspn(picture, ".");
        snprintf(name, sizeof(name), "%.*s.pose.txt", (int)stem, picture);
        if (io_folder_has(folder, name) &&
            read_whole(folder, name, &buffer, &file, path) == RLF_OK) {
            layout->poses[i] = io_pose_matrix(&file);
        }
    }
    io_buffer_free(&buffer);
    return RLF_OK;
}

rlf_result io_layout_read_poses(const char *folder, io_layout *layout)
{
    layout->poses = rlf_alloc_array((size_t)layout->depth.count, sizeof(layout->poses[0]));
    if (layout->poses == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = RLF_OK;
    switch (layout->kind) {
    case IO_LAYOUT_NAMED: break;
    case IO_LAYOUT_TUM:
    case IO_LAYOUT_ICL: result = read_tum(folder, layout); break;
    case IO_LAYOUT_SCENES7: result = read_scenes7(folder, layout); break;
    case IO_LAYOUT_REDWOOD: result = read_log(folder, layout); break;
    }
    return result == RLF_NO_FRAME ? RLF_OK : result;
}
