/* The synthetic sensor's noise: statistics against the published model and table 5.1. */

#include "sim/hash.h"
#include "sim/noise.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define WIDTH 512
#define HEIGHT 424
#define PIXELS (WIDTH * HEIGHT)

TEST_CASE(the_normal_numbers_are_normal)
{
    double sum = 0.0;
    double sum2 = 0.0;
    int beyond = 0;
    const int count = 400000;
    for (int i = 0; i < count; i++) {
        double x = synth_normal(synth_hash((uint32_t)i * 0x9e3779b9u));
        sum += x;
        sum2 += x * x;
        beyond += fabs(x) > 2.0;
    }
    assert_float_equal(sum / count, 0.0, 0.005);
    assert_float_equal(sum2 / count, 1.0, 0.005);
    assert_float_equal((double)beyond / count, 0.0455, 0.006);
}

/* Fankhauser et al. 2015, with the C library's functions. */
static double model_mm(double z, double cosine)
{
    double theta = acos(cosine);
    double ratio = theta / (0.5 * RLF_PI - theta);
    return 1.5 - 0.5 * z + 0.3 * z * z + 0.1 * pow(z, 1.5) * ratio * ratio;
}

TEST_CASE(sigma_follows_the_model)
{
    static synth_noise noise;
    synth_noise_init(&noise, 1);
    for (double z = 0.5; z <= 4.5; z += 0.25) {
        for (double angle = 0.0; angle < 75.0; angle += 2.5) {
            double cosine = cos(angle * RLF_PI / 180.0);
            double wanted = model_mm(z, cosine);
            double sigma = synth_noise_sigma(&noise, (float)z, (float)cosine);
            assert_float_equal(sigma, wanted, 0.01 * wanted);
        }
    }
}

/* Standard deviation over time on the wall, pixel by pixel, against the model plus rounding. */
TEST_CASE(wall_noise_is_within_ten_percent)
{
    enum { FRAMES = 80 };
    rlf_source *source = synthetic_named("synthetic:empty?color=0&frames=80", NULL);
    static double sum[PIXELS];
    static double sum2[PIXELS];
    static int32_t count[PIXELS];
    rlf_frame frame;
    while (rlf_source_next(source, &frame) == RLF_OK) {
        const rlf_truth *truth = rlf_source_get_truth(source);
        for (int i = 0; i < PIXELS; i++) {
            double error = frame.depth_u16[i] - 1000.0 * truth->depth[i];
            sum[i] += error;
            sum2[i] += error * error;
            count[i] += frame.depth_u16[i] != 0;
        }
    }
    const rlf_truth *truth = rlf_source_get_truth(source);
    double bias = 0.0;
    double ratio = 0.0;
    int pixels = 0;
    for (int v = 70; v < 220; v++) {
        for (int u = 150; u < 320; u++) {
            int i = v * WIDTH + u;
            if (truth->label[i] != RLF_SYNTHETIC_LABEL_WALL || count[i] != FRAMES) {
                continue;
            }
            double x = (u - 255.5) / 365.5;
            double y = (v - 211.5) / 365.5;
            double model = model_mm(truth->depth[i], 1.0 / sqrt(1.0 + x * x + y * y));
            double mean = sum[i] / FRAMES;
            double variance = (sum2[i] - FRAMES * mean * mean) / (FRAMES - 1);
            bias += mean;
            ratio += variance / (model * model + 1.0 / 12.0);
            pixels++;
        }
    }
    rlf_source_destroy(&source);
    assert_true(pixels > 10000);
    assert_float_equal(bias / pixels, 0.0, 0.1);
    assert_float_equal(sqrt(ratio / pixels), 1.0, 0.1);
}

/* Missing points among the pixels (8 i, 8 j). */
typedef struct missing {
    double full, centre;
    int frames;
} missing;

/* Without the driver's filter silhouettes keep their pixels, and some of them fly. */
TEST_CASE(the_edge_filter_can_be_left_out)
{
    rlf_source *source = synthetic_named("synthetic:empty?color=0&edge_filter=0&frames=1", NULL);
    rlf_source *filtered = synthetic_named("synthetic:empty?color=0&frames=1", NULL);
    rlf_frame frame;
    rlf_frame other;
    frame = frame_of(source);
    other = frame_of(filtered);
    const rlf_truth *truth = rlf_source_get_truth(source);
    int flying = 0;
    int removed = 0;
    for (int y = 1; y < HEIGHT - 1; y++) {
        for (int x = 1; x < WIDTH - 1; x++) {
            int i = y * WIDTH + x;
            bool is_there = frame.depth_u16[i] != 0;
            flying += is_there && fabs(frame.depth_u16[i] - 1000.0 * truth->depth[i]) > 100.0;
            removed += is_there && other.depth_u16[i] == 0;
        }
    }
    assert_true(flying > 200);
    assert_true(removed > 1000);
    for (int x = 0; x < WIDTH; x++) {
        assert_int_equal(frame.depth_u16[x], 0);
        assert_int_equal(frame.depth_u16[(HEIGHT - 1) * WIDTH + x], 0);
    }
    rlf_source_destroy(&source);
    rlf_source_destroy(&filtered);
}

/* Depth comes in steps of 1/8 pixel of disparity, z^2 / 348 m, and errs alike in neighbours. */
TEST_CASE(structured_light_measures_in_steps)
{
    rlf_source *source = synthetic_named("synthetic:empty?color=0&noise=steps&frames=1", NULL);
    rlf_frame frame = frame_of(source);
    const rlf_truth *truth = rlf_source_get_truth(source);
    double bias = 0.0, square = 0.0, product = 0.0;
    int count = 0;
    for (int v = 70; v < 220; v++) {
        for (int u = 150; u < 320; u++) {
            int i = v * WIDTH + u;
            if (truth->label[i] != RLF_SYNTHETIC_LABEL_WALL || frame.depth_u16[i] == 0 ||
                frame.depth_u16[i + 1] == 0) {
                continue;
            }
            double steps = 348000.0 / frame.depth_u16[i];
            assert_float_equal(steps, floor(steps + 0.5), 0.02);
            double error = frame.depth_u16[i] - 1000.0 * truth->depth[i];
            bias += error;
            square += error * error;
            product += error * (frame.depth_u16[i + 1] - 1000.0 * truth->depth[i + 1]);
            count++;
        }
    }
    rlf_source_destroy(&source);
    assert_less(10000, count);
    assert_float_equal(bias / count, 0.0, 2.0);
    double sigma = sqrt(square / count);
    assert_true(sigma > 12.0 && sigma < 22.0); /* a Kinect v1 at 3.5 to 4.5 m: 16 to 18 */
    assert_less(0.6 * square, product);
}
