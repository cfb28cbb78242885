/* Prepares the movers for a view: the pixels they can cover and the coordinates they are cast in.
 */
#include "sim/stamp.h"

#define NEAREST 0.05 /* metres; a solid that comes nearer may cover every pixel */

/* Smallest and largest image coordinate of one axis. */
typedef struct span {
    double low, high;
} span;

static void widen(span *s, double value)
{
    s->low = rlf_min(s->low, value);
    s->high = rlf_max(s->high, value);
}

/* Outline of an ellipsoid with matrix M = R diag(radii^2) R^T about c: its dual quadric M - c c^T
 * projects to a dual conic, whose tangents x = const are the roots of C22 x^2 - 2 C02 x + C00
 * (Hartley and Zisserman 2004, section 8.3). */
static void add_ellipsoid(const rlf_mat3 *M, rlf_vec3 c, span spans[2])
{
    double c22 = M->m[2][2] - c.z * c.z;
    if (!(c.z > 0.0) || !(c22 < 0.0) || c.z - sqrt(M->m[2][2]) < NEAREST) {
        widen(&spans[0], -1e6);
        widen(&spans[0], 1e6);
        widen(&spans[1], -1e6);
        widen(&spans[1], 1e6);
        return;
    }
    const double centre[2] = {c.x, c.y};
    for (int k = 0; k < 2; k++) {
        double c02 = M->m[k][2] - centre[k] * c.z;
        double c00 = M->m[k][k] - centre[k] * centre[k];
        double root = sqrt(rlf_max(0.0, c02 * c02 - c00 * c22));
        widen(&spans[k], (c02 + root) / c22);
        widen(&spans[k], (c02 - root) / c22);
    }
}

static void add_sphere(rlf_vec3 c, double radius, span spans[2])
{
    rlf_mat3 M = rlf_mat3_diagonal(radius * radius, radius * radius, radius * radius);
    add_ellipsoid(&M, c, spans);
}

/* An ellipsoid about the middle of T; one radius may be 0. */
static void add_radii(const rlf_pose *T, rlf_vec3 radii, span spans[2])
{
    rlf_mat3 R = rlf_quat_to_mat3(T->q);
    rlf_mat3 D = rlf_mat3_diagonal(radii.x * radii.x, radii.y * radii.y, radii.z * radii.z);
    rlf_mat3 R_t = rlf_mat3_transpose(&R);
    rlf_mat3 RD = rlf_mat3_mul(&R, &D);
    rlf_mat3 M = rlf_mat3_mul(&RD, &R_t);
    add_ellipsoid(&M, T->p, spans);
}

/* `T` maps the shape into the view's camera frame. */
static void outline(const synth_shape *shape, const rlf_pose *T, span spans[2])
{
    spans[0] = (span){1e9, -1e9};
    spans[1] = (span){1e9, -1e9};
    if (shape->type == SYNTH_CONE) {
        add_sphere(T->p, shape->radius_a, spans);
        add_sphere(rlf_transform(T, rlf_vec3_make(0, shape->length, 0)), shape->radius_b, spans);
        return;
    }
    if (shape->type == SYNTH_BOX) {
        for (int i = 0; i < 8; i++) {
            rlf_vec3 corner = rlf_vec3_make((i & 1) != 0 ? shape->size.x : -shape->size.x,
                                            (i & 2) != 0 ? shape->size.y : -shape->size.y,
                                            (i & 4) != 0 ? shape->size.z : -shape->size.z);
            add_sphere(rlf_transform(T, corner), 1e-4, spans);
        }
        return;
    }
    if (shape->type == SYNTH_FRUSTUM) {
        rlf_pose end = {rlf_transform(T, rlf_vec3_make(0, shape->length, 0)), T->q};
        add_radii(T, rlf_vec3_make(shape->radius_a, 0, shape->radius_a), spans);
        add_radii(&end, rlf_vec3_make(shape->radius_b, 0, shape->radius_b), spans);
        return;
    }
    add_radii(T, shape->size, spans);
}

static int32_t to_pixel(double x, int32_t size)
{
    return (int32_t)rlf_clamp(x, 0.0, (double)size);
}

static synth_rect rect_of(const span spans[2], const rlf_camera *camera)
{
    synth_rect rect;
    rect.x0 = to_pixel(spans[0].low * camera->fx + camera->cx, camera->width);
    rect.x1 = to_pixel(spans[0].high * camera->fx + camera->cx + 1.0, camera->width);
    rect.y0 = to_pixel(spans[1].low * camera->fy + camera->cy, camera->height);
    rect.y1 = to_pixel(spans[1].high * camera->fy + camera->cy + 1.0, camera->height);
    return rect;
}

static void place(synth_stamp *stamp, const synth_shape *shape, const synth_view *view)
{
    rlf_pose T = shape->T_camera_shape;
    T.p = rlf_sub(T.p, view->origin);
    span spans[2];
    rlf_vec3 centre;
    const double reach = synth_shape_bound(shape, &centre);
    const bool is_behind = centre.z - view->origin.z + reach < NEAREST;
    stamp->type = shape->type;
    stamp->rect = (synth_rect){0, 0, 0, 0};
    if (!is_behind) {
        outline(shape, &T, spans);
        stamp->rect = rect_of(spans, &view->camera);
    }
    stamp->z0 = T.p.z;
    const double half[3] = {shape->size.x, shape->size.y, shape->size.z};
    const double p[3] = {T.p.x, T.p.y, T.p.z};
    rlf_mat3 R = rlf_quat_to_mat3(T.q);
    for (int k = 0; k < 3; k++) {
        double scale = shape->type == SYNTH_ELLIPSOID ? 1.0 / half[k] : 1.0;
        stamp->half[k] = (float)half[k];
        stamp->offset[k] = 0.0;
        for (int j = 0; j < 3; j++) {
            stamp->A[k][j] = scale * R.m[j][k];
            stamp->offset[k] += stamp->A[k][j] * p[j];
        }
    }
    if (shape->type == SYNTH_CONE || shape->type == SYNTH_FRUSTUM) {
        double sine = (shape->radius_a - shape->radius_b) / shape->length;
        stamp->sine = (float)(shape->type == SYNTH_FRUSTUM ? -sine : sine);
        stamp->cosine2 = (float)(1.0 - sine * sine);
        stamp->length = (float)shape->length;
        stamp->radius_a = (float)shape->radius_a;
        stamp->radius_b = (float)shape->radius_b;
    }
}

void synth_canvas_place(synth_canvas *canvas, const synth_scene *scene)
{
    canvas->stamp_count = scene->mover_count;
    canvas->drawn = (synth_rect){0, 0, 0, 0};
    for (int32_t i = 0; i < scene->mover_count; i++) {
        place(&canvas->stamps[i], &scene->movers[i].shape, &canvas->view);
        canvas->drawn = synth_rect_union(canvas->drawn, canvas->stamps[i].rect);
    }
}

rlf_result synth_canvas_create(synth_canvas *canvas, const synth_view *view)
{
    size_t count = (size_t)view->camera.width * (size_t)view->camera.height;
    *canvas = (synth_canvas){.view = *view};
    canvas->z = rlf_alloc_array(count, sizeof(*canvas->z));
    canvas->part = rlf_alloc_array(count, sizeof(*canvas->part));
    if (canvas->z == NULL || canvas->part == NULL) {
        synth_canvas_destroy(canvas);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

void synth_canvas_destroy(synth_canvas *canvas)
{
    rlf_free(canvas->z);
    rlf_free(canvas->part);
    *canvas = (synth_canvas){.z = NULL};
}
