/* Section "known": models of real things whose poses are picked with an unsteady hand. */
#include "eval/analytic.h"
#include "eval/known/bounce.h"
#include "eval/known/picture.h"
#include "eval/known/room.h"
#include "eval/sections.h"
#include "eval/table.h"

#include <math.h>

#define PICK_SIGMA_PX 1.5
#define TRIES 10  /* of picks, per box */
#define SETTLE 10 /* frames before a pick */

/* The corners that the camera sees best: a face, and one behind it. */
static const char *const corners[KNOWN_MODELS][5] = {{"ltn", "rtn", "rbn", "lbn", "ltf"},
                                                     {"ltn", "rtn", "rbn", "lbn", "rtf"},
                                                     {"ltn", "rtn", "rbn", "lbn", "ltf"}};

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
