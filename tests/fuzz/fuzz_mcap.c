/* MCAP with ROS 2 messages: any bytes give frames of the size that the source says, or an error
 * line. */
#define _POSIX_C_SOURCE 200809L
#include "fuzz.h"

#include "io/mcap/mcap.h"
#include "relief/io.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define W 8
#define H 6
#define FRAMES_MAX 100
#define SEEDS 6
#define SEED_MAX 24000

static size_t read_whole(const char *path, uint8_t *out, size_t capacity)
{
    FILE *file = fopen(path, "rb");
    const size_t size = file != NULL ? fread(out, 1, capacity, file) : 0;
    const int is_longer = file != NULL && fgetc(file) != EOF;
    if (file != NULL) {
        fclose(file);
    }
    return is_longer ? 0 : size;
}

/* 0 = not to be checked: what is changed behind it is looked at all the same. */
static void clear_crcs(uint8_t *data, size_t size)
{
    cursor c = {data + IO_MCAP_MAGIC_SIZE, size - IO_MCAP_MAGIC_SIZE, false};
    cursor record;
    for (uint8_t op; (op = io_mcap_take_record(&c, &record)) != 0;) {
        uint8_t *content = data + (record.data - data);
        if (op == IO_MCAP_CHUNK || op == IO_MCAP_FOOTER) {
            memset(content + (op == IO_MCAP_CHUNK ? 24 : 16), 0, 4);
        }
    }
}

/* A recording of two frames. */
static size_t record(int index, uint8_t *out, size_t capacity)
{
    char path[64];
    snprintf(path, sizeof(path), "fuzz-seed-%ld.mcap", (long)getpid());
    rlf_source_info info;
    memset(&info, 0, sizeof(info));
    info.rig = (rlf_rig){.depth = {.width = W, .height = H, .fx = 8, .fy = 8, .cx = 4, .cy = 3},
                         .color = {.width = W, .height = H, .fx = 8, .fy = 8, .cx = 4, .cy = 3},
                         .T_color_depth = rlf_pose_identity(),
                         .has_color = index % 2 == 0,
                         .depth_min_m = 0.1,
                         .depth_max_m = 8};
    rlf_recording_def def = rlf_recording_def_default();
    def.compression = (rlf_compression)(index % 3);
    def.jpeg_quality = index == 2 ? 90 : 0;
    def.depth_codec = index == 4 ? RLF_DEPTH_PNG : RLF_DEPTH_RVL;
    rlf_recording *recording = NULL;
    uint16_t depth[W * H];
    float metres[W * H];
    uint8_t color[W * H * 4];
    memset(color, 90, sizeof(color));
    for (int i = 0; i < W * H; i++) {
        depth[i] = (uint16_t)(i % 5 == 0 ? 0 : 1000 + i);
        metres[i] = 1.0f + (float)i;
    }
    rlf_result result = rlf_recording_open(path, &info, &def, &recording);
    for (int i = 0; i < 2 && result == RLF_OK; i++) {
        rlf_frame frame;
        memset(&frame, 0, sizeof(frame));
        frame.time_ns = i * 33000000;
        frame.depth_u16 = index == 5 ? NULL : depth;
        frame.depth_f32 = index == 5 ? metres : NULL;
        frame.depth_stride = index == 5 ? W * 4 : W * 2;
        frame.depth_units_per_metre = 1000;
        frame.color = (rlf_image_rgba8){color, W, H, W * 4};
        result = rlf_recording_add(recording, &frame);
    }
    rlf_recording_close(&recording, NULL);
    const size_t size = read_whole(path, out, capacity);
    remove(path);
    return size;
}

/* Recordings of each compression, of counts and of metres; made once, since that asks the disk. */
size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static uint8_t seeds[SEEDS][SEED_MAX];
    static size_t sizes[SEEDS];
    if (index >= SEEDS) {
        return 0;
    }
    if (sizes[index] == 0) {
        sizes[index] = record(index, seeds[index], SEED_MAX);
        if (sizes[index] > 0 && index >= SEEDS / 2) {
            clear_crcs(seeds[index], sizes[index]);
        }
    }
    const size_t size = sizes[index];
    if (size == 0 || size > capacity) {
        abort(); /* the seeds have outgrown their place */
    }
    memcpy(out, seeds[index], size);
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[64];
    snprintf(path, sizeof(path), "fuzz-%ld.mcap", (long)getpid());
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
        abort();
    }
    rlf_source *source = NULL;
    if (rlf_open_source(path, NULL, &source) == RLF_OK) {
        const rlf_rig *rig = &rlf_source_get_info(source)->rig;
        uint64_t sum = 0;
        rlf_frame frame;
        for (int i = 0; i < FRAMES_MAX && rlf_source_next(source, &frame) == RLF_OK; i++) {
            const uint8_t *depth = frame.depth_u16 != NULL ? (const uint8_t *)frame.depth_u16
                                                           : (const uint8_t *)frame.depth_f32;
            const size_t bytes = (size_t)frame.depth_stride * (size_t)rig->depth.height;
            for (size_t b = 0; b < bytes; b++) {
                sum += depth[b];
            }
        }
        (void)sum;
        rlf_source_destroy(&source);
    } else if (rlf_error_text()[0] == '\0') {
        abort();
    }
    remove(path);
    return 0;
}
