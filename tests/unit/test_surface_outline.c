/* Filled pixels at the outline of things: their side and their normals. */

#include "seen_view.h"
#include "test.h"

#include <math.h>

enum { WIDTH = 192, HEIGHT = 120, COUNT = WIDTH * HEIGHT };

static rlf_vec3 normals[COUNT]; /* the true ones */

static int set_up(void **state)
{
    static seen_view view;
    seen_view_create(&view, analytic_rig(WIDTH, HEIGHT), 3);
    *state = &view;
    return 0;
}

static void set_wall(seen_view *f, int i)
{
    f->truth[i] = 3.0f;
    normals[i] = rlf_vec3_make(0, 0, -1);
}

static void set_ball(seen_view *f, rlf_vec3 centre, double radius)
{
    for (int i = 0; i < COUNT; i++) {
        double z = sphere_depth(centre, radius, f->ray_x[i], f->ray_y[i]);
        set_wall(f, i);
        if (z > 0.0) {
            rlf_vec3 p = {z * f->ray_x[i], z * f->ray_y[i], z};
            f->truth[i] = (float)z;
            normals[i] = rlf_normalize(rlf_sub(p, centre));
        }
    }
}

static void set_board(seen_view *f, rlf_vec3 n)
{
    for (int i = 0; i < COUNT; i++) {
        int32_t x = i % WIDTH, y = i / WIDTH;
        set_wall(f, i);
        if (x >= 60 && x < 130 && y >= 20 && y < 90 + (x - 60) / 5) {
            f->truth[i] = (float)plane_depth(n, 2.0 * n.z, f->ray_x[i], f->ray_y[i]);
            normals[i] = n;
        }
    }
}

/* As a driver's edge filter does: none of the pixels beside an edge, some of those next to them. */
static bool is_dropped(seen_view *f, int32_t x, int32_t y)
{
    double kept = 1.0;
    for (int32_t ny = y - 1; ny <= y + 1; ny++) {
        for (int32_t nx = x - 1; nx <= x + 1; nx++) {
            if (nx < 1 || ny < 1 || nx > WIDTH - 2 || ny > HEIGHT - 2) {
                continue;
            }
            const float *z = &f->truth[ny * WIDTH + nx];
            double step = fmax(fmax(fabs(z[-1] - z[0]), fabs(z[1] - z[0])),
                               fmax(fabs(z[-WIDTH] - z[0]), fabs(z[WIDTH] - z[0])));
            bool here = nx == x && ny == y;
            kept *= step > 0.1 ? (here ? 0.0 : 0.74) : 1.0;
        }
    }
    return random_uniform(&f->random) >= kept;
}

static const rlf_surface *process(seen_view *f, rlf_reconstruct *stage, int32_t number)
{
    for (int i = 0; i < COUNT; i++) {
        float noisy = seen_view_noisy(f, f->truth[i]);
        f->seen[i] = is_dropped(f, i % WIDTH, i / WIDTH) ? 0.0f : noisy;
    }
    return seen_view_process(f, stage, number);
}

/* Of the thing's dropped pixels: filled on its side, with a normal within 30 degrees. */
typedef struct score {
    int dropped, wrong_side, wrong_normal, filled;
    double mean_deg;
} score;

static score judge(seen_view *f)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    rlf_reconstruct *stage = stage_of(&def);
    const rlf_surface *s = process(f, stage, 0);
    score result = {0};
    for (int i = 0; i < COUNT; i++) {
        if (f->seen[i] > 0.0f || f->truth[i] > 2.9f) {
            continue;
        }
        result.dropped++;
        result.wrong_side += fabs(s->depth[i] - f->truth[i]) > 0.4 * (3.0 - f->truth[i]);
        if (fabs(s->depth[i] - f->truth[i]) <= 0.4 * (3.0 - f->truth[i])) {
            rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
            assert_true(fabs(rlf_length(n) - 1.0) < 1e-5);
            assert_true(n.x * f->ray_x[i] + n.y * f->ray_y[i] + n.z < 0.0);
            double deg = angle_deg(n, normals[i]);
            result.filled++;
            result.wrong_normal += deg > 30.0;
            result.mean_deg += deg;
        }
    }
    result.mean_deg /= result.filled;
    rlf_reconstruct_destroy(&stage);
    return result;
}

TEST_CASE(a_ball_turns_away_at_its_outline)
{
    seen_view *f = *state;
    set_ball(f, rlf_vec3_make(0.1, -0.05, 2.0), 0.3);
    score s = judge(f);
    assert_true(s.dropped > 100);
    assert_true(10 * s.wrong_side < s.dropped);
    assert_true(20 * s.wrong_normal < s.filled);
    assert_true(s.mean_deg < 8.0);
}

