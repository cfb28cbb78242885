/* Mouse positions, rays and thrown bodies. */
#include "viewer/mouse.h"

#define START_M 0.29 /* ahead of the camera, so that the body does not fill the picture */

/* Where the picture would be at that place of the window if nothing were askew. */
static bool map_place(const viewer_fit *fit, double *x, double *y)
{
    const rlf_vec3 at = {*x / fit->window_width, *y / fit->window_height, 1.0};
    const rlf_vec3 mapped = rlf_mat3_mul_vec(fit->map, at);
    *x = mapped.x / mapped.z * fit->window_width;
    *y = mapped.y / mapped.z * fit->window_height;
    return mapped.z > 0.0 && *x >= 0.0 && *x <= fit->window_width && *y >= 0.0 &&
           *y <= fit->window_height;
}

bool viewer_fit_pick(const viewer_fit *fit, double window_x, double window_y, double *out_u,
                     double *out_v)
{
    const double wide = fit->window_width / fit->picture_width;
    const double high = fit->window_height / fit->picture_height;
    const double scale = fit->fills ? rlf_max(wide, high) : rlf_min(wide, high);
    if (fit->map != NULL && !map_place(fit, &window_x, &window_y)) {
        return false;
    }
    double left = 0.5 * (fit->window_width - scale * fit->picture_width);
    double top = 0.5 * (fit->window_height - scale * fit->picture_height);
    /* Window positions count from pixel corners, picture pixels from centres. */
    *out_u = (window_x - left) / scale - 0.5;
    *out_v = (window_y - top) / scale - 0.5;
    return *out_u >= -0.5 && *out_u <= fit->picture_width - 0.5 && *out_v >= -0.5 &&
           *out_v <= fit->picture_height - 0.5;
}

viewer_ray viewer_ray_make(const rlf_compositor_def *def, const rlf_pose *T_world_camera, double u,
                           double v)
{
    const rlf_rig *rig = &def->rig;
    const rlf_camera *camera = rig->has_color ? &rig->color : &rig->depth;
    int32_t width = def->width > 0 ? def->width : camera->width;
    int32_t height = def->height > 0 ? def->height : camera->height;
    rlf_camera picture = rlf_camera_resize(camera, width, height);
    rlf_pose T_camera_picture =
        rig->has_color ? rlf_pose_invert(&rig->T_color_depth) : rlf_pose_identity();
    rlf_pose T_world_picture = rlf_pose_mul(T_world_camera, &T_camera_picture);
    rlf_vec3 ray;
    (void)rlf_camera_unproject(&picture, u, v, &ray); /* outside the lens: the best ray */
    viewer_ray r = {T_world_picture.p, rlf_normalize(rlf_rotate(T_world_picture.q, ray))};
    return r;
}

double viewer_throw_speed(double drag_fraction)
{
    if (drag_fraction < 0.02) {
        return VIEWER_THROW_SPEED;
    }
    return rlf_clamp(VIEWER_THROW_SPEED_MAX * drag_fraction, VIEWER_THROW_SPEED_MIN,
                     VIEWER_THROW_SPEED_MAX);
}

viewer_throw_def viewer_throw_def_default(void)
{
    return (viewer_throw_def){.size_m = 0.12, .restitution = 0.5};
}

const char *viewer_throw_name(viewer_throw_kind kind)
{
    static const char *const names[VIEWER_THROW_KINDS] = {"cube", "ball", "capsule", "cylinder",
                                                          "model"};
    return names[kind];
}

static rlf_shape shape_of(const viewer_throw_def *thrown)
{
    const double size = thrown->size_m;
    rlf_shape shape = {.type = RLF_SHAPE_BOX, .size = rlf_vec3_make(size, size, size)};
    switch (thrown->kind) {
    case VIEWER_THROW_BALL: return (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = 0.5 * size};
    case VIEWER_THROW_CAPSULE:
        return (rlf_shape){.type = RLF_SHAPE_CAPSULE, .radius = 0.25 * size, .height = 0.5 * size};
    case VIEWER_THROW_CYLINDER:
        return (rlf_shape){.type = RLF_SHAPE_CYLINDER, .radius = 0.3 * size, .height = size};
    case VIEWER_THROW_MODEL: return thrown->shape;
    case VIEWER_THROW_CUBE:
    case VIEWER_THROW_KINDS: break;
    }
    return shape;
}

rlf_body_def viewer_throw_body(const viewer_throw_def *thrown, const viewer_ray *ray, double speed,
                               int32_t index)
{
    static const float colors[6][3] = {{0.95f, 0.55f, 0.15f}, {0.25f, 0.65f, 0.95f},
                                       {0.45f, 0.85f, 0.35f}, {0.90f, 0.30f, 0.40f},
                                       {0.75f, 0.50f, 0.95f}, {0.95f, 0.85f, 0.30f}};
    const double density = 115.0; /* kg/m^3, of the box around it: balsa */
    const bool is_model = thrown->kind == VIEWER_THROW_MODEL;
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape_of(thrown);
    def.mass = density * thrown->size_m * thrown->size_m * thrown->size_m;
    def.restitution = thrown->restitution;
    def.position = rlf_mad(ray->origin, ray->direction, START_M + 0.5 * thrown->size_m);
    def.velocity = rlf_scale(ray->direction, speed);
    def.angular_velocity = rlf_vec3_make(2.0, 3.0, -1.0);
    def.look = is_model ? thrown->look : def.look;
    for (int i = 0; i < 3; i++) {
        def.color[i] = is_model ? 1.0f : colors[index % 6][i];
    }
    return def;
}
