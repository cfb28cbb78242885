/* Rows of half the resolution, and what planes found there say to the whole one. */

#include "analytic.h"
#include "kernel/plane_window.h"
#include "test.h"

#include <math.h>

enum { LONGEST = 70, WHOLE = 2 * LONGEST };

static const rlf_kernel_noise noise = {0.001f, 0.0f, 0.0015f};

TEST_CASE(halve_row_is_its_definition)
{
    analytic_random r = {1};
    for (int32_t count = 1; count <= LONGEST; count++) {
        float rows[2][WHOLE], out[LONGEST + 1];
        for (int32_t i = 0; i < 2 * WHOLE; i++) {
            double u = random_uniform(&r);
            rows[i % 2][i / 2] = u < 0.1 ? 0.0f : u < 0.2 ? 3.0f : (float)(2.0 + 0.02 * u);
        }
        out[count] = -7.0f;
        rlf_kernel_halve_row(noise, rows[0], rows[1], count, out);
        for (int32_t i = 0; i < count; i++) {
            float low = 9.0f, high = 0.0f, sum = 0.0f;
            for (int32_t k = 0; k < 4; k++) {
                float z = rows[k / 2][2 * i + k % 2];
                low = fminf(low, z);
                high = fmaxf(high, z);
                sum += 0.25f * z;
            }
            float most = 5.0f * rlf_kernel_sigma(noise, sum) + 0.03f * sum;
            bool is_block = low > 0.0f && high - low < most;
            assert_true(fabsf(out[i] - (is_block ? sum : 0.0f)) < 1e-5f);
        }
        assert_true(out[count] == -7.0f);
    }
}

/* A row of the plane n.p = -2 with normals of its own that are `tilt` off, and the same plane at
 * half the resolution. */
typedef struct strip {
    float ray_x[WHOLE], ray_y[WHOLE], depth[WHOLE], smooth[WHOLE + 1], normal[3][WHOLE + 1];
    float frames[WHOLE]; /* 0 counts as 1 */
    float half_x[LONGEST], half_y[LONGEST], half_depth[LONGEST], plane[3][LONGEST];
} strip;

static const rlf_vec3 facing = {0.196116135, 0.0, -0.980580676};

static void set_strip(strip *s, int32_t half, rlf_vec3 own)
{
    const float n[3] = {(float)facing.x, (float)facing.y, (float)facing.z};
    const float o[3] = {(float)own.x, (float)own.y, (float)own.z};
    for (int32_t i = 0; i < 2 * half; i++) {
        s->ray_x[i] = 0.004f * (float)(i - half);
        s->ray_y[i] = 0.1f;
        s->depth[i] = (float)plane_depth(facing, -2.0, s->ray_x[i], s->ray_y[i]);
        s->smooth[i] = s->depth[i] + 0.002f;
        for (int k = 0; k < 3; k++) {
            s->normal[k][i] = o[k];
        }
    }
    for (int32_t i = 0; i < half; i++) {
        s->half_x[i] = 0.5f * (s->ray_x[2 * i] + s->ray_x[2 * i + 1]);
        s->half_y[i] = 0.1f;
        s->half_depth[i] = (float)plane_depth(facing, -2.0, s->half_x[i], s->half_y[i]);
        for (int k = 0; k < 3; k++) {
            s->plane[k][i] = n[k];
        }
    }
    rlf_kernel_invert_planes(s->half_depth, s->half_x, s->half_y, half, s->plane[0], s->plane[1],
                             s->plane[2]);
    s->smooth[2 * half] = s->normal[0][2 * half] = -7.0f;
}

