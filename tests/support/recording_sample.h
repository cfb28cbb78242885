/* A small camera, its frames, and recordings of them. Include after cmocka.h. */
#ifndef RLF_TEST_RECORDING_SAMPLE_H
#define RLF_TEST_RECORDING_SAMPLE_H

#include "test.h"
#include "relief/io.h"
#include "io_support.h"

#define SAMPLE_W 20
#define SAMPLE_H 14
#define SAMPLE_CW 24
#define SAMPLE_CH 16
#define SAMPLE_FRAME_NS 33333333

static uint16_t sample_depth[SAMPLE_W * SAMPLE_H];
static float sample_metres[SAMPLE_W * SAMPLE_H];
static uint8_t sample_color[SAMPLE_CW * SAMPLE_CH * 4];

static inline rlf_source_info sample_info(void)
{
    rlf_source_info info;
    memset(&info, 0, sizeof(info));
    strcpy(info.name, "sample");
    info.rig = (rlf_rig){.depth = {SAMPLE_W,
                                   SAMPLE_H,
                                   19.25,
                                   19.5,
                                   9.75,
                                   6.5,
                                   RLF_DISTORTION_RATIONAL_POLYNOMIAL,
                                   {0.1, -0.2, 0.001, 0.002, 0.03, 0.04, 0.05, 0.06}},
                         .color = {SAMPLE_CW,
                                   SAMPLE_CH,
                                   23.5,
                                   23.75,
                                   11.5,
                                   7.25,
                                   RLF_DISTORTION_PLUMB_BOB,
                                   {-0.01, 0.02, 0.0001, 0.0002, -0.003}},
                         .T_color_depth = {.p = {0.05, -0.001, 1.0 / 3.0}, .q = {0, 0, 0.6, 0.8}},
                         .has_color = true,
                         .depth_min_m = 0.17,
                         .depth_max_m = 5.3,
                         .noise = {0.001, 0.0002, 0.003}};
    return info;
}

/* Frame `i`; its planes are good until the next call. */
static inline rlf_frame sample_frame(const rlf_rig *rig, int32_t i, bool is_float)
{
    for (int p = 0; p < SAMPLE_W * SAMPLE_H; p++) {
        const bool is_missing = (p + i) % 9 == 0;
        sample_depth[p] = (uint16_t)(is_missing ? 0 : 1000 + 13 * i + p % 50);
        sample_metres[p] = is_missing ? 0.0f : (float)(1.0 + 0.013 * i + p / 3000.0);
    }
    for (int p = 0; p < SAMPLE_CW * SAMPLE_CH * 4; p++) {
        sample_color[p] = (uint8_t)(p % 4 == 3 ? 255 : i * 5 + p / 4);
    }
    rlf_frame f;
    memset(&f, 0, sizeof(f));
    f.sequence = (uint64_t)i;
    f.time_ns = 1700000000123456789 + (int64_t)i * SAMPLE_FRAME_NS;
    f.color_time_ns = f.time_ns + 5000000;
    f.flags = RLF_FRAME_UNMIRRORED;
    f.rig = rig;
    f.depth_u16 = is_float ? NULL : sample_depth;
    f.depth_f32 = is_float ? sample_metres : NULL;
    f.depth_stride = SAMPLE_W * (is_float ? 4 : 2);
    f.depth_units_per_metre = 4000;
    f.color = (rlf_image_rgba8){sample_color, SAMPLE_CW, SAMPLE_CH, SAMPLE_CW * 4};
    f.has_pose = true;
    f.T_world_camera = (rlf_pose){.p = {0.1 * i, 1, 2}, .q = {0, 0.6, 0, 0.8}};
    return f;
}

static inline rlf_recording_def sample_def(rlf_depth_codec codec, rlf_compression compression)
{
    rlf_recording_def def = rlf_recording_def_default();
    def.depth_codec = codec;
    def.compression = compression;
    def.jpeg_quality = 0;
    def.chunk_s = 0.099; /* three frames */
    return def;
}

static inline void sample_record(const char *path, const rlf_recording_def *def, int32_t frames,
                                 bool is_float)
{
    const rlf_source_info info = sample_info();
    rlf_recording *recording = NULL;
    if (rlf_recording_open(path, &info, def, &recording) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    for (int32_t i = 0; i < frames; i++) {
        const rlf_frame frame = sample_frame(&info.rig, i, is_float);
        assert_int_equal(rlf_recording_add(recording, &frame), RLF_OK);
    }
    rlf_recording_status status;
    assert_int_equal(rlf_recording_close(&recording, &status), RLF_OK);
    assert_null(recording);
    assert_int_equal(status.frames, frames);
    assert_true(status.bytes > 0);
}

#endif
