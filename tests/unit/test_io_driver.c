/* What the live back ends share. */
#include "io/live/driver.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct table {
    double (*cosine)(double);
    void *none;
} table;

static bool load(const char *library, const char *first, const char *second, bool is_optional,
                 table *t, char reason[160])
{
    const char *const names[] = {"libno-such-thing.so.1", library, NULL};
    const io_symbol symbols[] = {{first, offsetof(table, cosine), false},
                                 {second, offsetof(table, none), is_optional}};
    io_library l = {.variable = "RELIEF_TEST_NO_SUCH_VARIABLE",
                    .names = names,
                    .cure = "install it",
                    .symbols = symbols,
                    .symbol_count = 2,
                    .table = t};
    const char *problem = io_library_fault(&l);
    snprintf(reason, 160, "%s", problem != NULL ? problem : "");
    return problem == NULL;
}

TEST_CASE(loads_libraries)
{
    table t = {0};
    char reason[160];
    assert_true(load("libm.so.6", "cos", "no_such_function", true, &t, reason));
    assert_true(t.cosine(0.0) == 1.0);
    assert_null(t.none);
    assert_string_equal(reason, "");
    assert_false(load("libm.so.6", "cos", "no_such_function", false, &t, reason));
    assert_string_equal(reason, "libm.so.6 has no function no_such_function: install it");
    assert_false(load("libno-such-thing.so", "cos", "cos", false, &t, reason));
    assert_string_equal(reason, "libno-such-thing.so is not installed: install it");
}

/* dlopen would map it and end the program. */
TEST_CASE(a_library_cut_short_is_refused)
{
    static char part[8192];
    table t = {0};
    char reason[160];
    FILE *self = fopen("/proc/self/exe", "rb");
    FILE *file = fopen("./cut-driver.so", "wb");
    assert_true(self != NULL && file != NULL);
    assert_int_equal(fread(part, 1, sizeof(part), self), sizeof(part));
    assert_int_equal(fwrite(part, 1, sizeof(part), file), sizeof(part));
    fclose(self);
    fclose(file);
    assert_false(load("./cut-driver.so", "cos", "cos", false, &t, reason));
    assert_non_null(strstr(reason, "it is cut short"));
    remove("./cut-driver.so");
}

TEST_CASE(counts_frames)
{
    io_live_count c = {.interval_ns = 33};
    const uint64_t numbers[] = {7, 8, 8, 11, 2, 3};
    const int64_t times[] = {100, 133, 133, 232, 50, 83};
    const uint64_t sequences[] = {0, 1, 1, 4, 5, 6};
    const int64_t told[] = {100, 133, 0, 232, 265, 298};
    for (int i = 0; i < 6; i++) {
        rlf_frame f = {0};
        assert_int_equal(io_live_count_frame(&c, numbers[i], times[i], &f), i != 2);
        if (i != 2) {
            assert_int_equal(f.sequence, sequences[i]);
            assert_int_equal(f.time_ns, told[i]);
            assert_int_equal(f.flags, i == 4 ? RLF_FRAME_DISCONTINUITY : 0);
        }
    }
    assert_int_equal(c.lost, 2);
    assert_int_equal(c.doubled, 1);
    io_live_count t = {.interval_ns = 33};
    const int64_t at[] = {100, 134, 234, 234, 100, 133};
    const uint64_t wanted[] = {0, 1, 4, 4, 5, 6};
    for (int i = 0; i < 6; i++) {
        rlf_frame f = {0};
        assert_int_equal(io_live_count_time(&t, at[i], &f), i != 3);
        assert_true(i == 3 || f.sequence == wanted[i]);
    }
    assert_int_equal(t.lost, 2);
    assert_int_equal(t.doubled, 1);
}

TEST_CASE(reads_modes)
{
    const char *const good[] = {"640x480", "640x480@30", "16384x1@9999"};
    const char *const bad[] = {"",         "640",        "x480",    "640x480@",     "640x480@0",
                               "-1x480",   "640x-1",     "16385x1", "640x480@30x",  "640 x480",
                               "640x480 ", "640x480@-3", "0x0",     "99999999999x2"};
    io_mode mode = {1, 2, 3};
    rlf_address address = {.source = "s:", .key_count = 1, .keys = {"mode"}};
    for (size_t i = 0; i < sizeof(good) / sizeof(good[0]); i++) {
        address.values[0] = good[i];
        assert_int_equal(io_mode_get(&address, "mode", &mode), RLF_OK);
    }
    assert_int_equal(mode.width, 16384);
    assert_int_equal(mode.frames_per_second, 9999);
    for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); i++) {
        address.values[0] = bad[i];
        assert_int_equal(io_mode_get(&address, "mode", &mode), RLF_ERROR_INVALID);
    }
    assert_int_equal(io_mode_get(&address, "color", &mode), RLF_OK);
    assert_int_equal(mode.width, 16384); /* left alone */
}

TEST_CASE(checks_transforms)
{
    const float turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    const float mirror[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    const float zero[9] = {0};
    const float t[3] = {10, 20, 30};
    const float far[3] = {NAN, 0, 0};
    rlf_pose pose;
    assert_true(io_live_pose(turn, t, 0.001, &pose));
    const rlf_vec3 p = rlf_transform(&pose, rlf_vec3_make(1, 0, 0));
    assert_true(fabs(p.x - 0.01) < 1e-12 && fabs(p.y - 1.02) < 1e-12 && fabs(p.z - 0.03) < 1e-12);
    assert_false(io_live_pose(mirror, t, 1.0, &pose));
    assert_false(io_live_pose(zero, t, 1.0, &pose));
    assert_false(io_live_pose(turn, far, 1.0, &pose));
}

/* A plumb_bob lens is found again exactly; one that no sample determines is refused. */
TEST_CASE(fits_lenses)
{
    const rlf_camera lens = {.width = 640,
                             .height = 480,
                             .fx = 500,
                             .fy = 510,
                             .cx = 318,
                             .cy = 243,
                             .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                             .distortion = {-0.1, 0.05, 0.001, -0.002, -0.01}};
    io_lens_sample samples[100];
    for (int i = 0; i < 100; i++) {
        io_lens_sample *s = &samples[i];
        s->x = (i % 10 - 4.5) * 0.12;
        s->y = (i / 10 - 4.5) * 0.1;
        assert_true(rlf_camera_project(&lens, rlf_vec3_make(s->x, s->y, 1.0), &s->u, &s->v));
    }
    rlf_camera fitted = lens;
    memset(fitted.distortion, 0, sizeof(fitted.distortion));
    assert_true(io_lens_fit(samples, 100, &fitted) < 1e-6);
    for (int i = 0; i < 8; i++) {
        assert_true(fabs(fitted.distortion[i] - lens.distortion[i]) < 1e-7);
    }
    assert_true(isinf(io_lens_fit(samples, 1, &fitted)));
    assert_int_equal(fitted.distortion_model, RLF_DISTORTION_NONE);
}
