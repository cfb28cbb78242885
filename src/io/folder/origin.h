/* What a folder that Relief has recorded says beside its pictures: source.json and frames.txt. */
#ifndef RLF_IO_FOLDER_ORIGIN_H
#define RLF_IO_FOLDER_ORIGIN_H

#include "io/clip/clip.h"

#define IO_FOLDER_SOURCE "source.json"
#define IO_FOLDER_FRAMES "frames.txt"
#define IO_FOLDER_POSES "groundtruth.txt"
#define IO_FOLDER_FRAMES_MAX ((size_t)256 << 20)

/* Writes source.json. `flags`: of every frame. */
rlf_result io_folder_write_origin(const char *folder, const rlf_source_info *info, uint32_t flags);
/* Reads both; a folder without source.json says nothing, and *out stays as it is. The notes are
 * *out_notes, a new array that *out borrows. */
rlf_result io_folder_read_origin(const char *folder, io_clip_origin *out, uint32_t *out_flags,
                                 io_frame_note **out_notes);

#endif
