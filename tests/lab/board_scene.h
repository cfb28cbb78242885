/* A chessboard before a wall, drawn for tests of `relief calibrate`. */
#ifndef RELIEF_TESTS_APP_BOARD_SCENE_H
#define RELIEF_TESTS_APP_BOARD_SCENE_H

#include "calibrate/views.h"
#include "relief/frame.h"

#define BOARD_VIEWS 12
#define BOARD_WALL_M 1.5

static const calibrate_board test_board = {
    .columns = 9, .rows = 6, .square_m = 0.025, .outline_m = {0.30, 0.225}};

/* Two cameras of 320 x 240; the second 40 mm to the right. */
static inline rlf_rig board_rig(void)
{
    rlf_rig rig = {.has_color = true,
                   .depth_min_m = 0.2,
                   .depth_max_m = 4.0,
                   .noise = {0.001, 0.0, 0.001},
                   .T_color_depth = rlf_pose_identity()};
    rig.depth = (rlf_camera){.width = 320,
                             .height = 240,
                             .fx = 300.0,
                             .fy = 302.0,
                             .cx = 162.0,
                             .cy = 117.0,
                             .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                             .distortion = {0.08, -0.1, 0.0, 0.0, 0.0}};
    rig.color = rig.depth;
    rig.color.fx = 310.0;
    rig.color.fy = 309.0;
    rig.color.distortion[0] = -0.1;
    rig.T_color_depth.p = rlf_vec3_make(-0.04, 0.001, 0.002);
    rig.T_color_depth.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.01, -0.015, 0.005));
    return rig;
}

/* Pose of view `i` in the first camera's frame: through all of the picture, tilted to all sides. */
static inline rlf_pose board_pose(int i)
{
    static const double place[BOARD_VIEWS][3] = {
        {-0.07, -0.05, 0.52}, {0.07, -0.05, 0.5},   {0.08, 0.05, 0.52}, {-0.07, 0.05, 0.5},
        {0.0, 0.0, 0.4},      {-0.12, 0.0, 0.6},    {0.14, 0.02, 0.6},  {0.02, -0.08, 0.6},
        {0.0, 0.09, 0.6},     {-0.12, -0.09, 0.65}, {0.13, 0.09, 0.66}, {0.01, 0.01, 0.7}};
    static const double tilt[BOARD_VIEWS][3] = {
        {0.4, 0.1, 0.1},   {-0.4, 0.2, 0.0}, {0.1, 0.45, -0.1}, {0.1, -0.45, 0.0},
        {0.3, 0.3, 0.05},  {-0.3, -0.35, 0}, {0.35, -0.3, 0.1}, {-0.5, 0.1, 0.0},
        {0.5, -0.1, -0.1}, {0.2, 0.5, 0.0},  {-0.2, -0.5, 0.1}, {0.0, 0.1, 0.2}};
    return (rlf_pose){
        .q = rlf_quat_from_rotation_vector(rlf_vec3_make(tilt[i][0], tilt[i][1], tilt[i][2])),
        .p = rlf_vec3_make(place[i][0], place[i][1], place[i][2])};
}

/* Depth of the board along a ray; 0 where it misses, *at is the place on the board. */
static inline double board_hit(const rlf_pose *T, rlf_vec3 ray, rlf_vec3 *at)
{
    const rlf_vec3 n = rlf_rotate(T->q, rlf_vec3_make(0, 0, 1));
    const double z = rlf_dot(n, T->p) / rlf_dot(n, ray);
    *at = rlf_transform_inverse(T, rlf_scale(ray, z));
    const bool is_on = z > 0.0 &&
                       at->x * at->x < 0.25 * test_board.outline_m[0] * test_board.outline_m[0] &&
                       at->y * at->y < 0.25 * test_board.outline_m[1] * test_board.outline_m[1];
    return is_on ? z : 0.0;
}

/* Brightness 0..255 of what the camera sees along the ray: paper, black squares, a grey wall. */
static inline int board_brightness(const rlf_pose *T, rlf_vec3 ray)
{
    rlf_vec3 at;
    if (board_hit(T, ray, &at) == 0.0) {
        return 110;
    }
    const double x = at.x / test_board.square_m + 0.5 * (test_board.columns + 1);
    const double y = at.y / test_board.square_m + 0.5 * (test_board.rows + 1);
    const bool is_inside =
        x > 0.0 && y > 0.0 && x < test_board.columns + 1 && y < test_board.rows + 1;
    return is_inside && ((int)x + (int)y) % 2 == 0 ? 30 : 220;
}

#define BOARD_RAYS 4 /* of a pixel */

/* Rays of every pixel, BOARD_RAYS each, for board_draw; the caller has the room. */
static inline void board_rays(const rlf_camera *camera, rlf_vec3 *out)
{
    for (int32_t i = 0; i < camera->width * camera->height * BOARD_RAYS; i++) {
        const int32_t p = i / BOARD_RAYS, k = i % BOARD_RAYS;
        rlf_camera_unproject(camera, p % camera->width + (k % 2 - 0.5) / 2.0,
                             p / camera->width + (k / 2 - 0.5) / 2.0, &out[i]);
    }
}

/* Grey picture of the board at T (in the camera's frame). */
static inline void board_draw(int32_t pixels, const rlf_vec3 *rays, const rlf_pose *T, uint8_t *out)
{
    for (int32_t i = 0; i < pixels; i++) {
        int sum = BOARD_RAYS / 2;
        for (int k = 0; k < BOARD_RAYS; k++) {
            sum += board_brightness(T, rays[BOARD_RAYS * i + k]);
        }
        out[i] = (uint8_t)(sum / BOARD_RAYS);
    }
}

/* Depth of the board before the wall, millimetres, along each pixel's ray. */
static inline void board_depth(int32_t pixels, const rlf_vec3 *rays, const rlf_pose *T,
                               double offset_m, uint16_t *out)
{
    for (int32_t i = 0; i < pixels; i++) {
        rlf_vec3 at;
        const double z = board_hit(T, rays[i], &at);
        out[i] = (uint16_t)(1000.0 * ((z > 0.0 ? z : BOARD_WALL_M) + offset_m) + 0.5);
    }
}

#endif
