/* How the pictures of a folder are arranged. */
#include "io/folder/folder.h"

#include <stdio.h>
#include <string.h>

static const char *const depth_endings[] = {".png", NULL};
static const char *const color_endings[] = {".png", ".jpg", ".jpeg", NULL};
static const char *const scenes7_depth[] = {".depth.png", NULL};
static const char *const scenes7_color[] = {".color.png", ".color.jpg", NULL};

static rlf_result read_list(const char *folder, const char *name, const char *cure,
                            io_frame_list *out)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, name, path);
    io_buffer buffer = {0};
    io_bytes file;
    result = result == RLF_OK ? io_file_read(path, IO_LIST_FILE_MAX, cure, &buffer, &file) : result;
    result = result == RLF_OK ? io_frame_list_parse(&file, out) : result;
    io_buffer_free(&buffer);
    return result;
}

static rlf_result read_tum(const char *folder, io_layout *out)
{
    out->description = "folder in the TUM layout";
    out->depth_list_name = "depth.txt";
    out->color_list_name = "rgb.txt";
    out->units_per_metre = strstr(folder, "freiburg") != NULL ? 5000.0 : 0.0;
    rlf_result result = read_list(
        folder, "depth.txt",
        "write one \"SECONDS FILE\" line per depth picture there, and camera.json beside it",
        &out->depth);
    if (result == RLF_OK && io_folder_has(folder, "rgb.txt")) {
        result = read_list(folder, "rgb.txt", "check the file", &out->color);
    }
    return result;
}

/* ICL-NUIM writes frame numbers where TUM writes seconds. */
static rlf_result read_associations(const char *folder, const char *name, io_layout *out)
{
    char path[IO_PATH_MAX];
    io_buffer buffer = {0};
    io_bytes file;
    bool has_numbers = false;
    out->depth_list_name = out->color_list_name = name;
    out->units_per_metre = 5000.0;
    rlf_result result = io_path_join(folder, name, path);
    if (result == RLF_OK) {
        result = io_file_read(path, IO_LIST_FILE_MAX, "check the file", &buffer, &file);
    }
    if (result == RLF_OK) {
        result = io_associations_parse(&file, &out->depth, &out->color, &has_numbers);
    }
    io_buffer_free(&buffer);
    out->kind = has_numbers ? IO_LAYOUT_ICL : IO_LAYOUT_TUM;
    out->description =
        has_numbers ? "folder in the ICL-NUIM layout" : "folder in the TUM layout, associated";
    return result;
}

static rlf_result read_scenes7(const char *folder, io_layout *out)
{
    out->kind = IO_LAYOUT_SCENES7;
    out->description = "folder in the 7-Scenes layout";
    out->units_per_metre = 1000.0;
    out->missing = 65535;
    rlf_result result = io_numbered_list(folder, "", "frame-", scenes7_depth, &out->depth);
    return result == RLF_OK ? io_numbered_list(folder, "", "frame-", scenes7_color, &out->color)
                            : result;
}

static rlf_result read_redwood(const char *folder, io_layout *out)
{
    static const char *const subs[] = {"color", "image", "rgb", NULL};
    out->kind = IO_LAYOUT_REDWOOD;
    out->description = "folder in the layout of Open3D and Redwood";
    out->units_per_metre = 1000.0;
    rlf_result result = io_numbered_list(folder, "depth", "", depth_endings, &out->depth);
    for (int i = 0; subs[i] != NULL && result == RLF_OK && out->color.count == 0; i++) {
        io_frame_list_free(&out->color);
        result = io_numbered_list(folder, subs[i], "", color_endings, &out->color);
    }
    return result;
}

/* 16-bit grey PNG, by its header. */
static bool is_depth_picture(const char *folder, const char *name)
{
    char path[IO_PATH_MAX];
    unsigned char head[26] = {0}; /* signature, length, "IHDR", width, height, bits, colour type */
    FILE *file = io_path_join(folder, name, path) == RLF_OK ? fopen(path, "rb") : NULL;
    const bool is_whole = file != NULL && fread(head, 1, sizeof(head), file) == sizeof(head);
    if (file != NULL) {
        fclose(file);
    }
    return is_whole && memcmp(head + 12, "IHDR", 4) == 0 && head[24] == 16 && head[25] == 0;
}

