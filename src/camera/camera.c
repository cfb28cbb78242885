/* The lens model: projection, unprojection by Newton iteration, and cameras of derived images. */
#include "camera/pixels.h"
#include "relief/camera.h"

/* Distorted coordinates of an undistorted ray (x, y), and their Jacobian. */
typedef struct distorted {
    double x, y;
    double xx, xy, yx, yy; /* d(x, y)/d(ray x, ray y) */
} distorted;

/* Brown-Conrady with optional rational denominator (Brown 1971; Claus and Fitzgibbon 2005 as used
 * by OpenCV and ROS): x' = x L(r2) + 2 p1 x y + p2 (r2 + 2 x2), and alike for y. */
static distorted distort(const double k[8], double x, double y)
{
    double r2 = x * x + y * y;
    double num = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    double den = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    double num_d = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]);
    double den_d = k[5] + r2 * (2.0 * k[6] + r2 * 3.0 * k[7]);
    double L = num / den;
    double L_d = (num_d - L * den_d) / den; /* dL / d r2 */
    double p1 = k[2];
    double p2 = k[3];
    distorted d;
    d.x = x * L + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
    d.y = y * L + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
    d.xx = L + 2.0 * x * x * L_d + 2.0 * p1 * y + 6.0 * p2 * x;
    d.xy = 2.0 * x * y * L_d + 2.0 * p1 * x + 2.0 * p2 * y;
    d.yx = d.xy;
    d.yy = L + 2.0 * y * y * L_d + 6.0 * p1 * y + 2.0 * p2 * x;
    return d;
}

/* The model is only meant for rays within which it stays one-to-one: L > 0 and a positive Jacobian
 * determinant, at the ray itself and on the way to it (beyond the first fold both can recover). */
static bool is_inside_model(const double k[8], double x, double y)
{
    for (int step = 1; step <= 8; step++) {
        double t = step / 8.0;
        distorted d = distort(k, x * t, y * t);
        double det = d.xx * d.yy - d.xy * d.yx;
        if (!(det > 0.0) || !(d.xx + d.yy > 0.0)) {
            return false;
        }
    }
    return true;
}

rlf_result rlf_camera_check(const rlf_camera *camera, const char *who)
{
    if (!RLF_ASSERT(camera != NULL && who != NULL)) {
        return RLF_ERROR_INVALID;
    }
    if (camera->width < 1 || camera->height < 1 || camera->width > RLF_IMAGE_SIZE_MAX ||
        camera->height > RLF_IMAGE_SIZE_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: width x height is %d x %d; use 1 to %d", who,
                        (int)camera->width, (int)camera->height, RLF_IMAGE_SIZE_MAX);
    }
    const double focal[2] = {camera->fx, camera->fy};
    const double centre[2] = {camera->cx, camera->cy};
    for (int i = 0; i < 2; i++) {
        if (!rlf_is_finite(focal[i]) || !(focal[i] > 0.0)) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: %s is %g; use the focal length in pixels, > 0",
                            who, i == 0 ? "fx" : "fy", focal[i]);
        }
        if (!rlf_is_finite(centre[i])) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: %s is not a finite number; use the principal point in pixels", who,
                            i == 0 ? "cx" : "cy");
        }
    }
    for (int i = 0; i < 8; i++) {
        if (!rlf_is_finite(camera->distortion[i])) {
            return rlf_fail(RLF_ERROR_INVALID, "%s: distortion[%d] is not a finite number", who, i);
        }
    }
    if ((int)camera->distortion_model < 0 ||
        camera->distortion_model > RLF_DISTORTION_RATIONAL_POLYNOMIAL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: distortion_model is %d; use 0 to %d", who,
                        (int)camera->distortion_model, RLF_DISTORTION_RATIONAL_POLYNOMIAL);
    }
    return RLF_OK;
}

bool rlf_camera_project(const rlf_camera *camera, rlf_vec3 p, double *out_u, double *out_v)
{
    if (!RLF_ASSERT(camera != NULL && out_u != NULL && out_v != NULL) || !(p.z > 0.0)) {
        return false;
    }
    double x = p.x / p.z;
    double y = p.y / p.z;
    if (camera->distortion_model != RLF_DISTORTION_NONE) {
        if (!is_inside_model(camera->distortion, x, y)) {
            return false;
        }
        distorted d = distort(camera->distortion, x, y);
        x = d.x;
        y = d.y;
    }
    *out_u = camera->fx * x + camera->cx;
    *out_v = camera->fy * y + camera->cy;
    return true;
}

