/* The matrices of a WebXR depth view as a camera.
 *
 * Source: WebXR Depth Sensing Module. A buffer is looked up by normalised coordinates of the view
 * (origin top left, y down), which a matrix takes to normalised coordinates of the buffer: turned
 * by 90 degrees, mirrored, cropped or scaled. With the view's projection this is a pinhole camera
 * whose axes are those of the view, permuted. So no pixel is resampled: the camera is turned
 * instead, and a mirrored buffer is read from its last row on.
 *
 *      view: x right, y up, -z ahead       camera: x right, y down, z ahead, turned as the buffer
 */
#include "see_view.h"

#include <math.h>

#define SKEW_PIXELS 0.25 /* at the edge of a buffer: less than a turned camera is off by */
#define RIGID_ERROR 1e-3 /* of a rotation's columns, squared: what float32 and drift leave */

static rlf_result check_finite(const double *m, const char *name)
{
    for (int i = 0; i < 16; i++) {
        if (!rlf_is_finite(m[i])) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: element %d is not finite", name, i);
        }
    }
    return RLF_OK;
}

rlf_result see_numbers_check(const see_numbers *n)
{
    rlf_result result = check_finite(n->buffer_from_view, "normDepthBufferFromNormView");
    if (result == RLF_OK) {
        result = check_finite(n->projection, "projection matrix");
    }
    if (result == RLF_OK) {
        result = check_finite(n->world_from_view, "pose");
    }
    const double *p = n->projection;
    if (result == RLF_OK && (fabs(p[11] + 1.0) > RIGID_ERROR || fabs(p[15]) > RIGID_ERROR)) {
        result = rlf_fail(RLF_ERROR_INVALID, "projection matrix: it is no perspective");
    }
    if (result == RLF_OK && !(n->raw_to_m > 0.0 && rlf_is_finite(n->raw_to_m))) {
        result =
            rlf_fail(RLF_ERROR_INVALID, "rawValueToMeters is %g: it must be above 0", n->raw_to_m);
    }
    if (result == RLF_OK && !rlf_is_finite(n->time_ms)) {
        result = rlf_fail(RLF_ERROR_INVALID, "time %g ms: it must be finite", n->time_ms);
    }
    const bool is_metric = n->near_m == 0.0; /* as the page says, not as it computes */
    if (result == RLF_OK && !(n->every >= 1.0 && n->every <= EVERY_MAX)) {
        result =
            rlf_fail(RLF_ERROR_INVALID, "every %g pixels: use 1 to %d", n->every, (int)EVERY_MAX);
    }
    if (result == RLF_OK && !is_metric && !(n->near_m > 0.0 && n->far_m > n->near_m)) {
        result = rlf_fail(RLF_ERROR_INVALID, "depth planes %g and %g m: use 0 < near < far",
                          n->near_m, n->far_m);
    }
    return result;
}

/* The pose of a rigid matrix: rotation and place, nothing else. */
static rlf_result take_pose(const double *m, rlf_mat3 *rotation, rlf_vec3 *place)
{
    for (int c = 0; c < 3; c++) {
        for (int r = 0; r < 3; r++) {
            rotation->m[r][c] = m[4 * c + r];
        }
    }
    const rlf_mat3 transpose = rlf_mat3_transpose(rotation);
    const rlf_mat3 one = rlf_mat3_mul(&transpose, rotation);
    bool is_rigid = true;
    for (int i = 0; i < 9; i++) {
        is_rigid = is_rigid && fabs(one.m[i / 3][i % 3] - (i % 4 == 0)) < RIGID_ERROR;
    }
    const rlf_vec3 x = {m[0], m[1], m[2]}, y = {m[4], m[5], m[6]}, z = {m[8], m[9], m[10]};
    if (!is_rigid || rlf_dot(rlf_cross(x, y), z) < 0.0) {
        return rlf_fail(RLF_ERROR_INVALID, "pose: its matrix is no rotation");
    }
    *place = rlf_vec3_make(m[12], m[13], m[14]);
    return RLF_OK;
}

