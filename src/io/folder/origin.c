/* What a folder that Relief has recorded says beside its pictures. */
#define _POSIX_C_SOURCE 200809L
#include "io/folder/folder.h"

#include "io/json.h"

#include <string.h>
#include <unistd.h>

#define LASTING (RLF_FRAME_UNMIRRORED | RLF_FRAME_ALIGNED)

rlf_result io_folder_write_origin(const char *folder, const rlf_source_info *info, uint32_t flags)
{
    char path[IO_PATH_MAX];
    rlf_result result = io_path_join(folder, IO_FOLDER_SOURCE, path);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_vec3 g = info->gravity;
    json_t *root = json_pack("{s:[f,f,f], s:b, s:f, s:i}", "gravity", g.x, g.y, g.z, "is_simulated",
                             (int)info->is_simulated, "frames_per_second", info->frames_per_second,
                             "frame_flags", (int)flags);
    /* Names that are no UTF-8 are left out. */
    json_object_set_new(root, "source", json_string(info->name));
    json_object_set_new(root, "device", json_string(info->device));
    return io_json_write(path, root, 0);
}

static rlf_result read_facts(const io_json_object *top, io_clip_origin *out, uint32_t *out_flags)
{
    static const io_json_field gravity = {
        "gravity", "three numbers in m/s^2 in the depth camera's frame, 0 0 0 = not known",
        -IO_GRAVITY_MAX, IO_GRAVITY_MAX, false};
    static const io_json_field simulated = {"is_simulated", "true or false", 0, 0, false};
    static const io_json_field rate = {
        "frames_per_second", "the frames a second, 0 = by their times", 0, IO_RATE_MAX, false};
    static const io_json_field lasting = {
        "frame_flags", "the flags of every frame, a sum of 1 (unmirrored) and 2 (aligned)", 0,
        LASTING, false};
    double g[3] = {0};
    int32_t flags = 0;
    rlf_result result = io_json_get_numbers(top, &gravity, g, 3);
    result = result == RLF_OK ? io_json_get_bool(top, &simulated, &out->is_simulated) : result;
    result = result == RLF_OK ? io_json_get_number(top, &rate, &out->frames_per_second) : result;
    result = result == RLF_OK ? io_json_get_integer(top, &lasting, &flags) : result;
    out->gravity = rlf_vec3_make(g[0], g[1], g[2]);
    *out_flags |= (uint32_t)flags;
    return result;
}

static rlf_result read_source(const char *path, io_clip_origin *out, uint32_t *out_flags)
{
    io_buffer buffer = {0};
    io_bytes file;
    json_t *document = NULL;
    rlf_result result = io_file_read(path, IO_JSON_FILE_MAX, "take it away", &buffer, &file);
    result = result == RLF_OK ? io_json_parse(&file, &document) : result;
    if (result == RLF_OK) {
        const io_json_object top = io_json_top(&file, document);
        result = read_facts(&top, out, out_flags);
    }
    json_decref(document);
    io_buffer_free(&buffer);
    return result;
}

/* Lines that are no note are passed over: comments, and half a line after a power cut. */
static io_frame_note *parse_notes(const io_bytes *file, int32_t *out_count)
{
    io_frame_note *notes = rlf_alloc_array(io_bytes_lines(file), sizeof(notes[0]));
    const char *at = (const char *)file->data;
    const char *end = at + file->size;
    *out_count = 0;
    while (notes != NULL && at < end) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop != NULL ? stop : end;
        char line[IO_FRAME_NOTE_TEXT];
        const size_t length = (size_t)(stop - at);
        if (length < sizeof(line)) {
            memcpy(line, at, length);
            line[length] = '\0';
            *out_count += io_frame_note_parse(line, &notes[*out_count]) ? 1 : 0;
        }
        at = stop + 1;
    }
    io_frame_notes_sort(notes, *out_count);
    return notes;
}

static rlf_result read_frames(const char *path, io_clip_origin *out, io_frame_note **out_notes)
{
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result = io_file_read(path, IO_FOLDER_FRAMES_MAX, "take it away", &buffer, &file);
    if (result == RLF_OK) {
        *out_notes = parse_notes(&file, &out->note_count);
        result = *out_notes != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    }
    io_buffer_free(&buffer);
    out->notes = *out_notes;
    out->has_notes = result == RLF_OK;
    return result;
}

rlf_result io_folder_read_origin(const char *folder, io_clip_origin *out, uint32_t *out_flags,
                                 io_frame_note **out_notes)
{
    char path[IO_PATH_MAX];
    *out_notes = NULL;
    rlf_result result = io_path_join(folder, IO_FOLDER_SOURCE, path);
    if (result != RLF_OK || access(path, F_OK) != 0) {
        return result;
    }
    result = read_source(path, out, out_flags);
    result = result == RLF_OK ? io_path_join(folder, IO_FOLDER_FRAMES, path) : result;
    return result == RLF_OK && access(path, F_OK) == 0 ? read_frames(path, out, out_notes) : result;
}
