/* Recording: two seconds of a source go into a file that ROS 2 and Foxglove read, too; played back
 * it gives the same depth, to the bit. usage: record_and_replay [SOURCE] */
#include "relief/io.h"

#include <stdio.h>
#include <string.h>

#define FRAMES 60
#define FOLDER "recording/"

/* A number that changes with any pixel of any frame. */
static uint64_t add_depth(uint64_t hash, const rlf_frame *frame)
{
    for (int32_t y = 0; y < frame->rig->depth.height; y++) {
        const uint16_t *row = (const uint16_t *)(const void *)((const char *)frame->depth_u16 +
                                                               y * frame->depth_stride);
        for (int32_t x = 0; x < frame->rig->depth.width; x++) {
            hash = (hash ^ row[x]) * UINT64_C(1099511628211); /* FNV-1a */
        }
    }
    return hash;
}

static rlf_result record(const char *name, uint64_t *out_hash)
{
    rlf_source *source = NULL;
    rlf_recording *recording = NULL;
    rlf_recording_def def = rlf_recording_def_default();
    rlf_result result = rlf_open_source(name, NULL, &source);
    if (result == RLF_OK) {
        result = rlf_recording_open(FOLDER, rlf_source_get_info(source), &def, &recording);
    }
    for (int i = 0; i < FRAMES && result == RLF_OK; i++) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            *out_hash = add_depth(*out_hash, &frame);
            result = rlf_recording_add(recording, &frame);
        }
    }
    const rlf_result closed = rlf_recording_close(&recording, NULL);
    rlf_source_destroy(&source);
    return result == RLF_OK ? closed : result;
}

static rlf_result replay(uint64_t *out_hash, int *out_count)
{
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(FOLDER, NULL, &source);
    while (result == RLF_OK) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            *out_hash = add_depth(*out_hash, &frame);
            (*out_count)++;
        }
    }
    rlf_source_destroy(&source);
    return result == RLF_END ? RLF_OK : result;
}

int main(int argc, char **argv)
{
    uint64_t written = 0, read = 0;
    int count = 0;
    rlf_result result = record(argc > 1 ? argv[1] : "synthetic:room", &written);
    if (result == RLF_OK) {
        result = replay(&read, &count);
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
        return 1;
    }
    printf("%d frames came back, %s\n", count, read == written ? "alike to the bit" : "changed");
    return read == written && count == FRAMES ? 0 : 1;
}
