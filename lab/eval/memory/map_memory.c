/* The moving camera's way to a background, with a pose that never changes and a residual. */
#include "eval/memory/map_memory.h"

#include <math.h>
#include <string.h>

enum {
    KNOWN = 3,       /* samples of a residual that is used, ... */
    SETTLED = 16,    /* ... that says nothing new any more, ... */
    MEMORY = 32,     /* ... and that are remembered */
    NEWS_SHARE = 500 /* of the picture one of so many parts is new: it is fused */
};

#define LEAST_M 0.02

rlf_result map_memory_open(const rlf_rig *rig, bool has_residual, map_memory *out)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = *rig;
    *out = (map_memory){.camera = rig->depth,
                        .count = rig->depth.width * rig->depth.height,
                        .has_residual = has_residual};
    const size_t n = (size_t)out->count;
    float **const planes[3] = {&out->given, &out->predicted, &out->residual};
    bool has_all = true;
    for (int k = 0; k < 3; k++) {
        *planes[k] = rlf_alloc_array(n, sizeof(float));
        has_all = has_all && *planes[k] != NULL;
    }
    out->samples = rlf_alloc(n);
    out->is_static = rlf_alloc(n);
    rlf_result result = RLF_ERROR_MEMORY;
    if (has_all && out->samples != NULL && out->is_static != NULL) {
        result = rlf_map_create(&def, &out->map);
    }
    if (result != RLF_OK) {
        map_memory_close(out);
    }
    return result;
}

void map_memory_close(map_memory *m)
{
    rlf_map_destroy(&m->map);
    rlf_free(m->given);
    rlf_free(m->predicted);
    rlf_free(m->residual);
    rlf_free(m->samples);
    rlf_free(m->is_static);
    *m = (map_memory){.map = NULL};
}

/* What a pixel has seen beside the prediction lasts while that stays where it was. */
static void keep_residuals(map_memory *m)
{
    const double step = rlf_map_get_status(m->map).voxel_m;
    for (int32_t i = 0; i < m->count; i++) {
        const float z = m->prediction.depth[i];
        const bool has_moved = fabs((double)(z - m->predicted[i])) > step;
        m->samples[i] = has_moved ? 0 : m->samples[i];
        m->predicted[i] = z;
        m->given[i] = z > 0.0f && m->samples[i] >= KNOWN ? z + m->residual[i] : z;
    }
}

static bool give(void *context, const rlf_surface *seen, rlf_given_background *out)
{
    map_memory *m = context;
    const rlf_pose still = rlf_pose_identity();
    (void)seen;
    const bool is_old = !m->has_prediction || m->is_changed;
    if (is_old && rlf_map_predict(m->map, &m->camera, &still, &m->prediction) != RLF_OK) {
        return false;
    }
    m->has_prediction = true;
    keep_residuals(m);
    *out = (rlf_given_background){.depth = m->given,
                                  .normal_x = m->prediction.normal_x,
                                  .normal_y = m->prediction.normal_y,
                                  .normal_z = m->prediction.normal_z,
                                  .slack_m = m->has_residual ? 0.0 : rlf_map_truncation(m->map),
                                  .T_now_before = still,
                                  .has_before = true};
    return true;
}

void map_memory_use(map_memory *m, rlf_reconstruct_def *def)
{
    def->background_method = RLF_BACKGROUND_GIVEN;
    def->background_segment = RLF_SEGMENT_OFF;
    def->give_background = give;
    def->give_context = m;
}

static void learn(map_memory *m, const rlf_surface *s, int32_t i)
{
    const float off = s->depth[i] - m->predicted[i] - m->residual[i];
    const bool is_new = m->samples[i] == 0;
    const int32_t samples = m->samples[i] < MEMORY ? m->samples[i] + 1 : MEMORY;
    const float part = 1.0f / (float)samples;
    m->residual[i] = is_new ? s->depth[i] - m->predicted[i] : m->residual[i] + part * off;
    m->samples[i] = (uint8_t)samples;
}

/* What is known well and seen again as it is tells the map nothing new. */
static bool is_news(map_memory *m, const rlf_surface *s, int32_t i)
{
    const double z = (double)s->depth[i], sigmas = 6.0 * rlf_depth_noise_sigma(&s->noise, z);
    const double gate = sigmas > LEAST_M ? sigmas : LEAST_M;
    const bool is_known = m->has_prediction && m->predicted[i] > 0.0f;
    const double off = is_known ? fabs(z - (double)m->predicted[i]) : 0.0;
    if (!m->has_residual || off > gate + rlf_map_truncation(m->map)) {
        return true;
    }
    learn(m, s, i);
    return m->samples[i] < SETTLED; /* a map shows nothing of some edges, however often seen */
}

rlf_result map_memory_fuse(map_memory *m, const rlf_surface *s)
{
    const rlf_map_view view = {.depth = s->depth,
                               .normal_x = s->normal_x,
                               .normal_y = s->normal_y,
                               .normal_z = s->normal_z,
                               .is_static = m->is_static};
    const rlf_pose still = rlf_pose_identity();
    int32_t news = 0;
    for (int32_t i = 0; i < m->count; i++) {
        const bool is_seen = s->reason[i] == RLF_REASON_OK && s->foreground[i] == 0;
        m->is_static[i] = is_seen && is_news(m, s, i);
        news += m->is_static[i];
    }
    m->is_changed = news > m->count / NEWS_SHARE;
    return m->is_changed ? rlf_map_integrate(m->map, &view, &still, NULL) : RLF_OK;
}
