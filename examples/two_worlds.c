/* One camera, two worlds: the same ball falls onto the same floor, on Earth and on the Moon. A
 * world of one's own takes its real surface from rlf_grid_from_surface, and any number live side by
 * side. */
#include "relief/relief.h"
#include "relief/synthetic.h"

#include <stdio.h>

#define FRAMES 45

static rlf_world *make_world(double gravity)
{
    rlf_world_def def = rlf_world_def_default();
    def.gravity = rlf_vec3_make(0, gravity, 0);
    rlf_body_def ball = rlf_body_def_default();
    ball.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.1};
    ball.position = rlf_vec3_make(-0.6, -0.5, 2.6);
    rlf_world *world = NULL;
    if (rlf_world_create(&def, &world) == RLF_OK &&
        rlf_world_add_body(world, &ball, NULL) != RLF_OK) {
        rlf_world_destroy(&world);
    }
    return world;
}

static double height_of(const rlf_world *world)
{
    return -rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.y;
}

static rlf_result run(rlf_source *source, rlf_reconstruct *stage, rlf_world *worlds[2])
{
    const rlf_pose T_world_camera = rlf_pose_identity();
    int64_t last_ns = 0;
    for (int i = 0; i < FRAMES; i++) {
        rlf_frame frame;
        const rlf_surface *surface;
        rlf_result result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            result = rlf_reconstruct_process(stage, &frame, &surface);
        }
        if (result != RLF_OK) {
            return result;
        }
        rlf_grid grid;
        rlf_grid_from_surface(surface, &T_world_camera, NULL, 0, &grid);
        for (int k = 0; k < 2 && i > 0; k++) {
            rlf_world_advance(worlds[k], &grid, (double)(frame.time_ns - last_ns) * 1e-9);
        }
        last_ns = frame.time_ns;
        if (i % 5 == 0) {
            printf("%4.2f s  Earth %6.2f m  Moon %6.2f m\n", (double)frame.time_ns * 1e-9,
                   height_of(worlds[0]), height_of(worlds[1]));
        }
    }
    return RLF_OK;
}

int main(void)
{
    rlf_synthetic_def room = rlf_synthetic_def_default();
    rlf_source *source = NULL;
    rlf_reconstruct *stage = NULL;
    rlf_world *worlds[2] = {make_world(9.81), make_world(1.62)};
    rlf_result result = worlds[0] != NULL && worlds[1] != NULL
                            ? rlf_synthetic_create(&room, &source)
                            : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        const rlf_reconstruct_def def =
            rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(source)->rig);
        result = rlf_reconstruct_create(&def, &stage);
    }
    if (result == RLF_OK) {
        result = run(source, stage, worlds);
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    const bool is_right = result == RLF_OK && height_of(worlds[0]) < height_of(worlds[1]);
    rlf_world_destroy(&worlds[0]);
    rlf_world_destroy(&worlds[1]);
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
    return is_right ? 0 : 1;
}
