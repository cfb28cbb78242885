/* Models of real things as wireframes over the camera's picture. */
#include "render/soft/views.h"

#include "render/body_texture.h"
#include "render/soft/draw.h"
#include "render/soft/soft.h"

#define CIRCLE 32 /* corners */

typedef struct wire {
    soft *s;
    rlf_pose T_picture_shape;
    soft_color color;
} wire;

static bool place(const wire *w, rlf_vec3 p, soft_point *out)
{
    rlf_vec3 q = rlf_transform(&w->T_picture_shape, p);
    return q.z > SOFT_NEAR_Z && rlf_camera_project(&w->s->camera, q, &out->x, &out->y);
}

static void draw_edge(const wire *w, rlf_vec3 from, rlf_vec3 to)
{
    soft_point a, b;
    if (place(w, from, &a) && place(w, to, &b)) {
        soft_draw_line(&w->s->image, a, b, w->color);
    }
}

static void draw_box(const wire *w, rlf_vec3 half)
{
    for (int i = 0; i < 8; i++) {
        rlf_vec3 corner =
            rlf_vec3_make((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                          (i & 4) != 0 ? half.z : -half.z);
        if ((i & 1) == 0) {
            draw_edge(w, corner, rlf_vec3_make(half.x, corner.y, corner.z));
        }
        if ((i & 2) == 0) {
            draw_edge(w, corner, rlf_vec3_make(corner.x, half.y, corner.z));
        }
        if ((i & 4) == 0) {
            draw_edge(w, corner, rlf_vec3_make(corner.x, corner.y, half.z));
        }
    }
}

/* An arc in the plane of the axes `a` and `b`, both as long as the radius. */
static void draw_arc(const wire *w, rlf_vec3 center, rlf_vec3 a, rlf_vec3 b, double turn)
{
    rlf_vec3 last = rlf_add(center, a);
    for (int i = 1; i <= CIRCLE; i++) {
        double angle = turn * i / CIRCLE;
        rlf_vec3 next = rlf_mad(rlf_mad(center, a, rlf_cos(angle)), b, rlf_sin(angle));
        draw_edge(w, last, next);
        last = next;
    }
}

/* Ball, capsule (capped) and cylinder stand along y. */
static void draw_round(const wire *w, double radius, double half_height, bool is_capped)
{
    const rlf_vec3 x = {radius, 0, 0}, y = {0, radius, 0}, z = {0, 0, radius};
    for (int i = -1; i <= 1; i += 2) {
        rlf_vec3 center = rlf_vec3_make(0, i * half_height, 0);
        draw_arc(w, center, x, z, 2.0 * RLF_PI);
        if (is_capped) {
            draw_arc(w, center, x, rlf_scale(y, i), RLF_PI);
            draw_arc(w, center, z, rlf_scale(y, i), RLF_PI);
        }
        rlf_vec3 up = rlf_vec3_make(0, half_height, 0);
        draw_edge(w, rlf_sub(rlf_scale(x, i), up), rlf_add(rlf_scale(x, i), up));
        draw_edge(w, rlf_sub(rlf_scale(z, i), up), rlf_add(rlf_scale(z, i), up));
    }
}

static void draw_hull(const wire *w, const rlf_hull *hull)
{
    for (int32_t i = 0; hull != NULL && i < 3 * hull->triangle_count; i++) {
        int32_t from = hull->triangles[i];
        int32_t to = hull->triangles[i % 3 == 2 ? i - 2 : i + 1];
        if (from < to) { /* the triangle beside it has the same edge, the other way round */
            draw_edge(w, hull->vertices[from], hull->vertices[to]);
        }
    }
}

static void draw_triangles(const wire *w, const rlf_look *look)
{
    for (int32_t i = 0; i < look->model->triangle_count; i++) {
        const int32_t *corner = look->model->triangles + 3 * (ptrdiff_t)i;
        rlf_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = body_look_point(look, &look->model->vertices[corner[k]]);
        }
        for (int k = 0; k < 3; k++) {
            draw_edge(w, p[k], p[(k + 1) % 3]);
        }
    }
}

static void draw_shape(const wire *w, const rlf_shape *shape)
{
    switch (shape->type) {
    case RLF_SHAPE_BOX: draw_box(w, rlf_scale(shape->size, 0.5)); break;
    case RLF_SHAPE_SPHERE: draw_round(w, shape->radius, 0.0, true); break;
    case RLF_SHAPE_CAPSULE: draw_round(w, shape->radius, 0.5 * shape->height, true); break;
    case RLF_SHAPE_CYLINDER: draw_round(w, shape->radius, 0.5 * shape->height, false); break;
    case RLF_SHAPE_HULL: draw_hull(w, shape->hull); break;
    }
}

void soft_draw_known(soft *s, const rlf_render_input *input)
{
    rlf_pose T_camera_world = rlf_pose_invert(&input->T_world_camera);
    rlf_pose T_picture_world = rlf_pose_mul(&s->T_picture_depth, &T_camera_world);
    for (int32_t i = 0; input->snapshot != NULL && i < input->snapshot->known_count; i++) {
        const rlf_body_state *model = &input->snapshot->known[i];
        wire w = {s, rlf_pose_mul(&T_picture_world, &model->T_world_body), soft_color_known()};
        if (model->look.model != NULL) {
            draw_triangles(&w, &model->look);
        } else {
            draw_shape(&w, &model->shape);
        }
    }
}
