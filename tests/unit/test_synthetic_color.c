/* The colour camera's picture where the room covers a mover. */

#include "created.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define WIDTH 960
#define HEIGHT 540
#define SIDE 4 /* pixels on either side of an edge that show one thing each */

static float z[WIDTH * HEIGHT];
static int32_t label[WIDTH * HEIGHT];

static void cast_all(rlf_source *source, const rlf_rig *rig)
{
    const rlf_vec3 origin = rlf_neg(rig->T_color_depth.p);
    for (int32_t y = 0; y < HEIGHT; y++) {
        rlf_vec3 rays[WIDTH];
        for (int32_t x = 0; x < WIDTH; x++) {
            rays[x] = rlf_vec3_make((x - rig->color.cx) / rig->color.fx,
                                    (y - rig->color.cy) / rig->color.fy, 1.0);
        }
        assert_int_equal(
            rlf_synthetic_cast(source, origin, rays, WIDTH, z + y * WIDTH, label + y * WIDTH),
            RLF_OK);
    }
}

/* The person is seen in the SIDE pixels that end at `i`, and in those beyond, one thing well before
 * them; the same in the rows above and below. */
static bool is_covered(int32_t i, int32_t direction)
{
    const int32_t thing = label[i + direction];
    bool is_it = thing != RLF_SYNTHETIC_LABEL_PERSON && thing != RLF_SYNTHETIC_LABEL_FLOOR;
    for (int32_t row = -1; row <= 1 && is_it; row++) {
        for (int32_t k = 0; k < SIDE && is_it; k++) {
            const int32_t person = i + row * WIDTH - k * direction;
            const int32_t other = i + row * WIDTH + (k + 1) * direction;
            is_it = label[person] == RLF_SYNTHETIC_LABEL_PERSON && label[other] == thing &&
                    z[other] + 0.1f < z[person];
        }
    }
    return is_it;
}

/* Distance of a colour from the mixtures of two, sRGB steps. */
static double off_mixture(const uint8_t *c, const uint8_t *a, const uint8_t *b)
{
    double along = 0.0, length = 0.0, off = 0.0;
    for (int k = 0; k < 3; k++) {
        along += (c[k] - a[k]) * (double)(b[k] - a[k]);
        length += (b[k] - a[k]) * (double)(b[k] - a[k]);
    }
    double t = length > 0.0 ? rlf_clamp(along / length, 0.0, 1.0) : 0.0;
    for (int k = 0; k < 3; k++) {
        double step = c[k] - (a[k] + t * (b[k] - a[k]));
        off += step * step;
    }
    return sqrt(off);
}

/* What lies behind both, the wall, has no part in the edge between a leg and what covers it. */
TEST_CASE(a_covered_outline_is_a_mixture_of_both_sides)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_source *source;
    rlf_frame frame;
    double sum = 0.0;
    int32_t count = 0;
    def.enable_truth = false;
    source = synthetic_of(&def);
    for (int32_t n = 0; n < 120; n++) {
        frame = frame_of(source);
        if (n % 20 != 0) {
            continue;
        }
        cast_all(source, &rlf_source_get_info(source)->rig);
        for (int32_t i = WIDTH + SIDE; i < WIDTH * (HEIGHT - 1) - SIDE; i++) {
            for (int32_t direction = -1; direction <= 1; direction += 2) {
                if (!is_covered(i, direction)) {
                    continue;
                }
                const uint8_t *c = frame.color.data + 4 * (ptrdiff_t)i;
                const ptrdiff_t step = 4 * (ptrdiff_t)direction;
                for (int32_t k = 0; k < 2; k++) {
                    sum += off_mixture(c + k * step, c - (SIDE - 1) * step, c + SIDE * step);
                    count++;
                }
            }
        }
    }
    assert_true(count > 200);
    assert_true(sum / count < 10.0); /* 19 with the wall in between; patterns are the rest */
    rlf_source_destroy(&source);
}

/* A room that opens soon is another picture at first, sharper from above with every frame, and the
 * same from the frame on that has sharpened the last band; its depth is the same throughout. */
TEST_CASE(a_room_that_opens_soon_becomes_the_same)
{
    enum { W = 96, H = 54, BAND = 16 };
    rlf_synthetic_def def = rlf_synthetic_def_default();
    rlf_source *sources[2];
    def.enable_truth = false;
    def.color_width = W;
    def.color_height = H;
    def.scene = RLF_SYNTHETIC_CHAIR; /* two states of the room */
    for (int k = 0; k < 2; k++) {
        def.opens_soon = k == 1;
        sources[k] = synthetic_of(&def);
    }
    for (int32_t n = 0; n < 130; n++) { /* the chair goes at 120 */
        rlf_frame frames[2];
        for (int k = 0; k < 2; k++) {
            assert_int_equal(rlf_source_next(sources[k], &frames[k]), RLF_OK);
        }
        const uint8_t *a = frames[0].color.data, *b = frames[1].color.data;
        assert_memory_equal(frames[0].depth_u16, frames[1].depth_u16,
                            (size_t)rlf_source_get_info(sources[0])->rig.depth.width * 2);
        const int32_t right = n * BAND < H ? n * BAND : H;
        assert_memory_equal(a, b, (size_t)(4 * W * right));
        assert_int_equal(memcmp(a, b, (size_t)(4 * W * H)) != 0, right < H);
    }
    for (int k = 0; k < 2; k++) {
        rlf_source_destroy(&sources[k]);
    }
}
