/* A model's triangles in a tree of boxes, for rays. */
#ifndef RLF_KNOWN_MESH_H
#define RLF_KNOWN_MESH_H

#include "relief/model.h"

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

#endif
