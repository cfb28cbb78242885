/* Bodies have the camera's noise: as strong, and as alike from pixel to pixel, as what is around.
 */
#include "render/grain.h"
#include "render_scene.h"
#include "test.h"

#include <math.h>

#define FRAMES 24

static uint64_t state_of_noise = 1;

static double normal_noise(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        state_of_noise = state_of_noise * 6364136223846793005u + 1442695040888963407u;
        sum += (double)(state_of_noise >> 40) / 16777216.0;
    }
    return sum;
}

/* A grey picture with noise of `sigma` codes after a blur (side, 1, side) along rows. */
static void fill_noisy(render_scene *s, double sigma, double side)
{
    const int32_t width = s->rig.color.width;
    const double scale = sigma / sqrt(1.0 + 2.0 * side * side);
    double before = 0.0, here = 0.0, after = 0.0;
    for (int32_t i = 0; i < width * s->rig.color.height; i++) {
        before = here;
        here = after;
        after = normal_noise();
        const double code = 120.0 + scale * (here + side * (before + after));
        memset(s->color + 4 * (size_t)i, (int)(code + 0.5), 3);
    }
}

/* Variance of changes from picture to picture, and their correlation with the next pixel's. */
typedef struct power {
    double square, beside;
    int64_t count;
} power;

static void add_power(power *p, const uint8_t *last, const rlf_image_rgba8 *now, int32_t x0,
                      int32_t y0)
{
    for (int32_t y = y0; y < y0 + 40; y++) {
        for (int32_t x = x0; x < x0 + 40; x++) {
            const ptrdiff_t at = 4 * ((ptrdiff_t)y * now->width + x) + 1;
            const double d = (double)now->data[at] - last[at];
            const double next = (double)now->data[at + 4] - last[at + 4];
            p->square += d * d;
            p->beside += d * next;
            p->count++;
        }
    }
}