/* Nothing in the names says depth: all PNG files of the folder are of depth, or none is taken. */
static rlf_result read_bare(const char *folder, io_layout *out)
{
    rlf_result result = io_named_list(folder, "", "", depth_endings, &out->depth);
    for (int32_t i = 0; i < out->depth.count; i++) {
        if (!is_depth_picture(folder, out->depth.entries[i].name)) {
            io_frame_list_free(&out->depth);
        }
    }
    return result;
}

/* Whatever they are called: pictures in a folder for depth, or that say so in their names. */
static rlf_result read_named(const char *folder, io_layout *out)
{
    static const char *const depth_subs[] = {"depth", "depths", "depth_images", "", NULL};
    static const char *const color_subs[] = {"rgb", "color", "colour", "image", "images", "", NULL};
    static const char *const color_words[] = {"rgb", "color", "colour", NULL};
    out->kind = IO_LAYOUT_NAMED;
    out->description = "folder of pictures, in the order of their names";
    rlf_result result = RLF_OK;
    for (int i = 0; depth_subs[i] != NULL && result == RLF_OK && out->depth.count == 0; i++) {
        const char *word = depth_subs[i][0] == '\0' ? "depth" : "";
        result = io_named_list(folder, depth_subs[i], word, depth_endings, &out->depth);
    }
    if (result == RLF_OK && out->depth.count == 0) {
        return read_bare(folder, out);
    }
    for (int i = 0; color_subs[i] != NULL && result == RLF_OK && out->color.count == 0; i++) {
        const bool is_beside = color_subs[i][0] == '\0';
        for (int k = 0; color_words[k] != NULL && result == RLF_OK && out->color.count == 0; k++) {
            result = io_named_list(folder, color_subs[i], is_beside ? color_words[k] : "",
                                   color_endings, &out->color);
        }
    }
    return result;
}

/* One line: nothing tells the times, nor always which pictures go together. */
static rlf_result take_named(const char *folder, io_layout *out)
{
    rlf_result result = read_named(folder, out);
    if (result != RLF_OK || out->depth.count == 0) {
        return result;
    }
    const int32_t colors = out->color.count;
    if (!io_named_pair(&out->depth, &out->color)) {
        io_frame_list_free(&out->color);
    }
    rlf_log(RLF_LOG_WARNING,
            "%s: has no depth.txt: %d depth pictures are taken in the order of their names (%s "
            "first), %d a second%s",
            folder, (int)out->depth.count, out->depth.entries[0].name, IO_NUMBERED_RATE,
            colors > out->color.count
                ? "; those of colour are left out: nothing tells which go together"
                : "");
    return RLF_OK;
}

static const char *associations_name(const char *folder)
{
    static const char *const names[] = {"associations.txt", "associated.txt", "association.txt"};
    for (int i = 0; i < 3; i++) {
        if (io_folder_has(folder, names[i])) {
            return names[i];
        }
    }
    return NULL;
}

rlf_result io_layout_read(const char *folder, io_layout *out)
{
    memset(out, 0, sizeof(*out));
    out->depth_list_name = out->color_list_name = "the folder";
    if (io_folder_has(folder, "depth.txt")) {
        return read_tum(folder, out);
    }
    const char *associations = associations_name(folder);
    if (associations != NULL) {
        return read_associations(folder, associations, out);
    }
    rlf_result result = read_scenes7(folder, out);
    if (result == RLF_OK && out->depth.count == 0) {
        io_layout_free(out);
        result = read_redwood(folder, out);
    }
    if (result == RLF_OK && out->depth.count == 0) {
        io_layout_free(out);
        result = take_named(folder, out);
    }
    if (result == RLF_OK && out->depth.count == 0) {
        io_layout_free(out);
        result = read_tum(folder, out); /* says that depth.txt is not there */
    }
    return result;
}

void io_layout_free(io_layout *layout)
{
    io_frame_list_free(&layout->depth);
    io_frame_list_free(&layout->color);
    rlf_free(layout->poses);
    layout->poses = NULL;
    layout->missing = 0;
    layout->depth_list_name = layout->color_list_name = "the folder";
}
