/* What rays meet of a model: its triangles or, without any, its convex shape. */
#ifndef RLF_KNOWN_FORM_H
#define RLF_KNOWN_FORM_H

#include "known/mesh.h"
#include "relief/camera.h"
#include "relief/snapshot.h"

#define KNOWN_NEAREST_Z 0.02 /* metres: what reaches nearer to a camera is not seen */

/* A model where a camera sees it. */
typedef struct known_form {
    const rlf_shape *shape;
    const known_mesh *mesh; /* NULL = the shape */
    rlf_vec3 origin;        /* the camera, in the frame of either */
    rlf_quat to_body;
    double per_scale; /* from metres to the mesh's unit */
} known_form;

/* `mesh`, of the body's look, may be NULL and is borrowed like the body. */
known_form known_form_make(const rlf_body_state *body, const known_mesh *mesh,
                           const rlf_pose *T_camera_body);
/* Largest distance from the body's origin to what rays meet. */
double known_form_radius(const rlf_body_state *body);
/* Depths at which the ray through pixel (u, v) enters and leaves. */
bool known_form_cast(const known_form *form, const rlf_camera *camera, double u, double v,
                     rlf_vec3 *out_ray, double out_z[2]);

#endif
