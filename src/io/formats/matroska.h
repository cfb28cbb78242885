/* Matroska recordings of Azure Kinect and Femto cameras. */
#ifndef RLF_IO_FORMATS_MATROSKA_H
#define RLF_IO_FORMATS_MATROSKA_H

#include "io/clip/clip.h"
#include "relief/base.h"
#include "relief/frame.h"

/* ---- Matroska: tracks with their pictures, tags, one attached file ---- */

#define MKV_TRACKS_MAX 16
#define MKV_TAGS_MAX 64

typedef struct mkv_track {
    uint64_t number;
    char name[32];  /* "COLOR", "DEPTH", "IR" in recordings of k4arecorder */
    char codec[32]; /* "V_MJPEG", "V_MS/VFW/FOURCC", "V_UNCOMPRESSED" */
    char fourcc[5]; /* of the latter two */
    int64_t width, height;
    io_shots pictures; /* as they come */
} mkv_track;

typedef struct mkv_tag {
    char name[40], value[64];
} mkv_tag;

typedef struct mkv_file {
    io_file file;
    mkv_track tracks[MKV_TRACKS_MAX];
    int32_t track_count;
    mkv_tag tags[MKV_TAGS_MAX];
    int32_t tag_count;
    char attached_name[64]; /* of the attached JSON file; "" = none */
    int64_t attached_position, attached_size;
} mkv_file;

/* Looks through the whole file once, over the pictures. What follows a damaged place is left out,
 * with a warning. On failure nothing stays open. */
rlf_result mkv_file_open(const char *path, mkv_file *out);
void mkv_file_close(mkv_file *self);

/* Value of a tag; NULL when there is none. */
const char *mkv_file_tag(const mkv_file *self, const char *name);

/* The calibration that an Azure Kinect or a Femto camera holds, as k4arecorder attaches it. */

/* Fills cameras and transform for pictures of rig->depth.width x height and, when has_color,
 * rig->color.width x height, which are given. The file is normalised to the whole sensors; a mode
 * bins it and cuts a window out, which the size tells. */
rlf_result k4a_calibration_read(const io_bytes *file, rlf_rig *rig);

#endif
