/* Truth along any rays: what other cameras of the sensor ought to see. */
#include "sim/sensor.h"

/* The parts that some ray of a bundle may hit. */
typedef struct bundle {
    const synth_part *parts[2 * SYNTH_PART_MAX];
    int32_t count;
} bundle;

/* Cone about all directions: its axis, and the tangent of its half angle. */
typedef struct cone {
    rlf_vec3 axis;
    double tangent;
    bool is_wide; /* a half angle of 90 degrees or more: says nothing */
} cone;

static cone cone_of(const rlf_vec3 *directions, int32_t count)
{
    rlf_vec3 sum = {0, 0, 0};
    for (int32_t i = 0; i < count; i++) {
        sum = rlf_add(sum, rlf_normalize(directions[i]));
    }
    cone c = {rlf_normalize(sum), 0.0, false};
    for (int32_t i = 0; i < count; i++) {
        double along = rlf_dot(directions[i], c.axis);
        double aside = rlf_length(rlf_mad(directions[i], c.axis, -along));
        c.is_wide = c.is_wide || !(along > 0.0);
        c.tangent = c.is_wide ? 0.0 : rlf_max(c.tangent, aside / along);
    }
    return c;
}

/* At the far end of a part's bounding sphere the cone is widest; a part wholly outside that
 * cylinder cannot be hit. */
static void add_parts(bundle *b, const synth_part *parts, int32_t count, rlf_vec3 origin,
                      const cone *c)
{
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 centre;
        double radius = synth_shape_bound(&parts[i].shape, &centre);
        rlf_vec3 offset = rlf_sub(centre, origin);
        double along = rlf_dot(offset, c->axis);
        double aside = rlf_length(rlf_mad(offset, c->axis, -along));
        if (c->is_wide ||
            (along + radius > 0.0 && aside <= radius + c->tangent * (along + radius) + 1e-9)) {
            b->parts[b->count++] = &parts[i];
        }
    }
}

rlf_result rlf_synthetic_cast(rlf_source *source, rlf_vec3 origin, const rlf_vec3 *directions,
                              int32_t count, float *out_distance, int32_t *out_label)
{
    if (!RLF_ASSERT(source != NULL && (count <= 0 || directions != NULL)) ||
        !RLF_ASSERT(count <= 0 || out_distance != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const synth_sensor *sensor = synth_sensor_of(source);
    if (sensor == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: not a synthetic source, so its truth is unknown",
                        rlf_source_get_info(source)->name);
    }
    const synth_scene *scene = &sensor->scene;
    cone c = cone_of(directions, count);
    bundle b = {.count = 0};
    add_parts(&b, scene->statics, synth_scene_static_count(scene, sensor->time), origin, &c);
    add_parts(&b, scene->movers, scene->mover_count, origin, &c);
    for (int32_t i = 0; i < count; i++) {
        synth_ray ray = {origin, directions[i]};
        double nearest = 0.0;
        int32_t label = 0;
        for (int32_t k = 0; k < b.count; k++) {
            synth_interval hit;
            if (synth_shape_intersect(&b.parts[k]->shape, &ray, &hit) && hit.near > 0.0 &&
                (label == 0 || hit.near < nearest)) {
                nearest = hit.near;
                label = b.parts[k]->label;
            }
        }
        out_distance[i] = (float)nearest;
        if (out_label != NULL) {
            out_label[i] = label;
        }
    }
    return RLF_OK;
}

rlf_result rlf_synthetic_get_down(const rlf_source *source, rlf_vec3 *out)
{
    if (!RLF_ASSERT(source != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const synth_sensor *sensor = synth_sensor_of(source);
    if (sensor == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: not a synthetic source, so its truth is unknown",
                        rlf_source_get_info(source)->name);
    }
    *out = sensor->scene.down;
    return RLF_OK;
}
