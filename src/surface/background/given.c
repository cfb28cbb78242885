/* The background of a camera that moves: someone who knows where it is tells what stands behind
 * each pixel (a map's prediction). Nothing is remembered per pixel here. */
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

/* One sheet at rest. */
static void give_up(rlf_reconstruct *stage, const rlf_slot *slot)
{
    stage->background.state = RLF_BACKGROUND_NONE;
    stage->background.is_stale = true;
    background_clear_front(stage, slot);
}

/* The oldest image, which no valid surface refers to, becomes the newest. */
static background_image *take_room(rlf_reconstruct *stage, const rlf_given_background *room)
{
    rlf_background *background = &stage->background;
    const size_t size = (size_t)stage->grid.count * sizeof(float);
    background->newest = (background->newest + 1) % BACKGROUND_IMAGES;
    background_image *image = &background->images[background->newest];
    memcpy(image->depth, room->depth, size);
    memcpy(image->normal[0], room->normal_x, size);
    memcpy(image->normal[1], room->normal_y, size);
    memcpy(image->normal[2], room->normal_z, size);
    memcpy(background->mean, room->depth, size);
    image->version = background->next_version++;
    background->is_stale = false;
    background->state = RLF_BACKGROUND_READY;
    return image;
}

typedef struct given_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    background_image *image;
    float slack;
} given_job;

static float gate_at(const given_job *job, float z)
{
    return job->slack + rlf_background_gate(&job->stage->def, z);
}

static void test_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const given_job *job = context;
    const int32_t width = job->stage->grid.width;
    uint8_t *seen = job->stage->background.seen;
    for (int32_t i = begin * width; i < end * width; i++) {
        const float z = job->slot->depth[i], room = job->image->depth[i];
        if (!(z > 0.0f)) {
            seen[i] = RLF_SEEN_MISSING;
        } else if (!(room > 0.0f)) {
            seen[i] = RLF_SEEN_UNKNOWN;
        } else {
            seen[i] = z < room - gate_at(job, z) ? RLF_SEEN_FOREGROUND : RLF_SEEN_BACKGROUND;
        }
    }
}

/* What is seen where the room was not known, or farther than it was, is the room. */
static void learn_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const given_job *job = context;
    const rlf_slot *slot = job->slot;
    const int32_t width = job->stage->grid.width;
    for (int32_t i = begin * width; i < end * width; i++) {
        const float z = slot->depth[i], room = job->image->depth[i];
        if (!slot->foreground[i] && z > 0.0f && (!(room > 0.0f) || z > room + gate_at(job, z))) {
            job->image->depth[i] = z;
            job->stage->background.mean[i] = z;
            for (int k = 0; k < 3; k++) {
                job->image->normal[k][i] = slot->normal[k][i];
            }
        }
    }
}

void background_given_update(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_reconstruct_def *def = &stage->def;
    rlf_given_background room = {.depth = NULL};
    surface_publish_seen(stage, slot);
    if (!def->give_background(def->give_context, &slot->surface, &room)) {
        give_up(stage, slot);
        return;
    }
    if (stage->before != NULL && room.has_before) {
        motion_carry(stage, &room.T_now_before);
        keyframes_carry(&stage->velocity, &room.T_now_before);
    } else {
        keyframes_reset(&stage->velocity);
    }
    given_job job = {stage, slot, take_room(stage, &room), (float)room.slack_m};
    rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, test_rows, &job);
    background_majority(stage, slot, stage->background.seen);
    background_find_front(stage, slot);
    rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, learn_rows, &job);
}
