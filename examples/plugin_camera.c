/* A camera of your own as a plug-in: a shared object that needs Relief's headers and links nothing
 * of it.
 *
 *     relief run plugin_camera: --plugin build/release/examples/plugin_camera.so
 *
 * This one makes its pictures itself: a ball swings before a wall, above a floor.
 *
 *       camera (0, 0, 0)                 wall z = 3
 *          \ \                              |
 *           \   \        o  ball            |
 *            \_____\________________________|   floor y = 1 (y is down)
 *
 * To make it yours, replace `draw` by what your driver gives. */
#define _POSIX_C_SOURCE 200809L
#include "relief/backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define WIDTH 320
#define HEIGHT 240
#define FOCAL 300.0 /* pixels */
#define WALL_Z 3.0
#define FLOOR_Y 1.0
#define BALL_RADIUS 0.25
#define BALL_Z 2.0

static const rlf_backend_host *host;

typedef struct camera {
    int64_t start_ns, interval_ns;
    uint64_t made; /* frames so far; those that nobody asked for in time are gone */
    uint16_t depth[WIDTH * HEIGHT]; /* millimetres */
    uint8_t color[WIDTH * HEIGHT * 4];
} camera;

/* Distance along z to the ball at (x, 0.4, BALL_Z) on the ray (a, b, 1), or 0. */
static double hit_ball(double x, double a, double b)
{
    const double y = 0.4;
    const double square = a * a + b * b + 1.0;
    const double along = a * x + b * y + BALL_Z;
    const double rest = x * x + y * y + BALL_Z * BALL_Z - BALL_RADIUS * BALL_RADIUS;
    const double root = along * along - square * rest;
    if (root < 0.0) {
        return 0.0;
    }
    double s = 1.0; /* sqrt(root) by Newton: no libm needed */
    for (int i = 0; i < 40; i++) {
        s = 0.5 * (s + root / s);
    }
    return (along - s) / square;
}

static void draw(camera *self, double ball_x)
{
    for (int v = 0; v < HEIGHT; v++) {
        for (int u = 0; u < WIDTH; u++) {
            const double a = (u - 0.5 * (WIDTH - 1)) / FOCAL;
            const double b = (v - 0.5 * (HEIGHT - 1)) / FOCAL;
            const bool is_floor = b * WALL_Z > FLOOR_Y;
            const double room = is_floor ? FLOOR_Y / b : WALL_Z;
            const double ball = hit_ball(ball_x, a, b);
            const bool is_ball = ball > 0.0 && ball < room;
            const int i = v * WIDTH + u;
            self->depth[i] = (uint16_t)(1000.0 * (is_ball ? ball : room) + 0.5);
            uint8_t *pixel = self->color + (size_t)i * 4;
            pixel[0] = is_ball ? 220 : is_floor ? 110 : 190;
            pixel[1] = is_ball ? 90 : is_floor ? 90 : 190;
            pixel[2] = is_ball ? 40 : is_floor ? 70 : 180;
            pixel[3] = 255;
        }
    }
}

/* From -0.6 to 0.6 m and back within four seconds. */
static double ball_at(double time_s)
{
    const double phase = time_s / 4.0 - (double)(int64_t)(time_s / 4.0);
    const double along = phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase;
    return 0.6 * (2.0 * along * along * (3.0 - 2.0 * along) - 1.0);
}

/* Waits for the next frame; a driver would wait for the bus. Never for long: the caller has a
 * window to serve. */
static rlf_result next(void *context, rlf_frame *out)
{
    camera *self = context;
    const int64_t now_ns = host->clock_ns() - self->start_ns;
    const uint64_t newest = (uint64_t)(now_ns / self->interval_ns);
    if (newest < self->made) {
        const int64_t wait_ns = (int64_t)self->made * self->interval_ns - now_ns;
        const struct timespec rest = {0, (long)(wait_ns < 20000000 ? wait_ns : 20000000)};
        nanosleep(&rest, NULL);
        return RLF_NO_FRAME;
    }
    self->made = newest + 1;
    const int64_t time_ns = (int64_t)newest * self->interval_ns;
    draw(self, ball_at((double)time_ns * 1e-9));
    out->sequence = newest; /* a gap tells of the frames that were lost */
    out->time_ns = time_ns;
    out->host_time_ns = host->clock_ns();
    out->flags = RLF_FRAME_ALIGNED;
    out->depth_u16 = self->depth;
    out->depth_stride = WIDTH * 2;
    out->depth_units_per_metre = 1000.0;
    out->color = (rlf_image_rgba8){self->color, WIDTH, HEIGHT, WIDTH * 4};
    return RLF_OK;
}

static void destroy(void *context)
{
    free(context);
}

static int32_t list(rlf_source_entry *out, int32_t capacity)
{
    if (capacity > 0) {
        snprintf(out->source, sizeof(out->source), "plugin_camera:");
        snprintf(out->description, sizeof(out->description), "a ball before a wall");
    }
    return 1;
}

static rlf_result open_camera(const rlf_address *address, rlf_opened *out)
{
    const char *text = rlf_address_get(address, "fps");
    const long rate = text != NULL ? strtol(text, NULL, 10) : 30;
    if (rate < 1 || rate > 200) {
        return host->fail(RLF_ERROR_INVALID, "plugin_camera: fps: use 1 to 200");
    }
    camera *self = calloc(1, sizeof(*self));
    if (self == NULL) {
        return host->fail(RLF_ERROR_MEMORY, "plugin_camera: out of memory");
    }
    self->start_ns = host->clock_ns();
    self->interval_ns = 1000000000 / rate;
    const rlf_camera lens = {.width = WIDTH,
                             .height = HEIGHT,
                             .fx = FOCAL,
                             .fy = FOCAL,
                             .cx = 0.5 * (WIDTH - 1),
                             .cy = 0.5 * (HEIGHT - 1)};
    out->methods = (rlf_source_methods){.next = next, .destroy = destroy};
    out->self = self;
    out->info = (rlf_source_info){.name = "plugin_camera:",
                                  .rig = {.depth = lens,
                                          .color = lens,
                                          .T_color_depth = rlf_pose_identity(),
                                          .has_color = true,
                                          .depth_min_m = 0.3,
                                          .depth_max_m = 5.0,
                                          .noise = {.c0 = 0.0005}},
                                  .frame_count = -1,
                                  .frames_per_second = (double)rate,
                                  .is_live = true,
                                  .device = "example of a plug-in"};
    return RLF_OK;
}

static const rlf_backend backend = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "plugin_camera",
    .keys = "fps",
    .summary = "example of a plug-in: a ball before a wall",
    .is_live = true,
    .list = list,
    .open = open_camera,
};

RLF_PLUGIN_EXPORT const rlf_backend *rlf_backend_entry(const rlf_backend_host *given);

const rlf_backend *rlf_backend_entry(const rlf_backend_host *given)
{
    host = given;
    return given->version == RLF_BACKEND_VERSION ? &backend : NULL;
}
