/* Depth and ray of a picked pixel. */
#include "known/align.h"

#define WINDOW_PX 3.0 /* of the depth camera's pixels, to each side */
#define SAMPLES_MAX 1024
#define SHARE_MIN 0.12   /* of the samples are a thing; fewer are mixed pixels */
#define JUMP_MIN_M 0.025 /* between two things, and 1 % of the depth */

/* The surface's depth in the picture camera. */
typedef struct sensed {
    rlf_plane_f32 z;
    rlf_plane_u8 state;
    int32_t window; /* pixels of the picture to each side */
} sensed;

static rlf_result sense(const rlf_known_view *view, const rlf_camera *picture, sensed *out)
{
    const rlf_surface *s = view->surface;
    const rlf_pose T = view->rig->has_color ? view->rig->T_color_depth : rlf_pose_identity();
    size_t count = (size_t)picture->width * (size_t)picture->height;
    *out = (sensed){
        .z = {rlf_alloc_array(count, sizeof(float)), picture->width, picture->height,
              picture->width * (ptrdiff_t)sizeof(float)},
        .state = {rlf_alloc_array(count, 1), picture->width, picture->height, picture->width},
        .window = (int32_t)rlf_clamp(WINDOW_PX * picture->fx / s->camera.fx + 0.5, 2.0, 15.0)};
    rlf_registration *registration = NULL;
    rlf_result result = out->z.data != NULL && out->state.data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    if (result == RLF_OK) {
        result =
            rlf_registration_create(&s->camera, s->ray_x, s->ray_y, picture, &T, &registration);
    }
    if (result == RLF_OK) {
        rlf_registration_apply(registration, s->depth, &out->z, &out->state);
    }
    rlf_registration_destroy(&registration);
    return result;
}

static void sort(float *values, int32_t count)
{
    for (int32_t i = 1; i < count; i++) {
        float value = values[i];
        int32_t k = i;
        for (; k > 0 && values[k - 1] > value; k--) {
            values[k] = values[k - 1];
        }
        values[k] = value;
    }
}

/* The nearest depths that belong together, without their last twentieths; false = none. */
static bool nearest_thing(const float *sorted, int32_t count, known_pick *out)
{
    int32_t begin = 0;
    for (int32_t i = 1; i <= count; i++) {
        double z = sorted[i - 1];
        if (i == count || sorted[i] - z > JUMP_MIN_M + 0.01 * z) {
            if (i - begin >= SHARE_MIN * count) {
                int32_t end = (i - begin) / 20;
                double low = sorted[begin + end], high = sorted[i - 1 - end];
                out->z = 0.5 * (low + high);
                out->z_half = 0.5 * (high - low);
                return true;
            }
            begin = i;
        }
    }
    return false;
}

static bool find_depth(const sensed *seen, int32_t x, int32_t y, known_pick *out)
{
    float samples[SAMPLES_MAX];
    int32_t count = 0, window = seen->window;
    for (int32_t dy = -window; dy <= window; dy++) {
        for (int32_t dx = -window; dx <= window; dx++) {
            int32_t u = x + dx, v = y + dy;
            if (dx * dx + dy * dy <= window * window && u >= 0 && v >= 0 && u < seen->z.width &&
                v < seen->z.height && count < SAMPLES_MAX) {
                ptrdiff_t i = v * (ptrdiff_t)seen->z.width + u;
                if (seen->state.data[i] == RLF_REGISTERED_VISIBLE && seen->z.data[i] > 0.0f) {
                    samples[count++] = seen->z.data[i];
                }
            }
        }
    }
    sort(samples, count);
    return nearest_thing(samples, count, out);
}

static rlf_result look_up_pixel(const rlf_known_point *point, const sensed *seen,
                                const known_sight *sight, int32_t number, known_pick *out)
{
    double u = point->pixel[0], v = point->pixel[1];
    const rlf_camera *picture = &sight->picture;
    if (!(u >= -0.5 && v >= -0.5 && u < picture->width - 0.5 && v < picture->height - 0.5)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "point %d: pixel %g, %g is outside the picture of %d x %d", (int)number, u,
                        v, (int)picture->width, (int)picture->height);
    }
    if (!rlf_camera_unproject(picture, u, v, &out->ray)) {
        return rlf_fail(RLF_ERROR_INVALID, "point %d: pixel %g, %g is outside the lens",
                        (int)number, u, v);
    }
    out->has_pixel = true;
    out->has_depth = find_depth(seen, (int32_t)(u + 0.5), (int32_t)(v + 0.5), out);
    rlf_vec3 p = rlf_scale(out->ray, out->z);
    out->world = rlf_transform_inverse(&sight->T_picture_world, p);
    return RLF_OK;
}

static rlf_result look_up_all(const rlf_known_def *def, const sensed *seen,
                              const known_sight *sight, known_pick *picks)
{
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < def->point_count && result == RLF_OK; i++) {
        const rlf_known_point *point = &def->points[i];
        picks[i] = (known_pick){.model = point->model};
        if (point->has_pixel) {
            result = look_up_pixel(point, seen, sight, i + 1, &picks[i]);
        } else {
            picks[i].has_depth = true;
            picks[i].world = point->world;
        }
    }
    return result;
}

rlf_result known_look_up(const rlf_known_def *def, const rlf_known_view *view,
                         known_pick picks[RLF_KNOWN_POINTS_MAX], known_sight *out_sight)
{
    *out_sight = (known_sight){.T_picture_world = rlf_pose_identity()};
    if (view == NULL) {
        return look_up_all(def, NULL, out_sight, picks);
    }
    const rlf_rig *rig = view->rig;
    rlf_pose T_camera_world = rlf_pose_invert(&view->T_world_camera);
    out_sight->picture = rig->has_color ? rig->color : rig->depth;
    out_sight->T_picture_world =
        rig->has_color ? rlf_pose_mul(&rig->T_color_depth, &T_camera_world) : T_camera_world;
    out_sight->noise = rig->noise;
    sensed seen;
    rlf_result result = sense(view, &out_sight->picture, &seen);
    if (result == RLF_OK) {
        result = look_up_all(def, &seen, out_sight, picks);
    }
    rlf_free(seen.z.data);
    rlf_free(seen.state.data);
    return result;
}
