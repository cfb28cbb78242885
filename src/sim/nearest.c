/* What of the true scene is nearest to a point. */
#include "sim/sensor.h"

#include <stddef.h>

static void find(const synth_scene *scene, double time, rlf_vec3 p, rlf_synthetic_hit *out)
{
    double to_mover;
    rlf_vec3 mover_normal;
    const synth_part *part = synth_nearest(scene->statics, synth_scene_static_count(scene, time), p,
                                           &out->distance, &out->normal);
    const synth_part *mover =
        synth_nearest(scene->movers, scene->mover_count, p, &to_mover, &mover_normal);
    if (mover != NULL && to_mover < out->distance) {
        part = mover;
        out->distance = to_mover;
        out->normal = mover_normal;
    }
    out->label = part->label;
    out->velocity = synth_part_velocity(part, rlf_mad(p, out->normal, -out->distance));
}

static rlf_result fail_other(const rlf_source *source)
{
    return rlf_fail(RLF_ERROR_INVALID, "%s: not a synthetic source, so its truth is unknown",
                    rlf_source_get_info(source)->name);
}

rlf_result rlf_synthetic_distance(rlf_source *source, rlf_vec3 p, double *out_distance,
                                  rlf_vec3 *out_normal, int32_t *out_label)
{
    if (!RLF_ASSERT(source != NULL && out_distance != NULL)) {
        return RLF_ERROR_INVALID;
    }
    const synth_sensor *sensor = synth_sensor_of(source);
    if (sensor == NULL) {
        return fail_other(source);
    }
    rlf_synthetic_hit hit;
    find(&sensor->scene, sensor->time, p, &hit);
    *out_distance = hit.distance;
    if (out_normal != NULL) {
        *out_normal = hit.normal;
    }
    if (out_label != NULL) {
        *out_label = hit.label;
    }
    return RLF_OK;
}

rlf_result rlf_synthetic_nearest(rlf_source *source, double time_s, rlf_vec3 p,
                                 rlf_synthetic_hit *out)
{
    if (!RLF_ASSERT(source != NULL && out != NULL && time_s >= 0.0)) {
        return RLF_ERROR_INVALID;
    }
    synth_sensor *sensor = synth_sensor_of(source);
    if (sensor == NULL) {
        return fail_other(source);
    }
    if (time_s != sensor->asked_time) {
        sensor->asked_time = time_s;
        synth_sensor_see(sensor, time_s, &sensor->asked);
    }
    find(&sensor->asked, time_s, p, out);
    return RLF_OK;
}