static void speak(strip *s, int32_t half, float lasting)
{
    const rlf_kernel_wide in = {.depth = s->depth,
                                .ray_x = s->ray_x,
                                .ray_y = s->ray_y,
                                .half_width = half,
                                .plane = {s->plane[0], s->plane[1], s->plane[2]},
                                .beside = {s->plane[0], s->plane[1], s->plane[2]},
                                .half_ray_x = s->half_x,
                                .half_ray_y = s->half_y,
                                .frames = s->frames,
                                .half_frames = s->frames,
                                .noise = noise,
                                .lasting = lasting,
                                .tilt = 10.0f};
    float *const normal[3] = {s->normal[0], s->normal[1], s->normal[2]};
    rlf_kernel_wide_row(&in, normal, s->smooth);
}

/* Noise of 7 mm at 2 m makes 2 degrees: a normal that is 4 off takes the plane, one that is 30 off
 * has seen something else. */
TEST_CASE(a_plane_speaks_for_what_noise_explains)
{
    static strip s;
    const double turned[2] = {4.0, 30.0};
    for (int32_t half = 1; half <= LONGEST; half++) {
        for (int k = 0; k < 2; k++) {
            double angle = turned[k] * RLF_PI / 180.0 + rlf_atan2(0.2, 1.0);
            rlf_vec3 own = rlf_vec3_make(rlf_sin(angle), 0.0, -rlf_cos(angle));
            set_strip(&s, half, own);
            speak(&s, half, 0.0f);
            for (int32_t i = 0; i < 2 * half; i++) {
                rlf_vec3 n = rlf_vec3_make(s.normal[0][i], s.normal[1][i], s.normal[2][i]);
                assert_true(angle_deg(n, k == 0 ? facing : own) < 0.01);
                assert_true(fabsf(s.smooth[i] - s.depth[i] - (k == 0 ? 0.0f : 0.002f)) < 1e-5f);
            }
            assert_true(s.smooth[2 * half] == -7.0f && s.normal[0][2 * half] == -7.0f);
        }
    }
}

/* A mean of 25 frames makes 0.4 degrees of them, unless the noise lasts. */
TEST_CASE(what_averaging_leaves_decides)
{
    static strip s;
    const double angle = 4.0 * RLF_PI / 180.0 + rlf_atan2(0.2, 1.0);
    const rlf_vec3 own = rlf_vec3_make(rlf_sin(angle), 0.0, -rlf_cos(angle));
    for (int lasts = 0; lasts < 2; lasts++) {
        set_strip(&s, 40, own);
        for (int32_t i = 0; i < 80; i++) {
            s.frames[i] = i % 2 != 0 ? -25.0f : 25.0f; /* recalled ones are negative */
            s.smooth[i] = s.depth[i];
        }
        speak(&s, 40, lasts != 0 ? 1.0f : 0.0f);
        for (int32_t i = 0; i < 80; i++) {
            rlf_vec3 n = rlf_vec3_make(s.normal[0][i], s.normal[1][i], s.normal[2][i]);
            assert_true(angle_deg(n, lasts != 0 ? facing : own) < 0.01);
        }
    }
}

TEST_CASE(halve_frames_takes_the_fewest)
{
    const float upper[6] = {3.0f, 4.0f, 9.0f, -2.0f, 7.0f, 7.0f};
    const float lower[6] = {8.0f, 5.0f, 9.0f, 9.0f, 0.0f, 7.0f};
    float out[4] = {0.0f, 0.0f, 0.0f, -7.0f};
    rlf_kernel_halve_frames(upper, lower, 3, out);
    const float wanted[4] = {3.0f, 2.0f, 0.0f, -7.0f};
    assert_memory_equal(out, wanted, sizeof wanted);
}

TEST_CASE(where_there_is_no_plane_nothing_changes)
{
    static strip s;
    set_strip(&s, 40, rlf_vec3_make(0.0, 0.0, -1.0));
    memset(s.plane, 0, sizeof s.plane);
    speak(&s, 40, 0.0f);
    for (int32_t i = 0; i < 80; i++) {
        assert_true(s.normal[2][i] == -1.0f && fabsf(s.smooth[i] - s.depth[i]) > 0.001f);
    }
}
