/* Section "known": models of real things whose poses are picked with an unsteady hand. */
#include "eval/known.h"
#include "eval/analytic.h"
#include "eval/sections.h"

#include "relief/synthetic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PICK_SIGMA_PX 1.5
#define TRIES 10  /* of picks, per box */
#define SETTLE 10 /* frames before a pick */
#define FLOOR_Y 1.3
#define TABLE_TOP_M 0.735 /* over the floor */

/* src/capture/synthetic/room.c says where they stand. */
static const struct {
    const char *name;
    double x, base, z, size[3], yaw;
} boxes[KNOWN_MODELS] = {{"large", 1.34, 0.0, 2.40, {0.34, 0.22, 0.26}, 0.35},
                         {"top", 1.36, 0.22, 2.41, {0.20, 0.11, 0.15}, -0.25},
                         {"small", 0.84, 0.0, 2.34, {0.16, 0.16, 0.16}, -0.5}};

/* The corners that the camera sees best: a face, and one behind it. */
static const char *const corners[KNOWN_MODELS][5] = {{"ltn", "rtn", "rbn", "lbn", "ltf"},
                                                     {"ltn", "rtn", "rbn", "lbn", "rtf"},
                                                     {"ltn", "rtn", "rbn", "lbn", "ltf"}};

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

/* ---- picks ---------------------------------------------------------------------------------- */

typedef struct pose_errors {
    double shift_mm, turn_deg, worst_mm;
    int32_t count, refused;
} pose_errors;

static void add_error(pose_errors *e, const rlf_pose *found, const rlf_pose *truth)
{
    rlf_quat turn = rlf_quat_mul(found->q, rlf_quat_conjugate(truth->q));
    double sine = rlf_length(rlf_vec3_make(turn.x, turn.y, turn.z));
    double cosine = turn.w < 0.0 ? -turn.w : turn.w;
    double mm = 1000.0 * rlf_length(rlf_sub(found->p, truth->p));
    e->shift_mm += mm;
    e->turn_deg += 2.0 * rlf_atan2(sine, cosine) * 180.0 / RLF_PI;
    e->worst_mm = rlf_max(e->worst_mm, mm);
    e->count++;
}

static rlf_known_def pick_model(int32_t index, const rlf_rig *rig, eval_random *random)
{
    rlf_known_def def = known_true_model(index);
    for (int32_t i = 0; i < 5; i++) {
        rlf_known_point *point = &def.points[i];
        point->has_pixel = true;
        (void)rlf_known_name_point(&def.shape, corners[index][i], &point->model);
        rlf_vec3 p = rlf_transform(&def.T_world_model, point->model);
        (void)rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p),
                                 &point->pixel[0], &point->pixel[1]);
        point->pixel[0] += PICK_SIGMA_PX * eval_random_normal(random);
        point->pixel[1] += PICK_SIGMA_PX * eval_random_normal(random);
    }
    def.point_count = 5;
    return def;
}

/* Picks every box a few times; `out` is what the last of them gave. */
static void pick_all(const rlf_known_view *view, eval_random *random, pose_errors errors[2],
                     rlf_known_def out[KNOWN_MODELS])
{
    for (int32_t i = 0; i < KNOWN_MODELS; i++) {
        const rlf_pose truth = known_true_model(i).T_world_model;
        out[i] = known_true_model(i);
        for (int32_t k = 0; k < TRIES; k++) {
            rlf_known_def def = pick_model(i, view->rig, random);
            for (int32_t refined = 0; refined < 2; refined++) {
                rlf_known_fit fit;
                def.refine = refined != 0;
                if (rlf_known_solve(&def, view, &fit) != RLF_OK) {
                    errors[refined].refused++;
                    continue;
                }
                add_error(&errors[refined], &fit.T_world_model, &truth);
                out[i].T_world_model = fit.T_world_model;
            }
        }
    }
}

static void add_pose_rows(eval_table *table, const pose_errors e[2])
{
    static const char *const keys[2][3] = {{"picked_mm", "picked_deg", "picked_worst_mm"},
                                           {"refined_mm", "refined_deg", "refined_worst_mm"}};
    static const char *const titles[2][3] = {
        {"picks of 1.5 px: position off by, mm", "  turned by, degrees", "  worst position, mm"},
        {"  moved onto the surface: off by, mm", "  turned by, degrees", "  worst position, mm"}};
    for (int k = 0; k < 2; k++) {
        double count = e[k].count > 0 ? e[k].count : NAN;
        const double values[3] = {e[k].shift_mm / count, e[k].turn_deg / count, e[k].worst_mm};
        for (int i = 0; i < 3; i++) {
            eval_table_add(table, "known", keys[k][i], titles[k][i], RLF_PROFILE_LIVE, values[i]);
        }
    }
    eval_table_add(table, "known", "refused_count", "  picks refused, of 30", RLF_PROFILE_LIVE,
                   e[1].refused);
}

static rlf_result run_picks(eval_table *table, int64_t seed, rlf_known_def out[KNOWN_MODELS])
{
    rlf_source *source = NULL, *room = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame;
    pose_errors errors[2] = {{.count = 0}, {.count = 0}};
    eval_random random = eval_random_start((uint64_t)seed + 77);
    rlf_result result = known_open_room(seed, false, &source, &room);
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.enable_render = false;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    for (int i = 0; i < SETTLE && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        const rlf_known_view view = {frame.surface, &rlf_source_get_info(source)->rig,
                                     rlf_pose_identity()};
        pick_all(&view, &random, errors, out);
        add_pose_rows(table, errors);
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return result;
}

rlf_result eval_known_run(eval_table *table, int64_t seed, int profile_mask)
{
    if ((profile_mask & (1 << RLF_PROFILE_LIVE)) == 0) {
        return RLF_OK; /* the thesis has no models */
    }
    rlf_known_def models[KNOWN_MODELS];
    rlf_result result = run_picks(table, seed, models);
    if (result == RLF_OK) {
        result = known_run_picture(table, seed, models);
    }
    return result == RLF_OK ? known_run_bounce(table, seed, models) : result;
}