TEST_CASE(a_board_stays_flat)
{
    seen_view *f = *state;
    const rlf_vec3 tilts[3] = {{0, 0, -1}, {0.5, 0, -1}, {-0.2, 0.6, -1}};
    for (int k = 0; k < 3; k++) {
        set_board(f, rlf_normalize(tilts[k]));
        score s = judge(f);
        assert_true(s.dropped > 300);
        assert_true(10 * s.wrong_side < s.dropped);
        assert_true(50 * s.wrong_normal < s.filled);
        assert_true(s.mean_deg < 1.5);
    }
}

/* Two boards with a slit of three columns between them, before a wall that was seen alone. */
TEST_CASE(slits_are_open)
{
    seen_view *f = *state;
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    rlf_reconstruct *stage = stage_of(&def);
    const rlf_vec3 facing = {0, 0, -1};
    enum { SLIT = 90, WIDE = 3 };
    const rlf_surface *s = NULL;
    for (int t = 0; t < 8; t++) {
        set_board(f, facing);
        for (int i = 0; i < COUNT; i++) {
            int32_t x = i % WIDTH;
            if (t < 7 || (x >= SLIT && x < SLIT + WIDE)) {
                set_wall(f, i);
            }
        }
        s = process(f, stage, t);
    }
    int open = 0, bridged = 0, torn = 0, boards = 0;
    for (int32_t y = 25; y < 85; y++) {
        for (int32_t x = SLIT - 4; x < SLIT + WIDE + 4; x++) {
            int i = y * WIDTH + x;
            bool is_slit = x >= SLIT && x < SLIT + WIDE;
            open += is_slit && fabs(s->depth[i] - 3.0) < 0.05 && s->normal_z[i] < -0.99f;
            bridged += is_slit && fabs(s->depth[i] - 2.0) < 0.05;
            boards += !is_slit;
            torn += !is_slit && fabs(s->depth[i] - 2.0) > 0.05;
        }
    }
    assert_true(open > 120);
    assert_true(bridged < 60);
    assert_true(20 * torn < boards);
    rlf_reconstruct_destroy(&stage);
}

static bool is_near_outline(const seen_view *f, int32_t i)
{
    bool is_near = false;
    for (int32_t y = -3; y <= 3; y++) {
        for (int32_t x = -3; x <= 3; x++) {
            is_near = is_near || f->truth[i + y * WIDTH + x] > 2.9f;
        }
    }
    return is_near && f->truth[i] < 2.9f && f->seen[i] > 0.0f;
}

/* Mean error in degrees of what is seen within three pixels of the outline of a ball or a board
 * that crosses a wall which was seen alone. */
static double moving_error_deg(seen_view *f, bool is_ball, bool has_edge_normals)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &f->rig);
    def.enable_edge_normals = has_edge_normals;
    rlf_reconstruct *stage = stage_of(&def);
    const rlf_surface *s = NULL;
    for (int32_t t = 0; t < 12; t++) {
        if (t < 7) {
            for (int i = 0; i < COUNT; i++) {
                set_wall(f, i);
            }
        } else if (is_ball) {
            set_ball(f, rlf_vec3_make(0.01 * t, -0.05, 2.0), 0.25);
        } else {
            set_board(f, rlf_normalize(rlf_vec3_make(0.01 * t, 0.3, -1)));
        }
        s = process(f, stage, t);
    }
    double sum = 0.0;
    int32_t count = 0;
    for (int i = 4 * WIDTH; i < COUNT - 4 * WIDTH; i++) {
        if (is_near_outline(f, i)) {
            sum += angle_deg(rlf_vec3_make(s->normal_x[i], s->normal_y[i], s->normal_z[i]),
                             normals[i]);
            count++;
        }
    }
    rlf_reconstruct_destroy(&stage);
    assert_true(count > 30);
    print_message("%s %s edge normals: %.2f deg in %d pixels\n", is_ball ? "ball" : "board",
                  has_edge_normals ? "with" : "without", sum / count, count);
    return sum / count;
}

/* Windows lie inside of the outline: what they find is moved out to the pixel. */
TEST_CASE(what_is_seen_of_a_moving_ball_turns_away_too)
{
    seen_view *f = *state;
    double without = moving_error_deg(f, true, false), with = moving_error_deg(f, true, true);
    assert_true(with < 0.75 * without);
}

TEST_CASE(what_is_seen_of_a_moving_board_stays_flat)
{
    seen_view *f = *state;
    assert_true(moving_error_deg(f, false, true) < moving_error_deg(f, false, false) + 0.5);
}

TEST_GROUP(set_up, seen_view_destroy)