/* Pixels of the buffer by tangents of the view, y down: (i, j) = m (x, y) + c. */
typedef struct pixel_map {
    double m[2][2], c[2];
} pixel_map;

static pixel_map map_pixels(const see_numbers *n, int32_t width, int32_t height)
{
    const double *a = n->buffer_from_view, *p = n->projection;
    const double half[2] = {0.5 * p[0], 0.5 * p[5]};
    const double middle[2] = {0.5 * (1.0 - p[8]), 0.5 * (1.0 + p[9])};
    const double size[2] = {width, height};
    pixel_map map;
    for (int r = 0; r < 2; r++) {
        map.m[r][0] = size[r] * a[r] * half[0];
        map.m[r][1] = size[r] * a[4 + r] * half[1];
        map.c[r] = size[r] * (a[r] * middle[0] + a[4 + r] * middle[1] + a[12 + r]) - 0.5;
    }
    return map;
}

/* The buffer lies along the view's axes, maybe turned by quarters; anything else is refused. */
static rlf_result find_quarter(const pixel_map *map, int32_t width, int32_t height, bool *is_turned)
{
    const double size[2] = {width, height};
    *is_turned = fabs(map->m[0][0]) < fabs(map->m[0][1]);
    for (int r = 0; r < 2; r++) {
        const double along = fabs(map->m[r][*is_turned ? 1 - r : r]);
        const double aside = fabs(map->m[r][*is_turned ? r : 1 - r]);
        if (!(along > 0.0)) {
            return rlf_fail(RLF_ERROR_INVALID, "depth view: its matrices have no inverse");
        }
        if (aside * size[r] > SKEW_PIXELS * along) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "normDepthBufferFromNormView turns by no multiple of 90 degrees, or "
                            "shears: such a buffer would have to be resampled");
        }
    }
    return RLF_OK;
}

/* The camera of the buffer: its axes are the view's, each maybe reversed, maybe swapped. One that
 * comes out left-handed is a mirrored buffer: its rows are read backwards. */
rlf_result see_view_make(const see_numbers *n, int32_t width, int32_t height, see_view *out)
{
    pixel_map map = map_pixels(n, width, height);
    bool is_turned;
    rlf_mat3 world_view;
    rlf_vec3 place;
    rlf_result result = find_quarter(&map, width, height, &is_turned);
    if (result == RLF_OK) {
        result = take_pose(n->world_from_view, &world_view, &place);
    }
    if (result != RLF_OK) {
        return result;
    }
    const double along[2] = {map.m[0][is_turned], map.m[1][!is_turned]};
    const double handed = is_turned ? -along[0] * along[1] : along[0] * along[1];
    out->is_mirrored = handed < 0.0;
    const double x = along[0] > 0.0 ? 1.0 : -1.0;
    const double y = (along[1] > 0.0) == !out->is_mirrored ? 1.0 : -1.0;
    out->whole = (rlf_camera){.width = width,
                              .height = height,
                              .fx = fabs(along[0]),
                              .fy = fabs(along[1]),
                              .cx = map.c[0],
                              .cy = out->is_mirrored ? height - 1 - map.c[1] : map.c[1]};
    out->camera = rlf_camera_decimate(&out->whole, (int32_t)n->every);
    /* Columns: the camera's axes in the view, whose y is up and whose z is behind. */
    const rlf_mat3 view_camera = {{{is_turned ? 0.0 : x, is_turned ? y : 0.0, 0.0},
                                   {is_turned ? -x : 0.0, is_turned ? 0.0 : -y, 0.0},
                                   {0.0, 0.0, -1.0}}};
    const rlf_mat3 world_camera = rlf_mat3_mul(&world_view, &view_camera);
    out->T_world_camera = (rlf_pose){place, rlf_quat_from_mat3(&world_camera)};
    return rlf_camera_check(&out->camera, "depth view");
}
