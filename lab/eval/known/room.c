/* The room with the three boxes: their true models, and a sensor that loses them. */
#include "eval/known/room.h"

#include "relief/synthetic.h"

#include <stdio.h>
#include <string.h>

#define FLOOR_Y 1.3
#define TABLE_TOP_M 0.735 /* over the floor */

/* src/sim/room.c says where they stand. */
static const struct {
    const char *name;
    double x, base, z, size[3], yaw;
} boxes[KNOWN_MODELS] = {{"large", 1.34, 0.0, 2.40, {0.34, 0.22, 0.26}, 0.35},
                         {"top", 1.36, 0.22, 2.41, {0.20, 0.11, 0.15}, -0.25},
                         {"small", 0.84, 0.0, 2.34, {0.16, 0.16, 0.16}, -0.5}};

rlf_known_def known_true_model(int32_t index)
{
    rlf_known_def def = rlf_known_def_default();
    const double *size = boxes[index].size;
    (void)snprintf(def.name, sizeof(def.name), "%s", boxes[index].name);
    def.shape.size = rlf_vec3_make(size[0], size[1], size[2]);
    def.T_world_model.p = rlf_vec3_make(
        boxes[index].x, FLOOR_Y - TABLE_TOP_M - boxes[index].base - 0.5 * size[1], boxes[index].z);
    def.T_world_model.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), boxes[index].yaw);
    return def;
}

/* ---- a sensor that loses the boxes ----------------------------------------------------------- */

typedef struct lossy {
    rlf_source *room;
    uint16_t *depth;
} lossy;

static rlf_result lossy_next(void *self, rlf_frame *out)
{
    lossy *s = self;
    rlf_result result = rlf_source_next(s->room, out);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_truth *truth = rlf_source_get_truth(s->room);
    const rlf_camera *camera = &rlf_source_get_info(s->room)->rig.depth;
    int32_t count = camera->width * camera->height;
    memcpy(s->depth, out->depth_u16, (size_t)count * sizeof(uint16_t));
    for (int32_t i = 0; i < count; i++) {
        int32_t label = truth->label[i];
        if (label == RLF_SYNTHETIC_LABEL_BOX_LARGE || label == RLF_SYNTHETIC_LABEL_BOX_SMALL ||
            label == RLF_SYNTHETIC_LABEL_BOX_TOP) {
            s->depth[i] = 0;
        }
    }
    out->depth_u16 = s->depth;
    return RLF_OK;
}

static void lossy_destroy(void *self)
{
    lossy *s = self;
    rlf_source_destroy(&s->room);
    rlf_free(s->depth);
    rlf_free(s);
}

static rlf_result open_lossy(rlf_source *room, rlf_source **out)
{
    static const rlf_source_methods methods = {.next = lossy_next, .destroy = lossy_destroy};
    const rlf_source_info *info = rlf_source_get_info(room);
    lossy *s = rlf_alloc(sizeof(*s));
    if (s == NULL) {
        return RLF_ERROR_MEMORY;
    }
    s->depth = rlf_alloc_array((size_t)info->rig.depth.width * (size_t)info->rig.depth.height,
                               sizeof(uint16_t));
    rlf_result result =
        s->depth != NULL ? rlf_source_create_custom(&methods, info, s, out) : RLF_ERROR_MEMORY;
    if (result != RLF_OK) {
        rlf_free(s->depth);
        rlf_free(s);
        return result;
    }
    s->room = room;
    return RLF_OK;
}

rlf_result known_open_room(int64_t seed, bool is_lost, rlf_source **out, rlf_source **out_room)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.scene = RLF_SYNTHETIC_EMPTY;
    def.seed = (uint64_t)seed;
    def.frame_count = -1;
    def.enable_truth = is_lost;
    rlf_result result = rlf_synthetic_create(&def, out);
    *out_room = *out;
    if (result == RLF_OK && is_lost) {
        result = open_lossy(*out_room, out);
        if (result != RLF_OK) {
            rlf_source_destroy(out);
        }
    }
    return result;
}