bool rlf_camera_unproject(const rlf_camera *camera, double u, double v, rlf_vec3 *out_ray)
{
    if (!RLF_ASSERT(camera != NULL && out_ray != NULL)) {
        return false;
    }
    double xd = (u - camera->cx) / camera->fx;
    double yd = (v - camera->cy) / camera->fy;
    *out_ray = rlf_vec3_make(xd, yd, 1.0);
    if (camera->distortion_model == RLF_DISTORTION_NONE) {
        return true;
    }
    double tolerance = 1e-9 / rlf_max(camera->fx, camera->fy);
    for (int iteration = 0; iteration < 50; iteration++) {
        distorted d = distort(camera->distortion, out_ray->x, out_ray->y);
        double ex = d.x - xd;
        double ey = d.y - yd;
        if (ex * ex + ey * ey < tolerance * tolerance) {
            return is_inside_model(camera->distortion, out_ray->x, out_ray->y);
        }
        double det = d.xx * d.yy - d.xy * d.yx;
        if (!(det > 1e-6)) {
            return false;
        }
        out_ray->x -= (d.yy * ex - d.xy * ey) / det;
        out_ray->y -= (d.xx * ey - d.yx * ex) / det;
        if (!rlf_vec3_is_finite(*out_ray)) {
            *out_ray = rlf_vec3_make(xd, yd, 1.0);
            return false;
        }
    }
    return false;
}

rlf_camera rlf_camera_decimate(const rlf_camera *camera, int32_t factor)
{
    if (!RLF_ASSERT(camera != NULL && factor >= 1)) {
        return (rlf_camera){.width = 0};
    }
    rlf_camera r = *camera;
    r.width = (camera->width - 1) / factor + 1;
    r.height = (camera->height - 1) / factor + 1;
    r.fx /= factor;
    r.fy /= factor;
    r.cx /= factor;
    r.cy /= factor;
    return r;
}

rlf_camera rlf_camera_resize(const rlf_camera *camera, int32_t width, int32_t height)
{
    if (!RLF_ASSERT(camera != NULL && camera->width >= 1 && camera->height >= 1)) {
        return (rlf_camera){.width = 0};
    }
    rlf_camera r = *camera;
    double sx = (double)width / camera->width;
    double sy = (double)height / camera->height;
    r.width = width;
    r.height = height;
    r.fx *= sx;
    r.fy *= sy;
    r.cx = (camera->cx + 0.5) * sx - 0.5;
    r.cy = (camera->cy + 0.5) * sy - 0.5;
    return r;
}

rlf_mat4 rlf_camera_projection(const rlf_camera *camera, double near_z, double far_z)
{
    if (!RLF_ASSERT(camera != NULL)) {
        return (rlf_mat4){{{0}}};
    }
    /* Pixel u spans clip x = 2 (u + 0.5) / width - 1, because pixel centres are integers. */
    double w = camera->width;
    double h = camera->height;
    double depth = far_z - near_z;
    rlf_mat4 r = {{{2.0 * camera->fx / w, 0, 2.0 * (camera->cx + 0.5) / w - 1.0, 0},
                   {0, -2.0 * camera->fy / h, 1.0 - 2.0 * (camera->cy + 0.5) / h, 0},
                   {0, 0, (far_z + near_z) / depth, -2.0 * far_z * near_z / depth},
                   {0, 0, 1, 0}}};
    return r;
}

rlf_mat4 rlf_projection_from_fov(double fov_y, double aspect, double near_z, double far_z)
{
    double t = rlf_sin(0.5 * fov_y) / rlf_cos(0.5 * fov_y);
    double depth = far_z - near_z;
    rlf_mat4 r = {{{1.0 / (aspect * t), 0, 0, 0},
                   {0, 1.0 / t, 0, 0},
                   {0, 0, -(far_z + near_z) / depth, -2.0 * far_z * near_z / depth},
                   {0, 0, -1, 0}}};
    return r;
}

void camera_fill_rays(const rlf_camera *camera, float *ray_x, float *ray_y)
{
    for (int32_t i = 0; i < camera->width * camera->height; i++) {
        rlf_vec3 ray;
        const bool has_ray =
            rlf_camera_unproject(camera, i % camera->width, i / camera->width, &ray);
        ray_x[i] = has_ray ? (float)ray.x : 0.0f;
        ray_y[i] = has_ray ? (float)ray.y : 0.0f;
    }
}
