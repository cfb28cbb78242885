/* A copy of the surface whose planes are partly the simulator's. */
#include "eval/oracle.h"

#include "relief/base.h"

#include <string.h>

enum {
    DEPTH,
    THICKNESS,
    NORMAL,
    VELOCITY = NORMAL + 3,
    BACK = VELOCITY + 3,
    BACK_NORMAL,
    PLANES = BACK_NORMAL + 3
};

struct eval_oracle {
    rlf_source *source;
    int32_t parts, pixels;
    float *planes; /* PLANES of them */
    uint8_t *foreground, *reason;
    rlf_surface surface;
};

bool eval_oracle_parse(const char *text, void *out_parts)
{
    static const char *const names[] = {"velocity",   "thickness", "depth", "normals",
                                        "background", "camera",    "pixels"};
    const bool is_all = strcmp(text, "all") == 0;
    int32_t parts = is_all ? EVAL_ORACLE_SURFACE : 0;
    while (!is_all && *text != '\0') {
        size_t length = strcspn(text, ",");
        int32_t part = 0;
        for (int32_t i = 0; i < 7; i++) {
            bool is_it = strlen(names[i]) == length && strncmp(text, names[i], length) == 0;
            part = is_it ? 1 << i : part;
        }
        if (part == 0) {
            return false;
        }
        parts |= part;
        text += length + (text[length] == ',');
    }
    *(int32_t *)out_parts = parts;
    return parts != 0;
}

rlf_result eval_oracle_create(rlf_source *source, int32_t parts, eval_oracle **out)
{
    const rlf_camera *camera = &rlf_source_get_info(source)->rig.depth;
    eval_oracle *o = rlf_alloc(sizeof(*o));
    *out = o;
    if (o == NULL) {
        return RLF_ERROR_MEMORY;
    }
    o->source = source;
    o->parts = parts;
    o->pixels = camera->width * camera->height;
    o->planes = rlf_alloc_array((size_t)o->pixels * PLANES, sizeof(float));
    o->foreground = rlf_alloc_array((size_t)o->pixels, 1);
    o->reason = rlf_alloc_array((size_t)o->pixels, 1);
    if (o->planes == NULL || o->foreground == NULL || o->reason == NULL) {
        eval_oracle_destroy(out);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

void eval_oracle_destroy(eval_oracle **oracle)
{
    eval_oracle *o = *oracle;
    *oracle = NULL;
    if (o != NULL) {
        rlf_free(o->planes);
        rlf_free(o->foreground);
        rlf_free(o->reason);
        rlf_free(o);
    }
}

static float *plane_of(const eval_oracle *o, int32_t plane)
{
    return o->planes + (ptrdiff_t)plane * o->pixels;
}

/* Every scale_factor-th pixel of a plane of the truth; where `only` is given and 0, the sensed one.
 */
static const float *take(const eval_oracle *o, int32_t plane, const float *truth,
                         const uint8_t *only, const float *sensed)
{
    const rlf_surface *s = &o->surface;
    int32_t width = rlf_source_get_info(o->source)->rig.depth.width;
    float *out = plane_of(o, plane);
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x, t = (y * width + x) * s->scale_factor;
            out[i] = only == NULL || only[t] != 0 ? truth[t] : sensed[i];
        }
    }
    return out;
}

static void take_depth(eval_oracle *o, const rlf_truth *truth)
{
    rlf_surface *s = &o->surface;
    int32_t width = rlf_source_get_info(o->source)->rig.depth.width;
    s->depth = take(o, DEPTH, truth->depth, NULL, NULL);
    s->foreground_count = s->valid_count = 0;
    for (int32_t y = 0; y < s->height; y++) {
        for (int32_t x = 0; x < s->width; x++) {
            int32_t i = y * s->width + x, t = (y * width + x) * s->scale_factor;
            o->foreground[i] = truth->foreground[t];
            o->reason[i] = s->depth[i] > 0.0f ? RLF_REASON_OK : RLF_REASON_NO_RETURN;
            s->foreground_count += truth->foreground[t] != 0;
            s->valid_count += s->depth[i] > 0.0f;
        }
    }
    s->foreground = o->foreground;
    s->reason = o->reason;
}

/* The normals of what the foreground hides are asked for where the background is another than
 * before. */
static void take_background(eval_oracle *o, const rlf_truth *truth)
{
    rlf_surface *s = &o->surface;
    int32_t width = rlf_source_get_info(o->source)->rig.depth.width;
    float *depth = plane_of(o, BACK), *normal[3];
    for (int32_t k = 0; k < 3; k++) {
        normal[k] = plane_of(o, BACK_NORMAL + k);
    }
    for (int32_t i = 0; i < s->width * s->height; i++) {
        int32_t t = (i / s->width * width + i % s->width) * s->scale_factor;
        float z = truth->background_depth[t];
        if (z == depth[i]) {
            continue;
        }
        rlf_vec3 n = {0, 0, 0}, p = {z * s->ray_x[i], z * s->ray_y[i], z};
        double distance;
        int32_t label;
        (void)rlf_synthetic_distance(o->source, p, &distance, &n, &label);
        depth[i] = z;
        normal[0][i] = (float)n.x;
        normal[1][i] = (float)n.y;
        normal[2][i] = (float)n.z;
    }
    s->background_version = 0; /* these planes change by themselves */
    s->background_depth = depth;
    s->background_normal_x = normal[0];
    s->background_normal_y = normal[1];
    s->background_normal_z = normal[2];
}

const rlf_surface *eval_oracle_replace(void *oracle, const rlf_surface *sensed)
{
    eval_oracle *o = oracle;
    rlf_surface *s = &o->surface;
    const rlf_truth *truth = rlf_source_get_truth(o->source);
    if (truth == NULL) {
        return NULL;
    }
    *s = *sensed;
    const uint8_t *moves = truth->foreground;
    if ((o->parts & EVAL_ORACLE_VELOCITY) != 0) {
        s->velocity_x = take(o, VELOCITY, truth->velocity_x, moves, s->velocity_x);
        s->velocity_y = take(o, VELOCITY + 1, truth->velocity_y, moves, s->velocity_y);
        s->velocity_z = take(o, VELOCITY + 2, truth->velocity_z, moves, s->velocity_z);
    }
    if ((o->parts & EVAL_ORACLE_THICKNESS) != 0) {
        s->thickness = take(o, THICKNESS, truth->thickness, moves, s->thickness);
    }
    if ((o->parts & EVAL_ORACLE_NORMALS) != 0) {
        s->normal_x = take(o, NORMAL, truth->normal_x, NULL, NULL);
        s->normal_y = take(o, NORMAL + 1, truth->normal_y, NULL, NULL);
        s->normal_z = take(o, NORMAL + 2, truth->normal_z, NULL, NULL);
    }
    if ((o->parts & EVAL_ORACLE_DEPTH) != 0) {
        take_depth(o, truth);
    }
    if ((o->parts & EVAL_ORACLE_BACKGROUND) != 0) {
        take_background(o, truth);
    }
    return s;
}