/* Noise of a wall and of a grey box before it. */
static void measure(double sigma, double side, power *wall, power *body)
{
    render_scene *s = scene_make(3.0);
    rlf_body_state *box = scene_add_body(s, scene_box(0.5), rlf_vec3_make(0.052, 0, 2.0));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    const size_t size = 4 * (size_t)s->rig.color.width * (size_t)s->rig.color.height;
    uint8_t *last = malloc(size);
    for (int k = 0; k < 3; k++) {
        box->color[k] = 0.8f;
    }
    def.light_direction = rlf_vec3_make(0, 0, 1);
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    *wall = *body = (power){0};
    for (int i = 0; i < FRAMES; i++) {
        rlf_render_output out;
        fill_noisy(s, sigma, side);
        s->frame.sequence++;
        assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
        if (i > FRAMES / 2) {
            add_power(wall, last, &out.image, 100, 100);
            add_power(body, last, &out.image, 460, 250);
        }
        memcpy(last, out.image.data, size);
    }
    free(last);
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(bodies_are_as_noisy_as_what_is_around)
{
    static const double kinds[3][2] = {{2.0, 0.0}, {5.0, 0.3}, {8.0, 0.5}};
    for (int i = 0; i < 3; i++) {
        power wall, body;
        measure(kinds[i][0], kinds[i][1], &wall, &body);
        const double ratio = body.square / wall.square;
        const double wall_beside = wall.beside / wall.square;
        const double body_beside = body.beside / body.square;
        print_message("sigma %.0f: power of the body's noise over its neighbours' %.3f, "
                      "correlation with the next pixel %.2f, theirs %.2f\n",
                      kinds[i][0], ratio, body_beside, wall_beside);
        assert_true(ratio > 0.9 && ratio < 1.1);
        assert_true(fabs(body_beside - wall_beside) < 0.1);
    }
}

/* A picture that stands still, as one that is shown again and again, gives none. */
TEST_CASE(no_noise_gives_none)
{
    power wall, body;
    measure(0.0, 0.0, &wall, &body);
    assert_true(wall.square == 0.0 && body.square == 0.0);
}

/* What moves is no noise. */
TEST_CASE(a_moving_hand_is_no_noise)
{
    render_scene *s = scene_make(3.0);
    grain *g = calloc(1, sizeof(*g));
    const int32_t width = s->rig.color.width;
    grain_init(g);
    for (int i = 0; i < FRAMES; i++) {
        fill_noisy(s, 2.0, 0.0);
        for (int32_t y = 100; y < 300; y++) {
            memset(s->color + 4 * ((size_t)y * (size_t)width + 20 * (size_t)i), 200, 4 * 150);
        }
        s->frame.sequence++;
        grain_update(g, &s->frame);
    }
    assert_true(g->is_known);
    assert_true(g->sigma[120 / 16][1] > 1.8f && g->sigma[120 / 16][1] < 2.3f);
    free(g);
    scene_free(s);
}

/* The largest noise of any brightness in pictures of waves that move by so many pixels and get
 * brighter by so many codes, each time. */
static float largest_of_moving(int pixels, int codes)
{
    render_scene *s = scene_make(3.0);
    grain *g = calloc(1, sizeof(*g));
    const int32_t width = s->rig.color.width;
    float largest = 0.0f;
    grain_init(g);
    for (int i = 0; i < FRAMES; i++) {
        fill_noisy(s, 2.0, 0.0);
        for (int32_t at = 0; at < width * s->rig.color.height; at++) {
            const double x = at % width + pixels * i;
            const double y = at / width;
            const int more = (int)(60.0 * sin(x / 23.0) * cos(y / 31.0) + 20.0 * sin(x / 5.0));
            memset(s->color + 4 * (size_t)at, s->color[4 * (size_t)at] + more + codes * i, 3);
        }
        s->frame.sequence++;
        grain_update(g, &s->frame);
    }
    for (int k = 0; k < GRAIN_BINS; k++) {
        largest = g->sigma[k][1] > largest ? g->sigma[k][1] : largest;
    }
    free(g);
    scene_free(s);
    return largest;
}

/* A camera that moves, or whose exposure does, shows changes that are no noise. Bodies may get
 * less, but never twice as much as the room has. */
TEST_CASE(a_moving_camera_gives_no_more)
{
    const float still = largest_of_moving(0, 0);
    assert_true(still > 1.8f && still < 2.4f);
    for (int pixels = 1; pixels <= 16; pixels *= 2) {
        const float moving = largest_of_moving(pixels, 0);
        print_message("waves that move by %d pixels: noise %.2f of 2\n", pixels, moving);
        assert_true(moving < 4.0f);
    }
    assert_true(largest_of_moving(0, 2) < 2.6f);
}

/* ---- sharpness ------------------------------------------------------------------------------ */

#define STRIPE 61.3 /* pixels, so that edges lie everywhere between pixels */

/* Share of a Gaussian's step that is passed at x sigma. */
static double step_at(double x)
{
    return 0.5 * (1.0 + erf(x / sqrt(2.0)));
}

/* Bright and dark stripes, blurred. */
static void fill_stripes(render_scene *s, double sigma)
{
    const int32_t width = s->rig.color.width;
    for (int32_t x = 0; x < width; x++) {
        double light = 0.0;
        for (int k = 0; k * STRIPE < width + STRIPE; k++) {
            const double side = step_at((x - k * STRIPE) / sigma);
            light += k % 2 == 0 ? side : -side;
        }
        const int code = (int)(60.0 + 130.0 * light + 0.5);
        for (int32_t y = 0; y < s->rig.color.height; y++) {
            memset(s->color + 4 * ((ptrdiff_t)y * width + x), code, 3);
        }
    }
}

/* From 10 to 90 % of the edge between x0 and x1 of a row, one way or the other. */
static double edge_width(const uint8_t *row, int32_t x0, int32_t x1)
{
    double at[2] = {0.0, 0.0};
    const double low = row[4 * x0];
    const double step = row[4 * x1] - low;
    for (int i = 0; i < 2; i++) {
        const double wanted = i == 0 ? 0.1 : 0.9;
        int32_t x = x0;
        while (x < x1 && (row[4 * (x + 1)] - low) / step < wanted) {
            x++;
        }
        const double here = (row[4 * x] - low) / step;
        const double next = (row[4 * (x + 1)] - low) / step;
        at[i] = x + (wanted - here) / (next - here);
    }
    return at[1] - at[0];
}

/* Mean widths of the stripes' edges, and of the left edge of boxes that stand everywhere between
 * pixels, before a dark stripe. */
static void measure_edges(double sigma, double *room, double *body)
{
    render_scene *s = scene_make(3.0);
    rlf_body_state *box = scene_add_body(s, scene_box(0.3), rlf_vec3_make(0, 0, 2.0));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    box->color[0] = box->color[1] = box->color[2] = 1.0f;
    def.light_direction = rlf_vec3_make(0, 0, 1);
    def.enable_real_ambient = false;
    fill_stripes(s, sigma);
    assert_int_equal(rlf_compositor_create_soft(&def, &compositor), RLF_OK);
    *body = *room = 0.0;
    for (int i = 0; i < 16; i++) {
        rlf_render_output out;
        const double left = 7.5 * STRIPE + i / 16.0; /* in the middle of a dark one */
        box->T_world_body.p.x = (left - s->rig.color.cx) / 540.5 * 1.85 + 0.15 + 0.052;
        s->frame.sequence++;
        assert_int_equal(rlf_compositor_render(compositor, &s->input, &out), RLF_OK);
        *body += edge_width(rlf_rgba8_row(&out.image, 270), (int32_t)left - 8, (int32_t)left + 9);
    }
    const uint8_t *row = s->color;
    for (int k = 1; k < 15; k++) {
        *room += edge_width(row, (int32_t)(k * STRIPE) - 10, (int32_t)(k * STRIPE) + 10) / 14.0;
    }
    *body /= 16.0;
    rlf_compositor_destroy(&compositor);
    scene_free(s);
}

TEST_CASE(edges_are_as_wide_as_the_room_s)
{
    static const double sigmas[4] = {0.3, 0.6, 0.8, 1.0};
    for (int i = 0; i < 4; i++) {
        double room, body;
        measure_edges(sigmas[i], &room, &body);
        print_message("blur of %.1f pixels: the room's edges are %.2f wide, a body's %.2f\n",
                      sigmas[i], room, body);
        assert_true(body > 0.85 * room && body < 1.2 * room);
    }
}
