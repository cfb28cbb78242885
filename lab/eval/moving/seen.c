/* True depth and normals of a still room from any place. */
#include "eval/moving/seen.h"

#define FOCAL 137.0 /* pixels: the view of a Kinect v2 */

static bool project(const void *context, rlf_vec3 p, double *u, double *v)
{
    (void)context;
    *u = FOCAL * p.x / p.z + 0.5 * (SEEN_W - 1);
    *v = FOCAL * p.y / p.z + 0.5 * (SEEN_H - 1);
    return p.z > 1e-6 && *u > -0.5 && *v > -0.5 && *u < SEEN_W - 0.5 && *v < SEEN_H - 0.5;
}

rlf_camera seen_room_camera(void)
{
    return (rlf_camera){.width = SEEN_W,
                        .height = SEEN_H,
                        .fx = FOCAL,
                        .fy = FOCAL,
                        .cx = 0.5 * (SEEN_W - 1),
                        .cy = 0.5 * (SEEN_H - 1)};
}

void seen_room_start(seen_room *seen, rlf_source *source, const rlf_pose *T_world_source)
{
    const double THICKNESS = 0.25; /* as much is guessed of what has no known back */
    seen->source = source;
    seen->T_world_source = *T_world_source;
    for (int32_t i = 0; i < SEEN_PIXELS; i++) {
        seen->ray_x[i] = (float)((i % SEEN_W - 0.5 * (SEEN_W - 1)) / FOCAL);
        seen->ray_y[i] = (float)((i / SEEN_W - 0.5 * (SEEN_H - 1)) / FOCAL);
    }
    seen->grid = (rlf_grid){.width = SEEN_W,
                            .height = SEEN_H,
                            .ray_x = seen->ray_x,
                            .ray_y = seen->ray_y,
                            .project = project,
                            .pixel_angle = 1.0 / FOCAL,
                            .background = {.depth = seen->depth,
                                           .normal_x = seen->normal[0],
                                           .normal_y = seen->normal[1],
                                           .normal_z = seen->normal[2],
                                           .default_thickness = THICKNESS}};
}

/* Normals of the camera's pixels: those of the true surface at their points. */
static rlf_result find_normals(seen_room *seen, const rlf_pose *T_source_camera)
{
    const rlf_quat back = rlf_quat_conjugate(T_source_camera->q);
    for (int32_t i = 0; i < SEEN_PIXELS; i++) {
        rlf_vec3 normal = {0, 0, 0};
        if (seen->depth[i] > 0.0f) {
            double distance;
            int32_t label;
            rlf_vec3 p = rlf_mad(T_source_camera->p, seen->ways[i], (double)seen->depth[i]);
            rlf_result result = rlf_synthetic_distance(seen->source, p, &distance, &normal, &label);
            if (result != RLF_OK) {
                return result;
            }
        }
        normal = rlf_rotate(back, normal);
        seen->normal[0][i] = (float)normal.x;
        seen->normal[1][i] = (float)normal.y;
        seen->normal[2][i] = (float)normal.z;
    }
    return RLF_OK;
}

rlf_result seen_room_look(seen_room *seen, const rlf_pose *T_world_camera)
{
    const rlf_pose T_source_world = rlf_pose_invert(&seen->T_world_source);
    const rlf_pose T = rlf_pose_mul(&T_source_world, T_world_camera);
    for (int32_t i = 0; i < SEEN_PIXELS; i++) {
        seen->ways[i] =
            rlf_rotate(T.q, rlf_vec3_make((double)seen->ray_x[i], (double)seen->ray_y[i], 1.0));
    }
    rlf_result result =
        rlf_synthetic_cast(seen->source, T.p, seen->ways, SEEN_PIXELS, seen->depth, NULL);
    seen->grid.T_world_grid = *T_world_camera;
    seen->grid.time_ns += 33333333;
    return result == RLF_OK ? find_normals(seen, &T) : result;
}

double seen_room_distance(const seen_room *seen, rlf_vec3 p)
{
    double distance = 1e9;
    int32_t label;
    rlf_vec3 normal;
    (void)rlf_synthetic_distance(seen->source, rlf_transform_inverse(&seen->T_world_source, p),
                                 &distance, &normal, &label);
    return distance;
}
