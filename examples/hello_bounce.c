/* Physics by itself: a ball falls onto a floor that is nothing but a depth image.
 *
 *      camera, looking down          z = 0
 *         \   |   /                  gravity is along +z
 *          \  o  /   ball            z = 1
 *      ______\|/______ floor         z = 2, seen as 64 x 48 depths
 *
 * Prints the ball's height once every tenth of a second. */
#include "relief/world.h"

#include <stdio.h>

#define WIDTH 64
#define HEIGHT 48
#define FOCAL 60.0 /* pixels */
#define FLOOR_Z 2.0

static float depth[WIDTH * HEIGHT];
static float normal_x[WIDTH * HEIGHT], normal_y[WIDTH * HEIGHT], normal_z[WIDTH * HEIGHT];
static float ray_x[WIDTH * HEIGHT], ray_y[WIDTH * HEIGHT];

static bool project(const void *context, rlf_vec3 p, double *out_u, double *out_v)
{
    (void)context;
    if (p.z <= 0.0) {
        return false;
    }
    *out_u = FOCAL * p.x / p.z + 0.5 * (WIDTH - 1);
    *out_v = FOCAL * p.y / p.z + 0.5 * (HEIGHT - 1);
    return true;
}

static rlf_grid make_floor(void)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int i = y * WIDTH + x;
            ray_x[i] = (float)((x - 0.5 * (WIDTH - 1)) / FOCAL);
            ray_y[i] = (float)((y - 0.5 * (HEIGHT - 1)) / FOCAL);
            depth[i] = (float)FLOOR_Z;
            normal_z[i] = -1.0f; /* towards the camera */
        }
    }
    rlf_grid grid = {.width = WIDTH, .height = HEIGHT, .ray_x = ray_x, .ray_y = ray_y};
    grid.background.depth = depth;
    grid.background.normal_x = normal_x;
    grid.background.normal_y = normal_y;
    grid.background.normal_z = normal_z;
    grid.project = project;
    grid.pixel_angle = 1.0 / FOCAL;
    grid.T_world_grid = rlf_pose_identity();
    return grid;
}

int main(void)
{
    rlf_world_def world_def = rlf_world_def_default();
    world_def.gravity = rlf_vec3_make(0, 0, 9.81);
    rlf_world *world = NULL;
    if (rlf_world_create(&world_def, &world) != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
        return 1;
    }
    rlf_body_def ball = rlf_body_def_default();
    ball.shape.type = RLF_SHAPE_SPHERE;
    ball.shape.radius = 0.1;
    ball.position = rlf_vec3_make(0, 0, 1);
    ball.restitution = 0.7;
    rlf_body_id id;
    if (rlf_world_add_body(world, &ball, &id) != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
        rlf_world_destroy(&world);
        return 1;
    }

    rlf_grid floor_grid = make_floor();
    double height = 0.0;
    bool has_bounced = false;
    for (int frame = 0; frame < 150; frame++) {
        floor_grid.time_ns = (int64_t)frame * 1000000000 / 30;
        rlf_world_advance(world, &floor_grid, 1.0 / 30);
        const rlf_body_state *state = &rlf_world_get_snapshot(world)->bodies[0];
        height = FLOOR_Z - state->T_world_body.p.z - ball.shape.radius;
        has_bounced = has_bounced || state->velocity.z < -1.0;
        if (frame % 3 == 2) {
            printf("%4.1f s  %6.3f m  %*s\n", (frame + 1) / 30.0, height, (int)(height * 60) + 1,
                   "o");
        }
    }
    rlf_world_destroy(&world);
    bool rests = height > -0.01 && height < 0.01;
    printf("it %s and %s\n", has_bounced ? "bounced" : "did not bounce",
           rests ? "rests on the floor" : "does not rest on the floor");
    return has_bounced && rests ? 0 : 1;
}
