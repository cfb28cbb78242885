/* A model's triangles in a tree of boxes, for rays. */
#ifndef RLF_KNOWN_MESH_H
#define RLF_KNOWN_MESH_H

#include "relief/camera.h"
#include "relief/model.h"
#include "relief/snapshot.h"

typedef struct known_mesh known_mesh;

/* Copies what it needs of the model. Allocates. */
rlf_result known_mesh_create(const rlf_model *model, known_mesh **out);
void known_mesh_destroy(known_mesh **mesh);
/* rlf_model's id. */
uint64_t known_mesh_id(const known_mesh *mesh);
/* Nearest and farthest t > 0 at which origin + t direction (the model's frame; the direction need
 * not be of unit length) meets a triangle, from whichever side; the same where it meets only one.
 * False when it meets none. Moeller and Trumbore 1997. */
bool known_mesh_cast(const known_mesh *mesh, rlf_vec3 origin, rlf_vec3 direction, double *out_enter,
                     double *out_leave);

/* ---- form.c: what rays meet of a model: its triangles or, without any, its convex shape. */

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
