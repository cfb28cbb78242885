/* What a source says of itself and of its frames comes back from a recording. */
#define _POSIX_C_SOURCE 200809L

#include "recording_sample.h"
#include "test.h"

#include "io/clip/clip.h"

#define FRAMES 9
#define MS INT64_C(1000000)

/* A file and a folder. */
static const char *const names[] = {"a.mcap", "clip/"};

static const char *recorded_path(int kind)
{
    static char path[TEST_PATH_MAX];
    snprintf(path, sizeof(path), "%s", test_path(names[kind]));
    return path;
}

static rlf_source_info odd_info(void)
{
    rlf_source_info info = sample_info();
    info.frames_per_second = 90.0 / 7.0;
    info.gravity = (rlf_vec3){1.0 / 3.0, 9.6, -1.7};
    info.is_simulated = true;
    info.rig.T_color_depth.q = rlf_quat_normalize((rlf_quat){0.1, -0.7, 0.31, 0.8});
    return info;
}

/* Frames of a bad camera: numbers that jump, pictures that are far, shared, late or missing, a
 * break, and places that are not known. */
static rlf_frame odd_frame(const rlf_rig *rig, int32_t i)
{
    static const uint64_t sequences[FRAMES] = {7, 8, 11, 12, 3, 4, 5, 6, 7};
    static const int64_t colors_ms[FRAMES] = {930, 1017, 1072, 1072, 1104, 1110, 0, 1114, 1140};
    rlf_frame f = sample_frame(rig, i, false);
    f.time_ns = (1000 + 16 * i) * MS;
    f.sequence = sequences[i];
    f.flags |= i == 4 ? (uint32_t)RLF_FRAME_DISCONTINUITY : 0u;
    f.color_time_ns = colors_ms[i] * MS;
    if (i == 6) {
        f.color.data = NULL;
    }
    f.has_pose = i != 0 && i != 5;
    f.T_world_camera.q = rlf_quat_normalize((rlf_quat){0.1 * i, 0.3, -0.2, 0.9});
    return f;
}

static void record_odd(const char *path)
{
    const rlf_source_info info = odd_info();
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    rlf_recording *recording = NULL;
    assert_int_equal(rlf_recording_open(path, &info, &def, &recording), RLF_OK);
    for (int32_t i = 0; i < FRAMES; i++) {
        const rlf_frame frame = odd_frame(&info.rig, i);
        assert_int_equal(rlf_recording_add(recording, &frame), RLF_OK);
    }
    assert_int_equal(rlf_recording_close(&recording, NULL), RLF_OK);
}

TEST_CASE(what_a_source_says_comes_back)
{
    const rlf_source_info want = odd_info();
    for (int kind = 0; kind < 2; kind++) {
        rlf_source *source = NULL;
        record_odd(recorded_path(kind));
        assert_int_equal(rlf_open_source(recorded_path(kind), NULL, &source), RLF_OK);
        const rlf_source_info *got = rlf_source_get_info(source);
        assert_memory_equal(&got->gravity, &want.gravity, sizeof(want.gravity));
        assert_true(got->is_simulated);
        assert_true(got->frames_per_second == want.frames_per_second);
        assert_memory_equal(&got->rig.T_color_depth, &want.rig.T_color_depth, sizeof(rlf_pose));
        assert_memory_equal(&got->rig.depth, &want.rig.depth, sizeof(rlf_camera));
        assert_memory_equal(&got->rig.color, &want.rig.color, sizeof(rlf_camera));
        assert_memory_equal(&got->rig.noise, &want.rig.noise, sizeof(rlf_depth_noise));
        rlf_source_destroy(&source);
    }
}

TEST_CASE(what_a_frame_says_comes_back)
{
    const rlf_source_info info = odd_info();
    for (int kind = 0; kind < 2; kind++) {
        rlf_source *source = NULL;
        record_odd(recorded_path(kind));
        assert_int_equal(rlf_open_source(recorded_path(kind), NULL, &source), RLF_OK);
        for (int32_t i = 0; i < FRAMES; i++) {
            rlf_frame got;
            assert_int_equal(rlf_source_next(source, &got), RLF_OK);
            const rlf_frame want = odd_frame(&info.rig, i);
            assert_true(got.time_ns == want.time_ns);
            assert_true(got.sequence == want.sequence);
            assert_int_equal(got.flags, want.flags);
            assert_int_equal(got.has_pose, want.has_pose);
            if (want.has_pose) {
                assert_memory_equal(&got.T_world_camera, &want.T_world_camera, sizeof(rlf_pose));
            }
            assert_int_equal(got.color.data != NULL, want.color.data != NULL);
            assert_true(want.color.data == NULL || got.color_time_ns == want.color_time_ns);
        }
        rlf_source_destroy(&source);
    }
}

/* Of an earlier recording in the same folder nothing is left that a reader would take for this
 * one's. */
TEST_CASE(a_folder_forgets_what_was_recorded_there)
{
    rlf_source *source = NULL;
    rlf_frame frame;
    record_odd(recorded_path(1));
    const rlf_source_info info = sample_info();
    const rlf_recording_def def = sample_def(RLF_DEPTH_RVL, RLF_COMPRESSION_ZSTD);
    rlf_recording *recording = NULL;
    assert_int_equal(rlf_recording_open(recorded_path(1), &info, &def, &recording), RLF_OK);
    frame = odd_frame(&info.rig, 4);
    frame.has_pose = false;
    frame.flags = 0;
    assert_int_equal(rlf_recording_add(recording, &frame), RLF_OK);
    assert_int_equal(rlf_recording_close(&recording, NULL), RLF_OK);
    assert_int_equal(rlf_open_source(recorded_path(1), NULL, &source), RLF_OK);
    assert_true(rlf_length(rlf_source_get_info(source)->gravity) == 0.0);
    assert_false(rlf_source_get_info(source)->is_simulated);
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    assert_int_equal(frame.flags, 0);
    assert_false(frame.has_pose);
    rlf_source_destroy(&source);
}

TEST_CASE(texts_that_are_no_note_are_refused)
{
    static const char *const texts[] = {"", "{", "{\"stamp_ns\": 1}", "stamp_ns 1 sequence 2"};
    io_frame_note note;
    for (size_t i = 0; i < sizeof(texts) / sizeof(texts[0]); i++) {
        assert_false(io_frame_note_parse(texts[i], &note));
    }
    char text[IO_FRAME_NOTE_TEXT];
    const io_frame_note want = {INT64_MAX, UINT64_MAX, UINT32_MAX, true, INT64_MIN};
    io_frame_note_print(&want, text);
    assert_true(io_frame_note_parse(text, &note));
    assert_true(note.time_ns == want.time_ns && note.sequence == want.sequence &&
                note.flags == want.flags && note.color_time_ns == want.color_time_ns);
}

TEST_GROUP(test_folder_make, test_folder_remove)
