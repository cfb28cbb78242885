/* Clips in memory. */
#include "eval/real/clip.h"

#include "command.h"
#include "eval/real/real.h"

#include <stdio.h>
#include <string.h>

#define FRAME_NS INT64_C(33333333) /* between passes */

void real_clip_free(real_clip *clip)
{
    rlf_free(clip->time_ns);
    rlf_free(clip->depth);
    rlf_free(clip->color);
    rlf_free(clip->has_color);
    memset(clip, 0, sizeof(*clip));
}

static size_t color_bytes(const rlf_rig *rig)
{
    return (size_t)rig->color.width * (size_t)rig->color.height * 4;
}

static rlf_result allocate(real_clip *clip, int32_t count)
{
    size_t n = (size_t)count;
    clip->count = count;
    clip->time_ns = rlf_alloc_array(n, sizeof(*clip->time_ns));
    clip->has_color = rlf_alloc_array(n, 1);
    clip->depth = rlf_alloc_array(n * (size_t)real_clip_pixels(clip), sizeof(*clip->depth));
    if (clip->rig.has_color) {
        clip->color = rlf_alloc_array(n, color_bytes(&clip->rig));
    }
    bool is_ready = clip->time_ns != NULL && clip->has_color != NULL && clip->depth != NULL &&
                    (!clip->rig.has_color || clip->color != NULL);
    return is_ready ? RLF_OK : RLF_ERROR_MEMORY;
}

static void take_frame(real_clip *clip, int32_t index, const rlf_frame *frame)
{
    const rlf_camera *c = &clip->rig.depth;
    clip->time_ns[index] = frame->time_ns;
    clip->units_per_metre = frame->depth_units_per_metre;
    memcpy(real_clip_depth(clip, index), frame->depth_u16,
           (size_t)c->width * (size_t)c->height * sizeof(uint16_t));
    clip->has_color[index] = frame->color.data != NULL;
    if (frame->color.data != NULL) {
        size_t bytes = color_bytes(&clip->rig);
        memcpy(clip->color + (size_t)index * bytes, frame->color.data, bytes);
    }
}

rlf_result real_clip_load(const char *folder, int32_t first, int32_t count, real_clip *out)
{
    memset(out, 0, sizeof(*out));
    rlf_source *source = NULL;
    rlf_result result = rlf_folder_source_open(folder, &source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_source_info *info = rlf_source_get_info(source);
    int32_t there = (int32_t)info->frame_count - first;
    out->rig = info->rig;
    result = there > 0 ? allocate(out, there < count ? there : count)
                       : rlf_fail(RLF_ERROR_INVALID, "%s: has no frame %d", folder, (int)first);
    for (int32_t i = -first; i < out->count && result == RLF_OK; i++) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK && i >= 0) {
            take_frame(out, i, &frame);
        }
    }
    rlf_source_destroy(&source);
    if (result != RLF_OK) {
        real_clip_free(out);
    }
    return result;
}

/* ---- played ---------------------------------------------------------------------------------- */

typedef struct player {
    const real_clip *clip;
    int32_t next, passes;
} player;

static rlf_result player_next(void *self, rlf_frame *out)
{
    player *p = self;
    const real_clip *clip = p->clip;
    if (p->next >= p->passes * clip->count) {
        return RLF_END;
    }
    int32_t pass = p->next / clip->count, index = p->next % clip->count;
    const int64_t *t = clip->time_ns;
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)p->next++;
    out->time_ns = t[index] + pass * (t[clip->count - 1] - t[0] + FRAME_NS);
    out->depth_u16 = real_clip_depth(clip, index);
    out->depth_stride = (ptrdiff_t)clip->rig.depth.width * (ptrdiff_t)sizeof(uint16_t);
    out->depth_units_per_metre = clip->units_per_metre;
    if (clip->has_color[index]) {
        const rlf_camera *c = &clip->rig.color;
        out->color = (rlf_image_rgba8){clip->color + (size_t)index * color_bytes(&clip->rig),
                                       c->width, c->height, (ptrdiff_t)c->width * 4};
    }
    return RLF_OK;
}

rlf_result real_clip_source(const real_clip *clip, int32_t passes, rlf_source **out)
{
    static const rlf_source_methods methods = {.next = player_next, .destroy = rlf_free};
    player *p = rlf_alloc(sizeof(*p));
    if (p == NULL) {
        return RLF_ERROR_MEMORY;
    }
    *p = (player){.clip = clip, .passes = passes};
    rlf_source_info info = {.rig = clip->rig, .frame_count = (int64_t)passes * clip->count};
    (void)snprintf(info.name, sizeof(info.name), "clip");
    rlf_result result = rlf_source_create_custom(&methods, &info, p, out);
    if (result != RLF_OK) {
        rlf_free(p);
    }
    return result;
}

rlf_result real_clip_surfaces(const real_clip *clip, int32_t passes, real_surface_fn take,
                              void *context)
{
    rlf_source *source = NULL;
    rlf_reconstruct *stage = NULL;
    rlf_result result = real_clip_source(clip, passes, &source);
    if (result == RLF_OK) {
        rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &clip->rig);
        result = rlf_reconstruct_create(&def, &stage);
    }
    for (int32_t i = 0; i < passes * clip->count && result == RLF_OK && !command_interrupted; i++) {
        rlf_frame frame;
        const rlf_surface *surface;
        result = rlf_source_next(source, &frame);
        result = result == RLF_OK ? rlf_reconstruct_process(stage, &frame, &surface) : result;
        result = result == RLF_OK ? take(context, &frame, surface, i) : result;
    }
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
    return result;
}
