/* What rays meet of a model. */
#include "known/mesh.h"

#include "relief/model.h"

known_form known_form_make(const rlf_body_state *body, const known_mesh *mesh,
                           const rlf_pose *T_camera_body)
{
    known_form form = {.shape = &body->shape,
                       .mesh = mesh,
                       .origin = rlf_transform_inverse(T_camera_body, rlf_vec3_make(0, 0, 0)),
                       .to_body = rlf_quat_conjugate(T_camera_body->q),
                       .per_scale = 1.0};
    if (mesh != NULL) {
        form.per_scale = 1.0 / body->look.scale;
        form.origin = rlf_scale(rlf_sub(form.origin, body->look.offset), form.per_scale);
    }
    return form;
}

double known_form_radius(const rlf_body_state *body)
{
    const rlf_look *look = &body->look;
    return look->model != NULL ? look->scale * look->model->radius + rlf_length(look->offset)
                               : rlf_shape_radius(&body->shape);
}

bool known_form_cast(const known_form *form, const rlf_camera *camera, double u, double v,
                     rlf_vec3 *out_ray, double out_z[2])
{
    if (!rlf_camera_unproject(camera, u, v, out_ray)) {
        return false;
    }
    rlf_vec3 d = rlf_scale(rlf_rotate(form->to_body, *out_ray), form->per_scale);
    bool is_hit = form->mesh != NULL
                      ? known_mesh_cast(form->mesh, form->origin, d, &out_z[0], &out_z[1])
                      : rlf_shape_cast(form->shape, form->origin, d, &out_z[0], &out_z[1]);
    return is_hit && out_z[0] > KNOWN_NEAREST_Z;
}
