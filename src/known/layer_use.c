/* Models in place of what is sensed of the real things. */
#include "known/layer.h"

/* Depth jumps by more than this between a thing and what is behind its rim, metres. */
#define RIM_JUMP 0.05f
/* What changes by more than this share of its depth over a rim's width has an edge there. */
#define RIM_SLOPE 0.1f
#define SLACK_M                                                                                    \
    0.2 /* a grazing ray meets what is near a model so far from where it meets the model */

/* Depth at a rim as what is farther out goes on: 1/z of a plane is linear in the picture. 0 when
 * nothing is sensed there. */
static float depth_behind(const known_rim *rim, const float *z)
{
    float a = z[rim->beyond], b = z[rim->farther];
    if (!(a > 0.0f) || !(b > 0.0f)) {
        return a;
    }
    float jump = a - b;
    float inverse = 1.0f / a + rim->steps * (1.0f / a - 1.0f / b);
    bool is_plane = jump < RIM_SLOPE * a && jump > -RIM_SLOPE * a && inverse > 0.0f;
    return is_plane ? 1.0f / inverse : a;
}

/* The sensor shows the model beside its silhouette, or mixes it with what is behind: *out_behind.
 */
static bool is_mixed(const known_rim *rim, const float *z, float *out_behind)
{
    float at = z[rim->pixel.index];
    *out_behind = depth_behind(rim, z);
    return at > rim->pixel.front && *out_behind > at + RIM_JUMP;
}

void known_layer_cover(known_layer *layer, float *z)
{
    for (int32_t i = 0; i < layer->rim_count; i++) {
        const known_rim *rim = &layer->rims[i];
        float behind;
        z[rim->pixel.index] = is_mixed(rim, z, &behind) ? behind : z[rim->pixel.index];
    }
    for (int32_t i = 0; i < layer->count; i++) {
        const known_pixel *p = &layer->pixels[i];
        float seen = z[p->index];
        bool is_before = seen > 0.0f && seen < p->front;
        if (layer->nearest[p->index] < p->near) {
            continue; /* another model is before this one */
        }
        z[p->index] = is_before ? seen : p->near;
        layer->shown[p->index] = is_before ? 0 : 1;
    }
}

void known_layer_fill(const known_layer *layer, float *z)
{
    for (int32_t i = 0; i < layer->count; i++) {
        const known_pixel *p = &layer->pixels[i];
        z[p->index] = z[p->index] > 0.0f ? z[p->index] : layer->nearest[p->index];
    }
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

/* How far a shape reaches along the unit direction n from its centre. */
static double reach_along(const rlf_shape *s, rlf_vec3 n)
{
    double most = 0.0;
    switch (s->type) {
    case RLF_SHAPE_BOX:
        return 0.5 *
               (s->size.x * absolute(n.x) + s->size.y * absolute(n.y) + s->size.z * absolute(n.z));
    case RLF_SHAPE_SPHERE: return s->radius;
    case RLF_SHAPE_CAPSULE: return s->radius + 0.5 * s->height * absolute(n.y);
    case RLF_SHAPE_CYLINDER:
        return s->radius * sqrt(n.x * n.x + n.z * n.z) + 0.5 * s->height * absolute(n.y);
    case RLF_SHAPE_HULL: break;
    }
    for (int32_t i = 0; i < s->hull->vertex_count; i++) {
        most = rlf_max(most, rlf_dot(s->hull->vertices[i], n));
    }
    return most;
}

/* A sensed point near the model, of a face as far out as the model reaches that way. On a slant
 * depth is off along the ray, but mixed pixels are off across it, and have any of its normals; the
 * floor beside it faces up, far below its top. */
static bool is_beside(const known_layer *layer, const known_pixel *p, const known_seen *seen)
{
    const rlf_body_state *model = &layer->made[p->model];
    double z = seen->depth[p->index], tolerance = p->tolerance;
    if (!(z > p->near - SLACK_M && z < p->far + SLACK_M) || seen->normal_x == NULL) {
        return false;
    }
    rlf_pose T = rlf_pose_mul(&layer->made_T, &model->T_world_body);
    rlf_vec3 point = rlf_vec3_make(z * p->ray_x, z * p->ray_y, z), gradient;
    rlf_vec3 local = rlf_transform_inverse(&T, point);
    rlf_vec3 normal =
        rlf_vec3_make(seen->normal_x[p->index], seen->normal_y[p->index], seen->normal_z[p->index]);
    normal = rlf_rotate(rlf_quat_conjugate(T.q), normal);
    return rlf_shape_distance(&model->shape, local, &gradient) < tolerance &&
           rlf_dot(normal, local) > reach_along(&model->shape, normal) - tolerance;
}

static bool is_on(const known_layer *layer, const known_pixel *p, const known_seen *seen)
{
    float z = seen->depth[p->index];
    return (z >= p->front && z <= p->far + p->tolerance) || is_beside(layer, p, seen);
}

void known_layer_clear(const known_layer *layer, const known_seen *seen, float *depth,
                       uint8_t *mask)
{
    for (int32_t i = 0; i < layer->count + layer->rim_count; i++) {
        const known_rim *rim = i >= layer->count ? &layer->rims[i - layer->count] : NULL;
        const known_pixel *p = rim != NULL ? &rim->pixel : &layer->pixels[i];
        float behind;
        bool is_model = rim != NULL
                            ? is_mixed(rim, seen->depth, &behind) || is_beside(layer, p, seen)
                            : is_on(layer, p, seen);
        if (is_model && mask != NULL) {
            mask[p->index] = 0;
        }
        if (is_model && depth != NULL) {
            depth[p->index] = 0.0f;
        }
    }
}
