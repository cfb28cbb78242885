/* Recording beside a running loop: frames are copied to a queue, and a thread of its own encodes
 * and writes them. */
#ifndef RELIEF_APP_RECORDER_H
#define RELIEF_APP_RECORDER_H

#include "options.h"
#include "relief/io.h"

#include <stdio.h>

typedef struct recorder_options {
    const char *path; /* NULL = nothing is recorded */
    rlf_recording_def def;
    bool keeps_bodies;
    /* A failure is logged when it happens, and the loop goes on without it; of a camera also those
     * frames are recorded that the loop is too slow for. */
    bool is_beside_loop;
    bool is_switched; /* it may begin later, by recorder_toggle */
} recorder_options;

typedef struct recorder_status {
    rlf_recording_status written;
    uint64_t dropped; /* frames of a live source that found the queue full */
    double cpu_s;     /* of the writing thread */
    bool is_told;     /* that it failed */
} recorder_status;

typedef struct recorder recorder;

recorder_options recorder_options_default(void);

/* Rows of an option table that set the codec, the quality and the compression. */
#define RECORDER_OPTIONS(options)                                                                  \
    ROW_CHOICE("codec", (options), recorder_take_codec, "use rvl or png"),                         \
        ROW_INT32("jpeg-quality", &(options)->def.jpeg_quality, 1, 100),                           \
        ROW_CHOICE("lossless", (options), recorder_take_color, "use color"),                       \
        ROW_CHOICE("compression", (options), recorder_take_compression, "use zstd, lz4 or none")

/* "FILE.mcap", "FOLDER/" or "ros2:/CAMERA". `choices` of an option that takes one. */
#define RECORDER_PATH "end the name in .mcap, or in / for a folder, or give ros2:/CAMERA"
bool recorder_take_path(const char *text, void *out);
bool recorder_take_codec(const char *text, void *out);
bool recorder_take_color(const char *text, void *out);
bool recorder_take_compression(const char *text, void *out);

/* Begins the file and starts the thread; without a path nothing is recorded until
 * recorder_toggle. */
rlf_result recorder_create(const recorder_options *options, const rlf_source_info *info,
                           recorder **out);
/* Puts in place of *source one that gives the same frames and records them; it owns the other.
 * Frames of a file wait for room in the queue; those of a camera are dropped and counted. */
rlf_result recorder_tap(recorder *recorder, rlf_source **source);
/* Bodies after the frame of that time, when the options say so. */
void recorder_add_bodies(recorder *recorder, int64_t time_ns, const rlf_snapshot *snapshot);
/* Whether writing has failed, which was told; recorder_destroy has the line again. */
bool recorder_has_failed(recorder *recorder);
recorder_status recorder_get_status(recorder *recorder);
/* Ends the recording, or begins one with a name of its own here; says which. */
rlf_result recorder_toggle(recorder *recorder, char *out_message, size_t message_size);
/* The same without waiting for what is still to be written: recorder_settle, once a frame, finishes
 * the file when it is. A NULL recorder is an error. */
rlf_result recorder_switch(recorder *recorder, bool is_on);
void recorder_settle(recorder *recorder);
/* What is being recorded, for the screen; false when nothing is. */
bool recorder_describe(recorder *recorder, char *out, size_t size);
/* Waits until all is written and finishes the file. The pointer is nulled even when that fails. */
rlf_result recorder_destroy(recorder **recorder, recorder_status *out);
/* One line for people; nothing when nothing was recorded. */
void recorder_print_summary(FILE *file, const recorder_options *options,
                            const recorder_status *status);

#endif
