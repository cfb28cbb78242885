/* Poses in the order of time. */
#include "trajectory.h"

#include "relief/known.h"

#include <string.h>

static bool grow(trajectory *t)
{
    const int32_t room = t->room > 0 ? 2 * t->room : 1024;
    int64_t *time_ns = rlf_alloc_array((size_t)room, sizeof(*time_ns));
    rlf_pose *found = rlf_alloc_array((size_t)room, sizeof(*found));
    rlf_vec3 *truth = rlf_alloc_array((size_t)room, sizeof(*truth));
    if (time_ns == NULL || found == NULL || truth == NULL) {
        rlf_free(time_ns);
        rlf_free(found);
        rlf_free(truth);
        return false;
    }
    if (t->count > 0) {
        memcpy(time_ns, t->time_ns, (size_t)t->count * sizeof(*time_ns));
        memcpy(found, t->found, (size_t)t->count * sizeof(*found));
        memcpy(truth, t->truth, (size_t)t->count * sizeof(*truth));
    }
    const int32_t count = t->count;
    trajectory_free(t);
    *t = (trajectory){time_ns, found, truth, count, room};
    return true;
}

rlf_result trajectory_add(trajectory *t, int64_t time_ns, const rlf_pose *found,
                          const rlf_pose *truth)
{
    if (t->count == t->room && !grow(t)) {
        return RLF_ERROR_MEMORY;
    }
    t->time_ns[t->count] = time_ns;
    t->found[t->count] = *found;
    t->truth[t->count++] = truth != NULL ? truth->p : found->p;
    return RLF_OK;
}

double trajectory_error(const trajectory *t)
{
    rlf_vec3 *places = rlf_alloc_array((size_t)t->count + 1, sizeof(*places));
    rlf_pose T;
    double rms = -1.0;
    if (places == NULL) {
        return rms;
    }
    for (int32_t i = 0; i < t->count; i++) {
        places[i] = t->found[i].p;
    }
    if (t->count < 3 || rlf_align_points(places, t->truth, t->count, &T, &rms) != RLF_OK) {
        rms = -1.0;
    }
    rlf_free(places);
    return rms;
}

void trajectory_free(trajectory *t)
{
    rlf_free(t->time_ns);
    rlf_free(t->found);
    rlf_free(t->truth);
    *t = (trajectory){.count = 0};
}
