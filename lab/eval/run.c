/* A source, both profiles on the very same frames, and every measure. */
#include "eval/run.h"

#include "command.h"
#include "eval/figures.h"
#include "eval/measures/behind.h"
#include "eval/measures/centre.h"
#include "eval/measures/collisions.h"
#include "eval/measures/depth.h"
#include "eval/measures/distance.h"
#include "eval/measures/foreground.h"
#include "eval/measures/normals.h"
#include "eval/measures/solid.h"
#include "eval/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define THROWN_BODIES 60

const eval_scene eval_scenes[] = {
    {"room", "a person walks in and reaches out", 210, "room", "", false},
    {"empty", "nobody", 60, "empty", "", false},
    {"thesis", "a walking person before wall and column", 150, "thesis", "", false},
    {"chair", "the chair is taken away after 4 s", 165, "chair", "", false},
    {"book", "a book held edge-on, then turned", 230, "book", "", false},
    {"hand", "a hand close up", 120, "hand", "", false},
    {"steps", "room, by structured light: correlated noise in steps", 120, "room", "&noise=steps",
     false},
    {"people", "room, with another person for every seed", 210, "room", "", true},
};
const int32_t eval_scene_count = (int32_t)(sizeof(eval_scenes) / sizeof(eval_scenes[0]));

const eval_scene *eval_scene_find(const char *name)
{
    for (int32_t i = 0; i < eval_scene_count; i++) {
        if (strcmp(eval_scenes[i].name, name) == 0) {
            return &eval_scenes[i];
        }
    }
    return NULL;
}

/* One profile's pipeline. It reads from a source that gives the frame of the run again, so that all
 * profiles see the same frame and it is simulated once. */
typedef struct lane {
    rlf_profile profile;
    rlf_source *echo;
    rlf_scene scene;
    rlf_pipeline *pipeline;
    eval_measures measures;
} lane;

typedef struct run {
    rlf_source *source;
    const setting_list *settings;
    rlf_frame frame;
    uint8_t *band, *scratch; /* a byte per depth pixel */
    lane lanes[EVAL_PROFILES];
    int32_t lane_count;
} run;

static rlf_result echo_next(void *self, rlf_frame *out)
{
    *out = *(const rlf_frame *)self;
    return RLF_OK;
}

/* Bodies of a room that is not the old one: they fall to its floor, and what would start inside
 * something starts before the camera, where nothing stands. */
static void turn_scene(const run *r, rlf_scene *scene)
{
    const double apart = 0.15;
    rlf_vec3 down = {0, 1, 0};
    if (strcmp(rlf_source_get_info(r->source)->name, "synthetic:random") != 0) {
        return;
    }
    (void)rlf_synthetic_get_down(r->source, &down);
    scene->gravity = rlf_scale(down, 9.81);
    for (int32_t i = 0; i < scene->body_count; i++) {
        rlf_body_def *body = &scene->bodies[i];
        rlf_synthetic_hit hit;
        if (rlf_synthetic_nearest(r->source, body->release_time, body->position, &hit) == RLF_OK &&
            hit.distance < apart) {
            body->position = rlf_vec3_make(0.0, 0.0, 0.4);
        }
    }
}

static rlf_result open_lane(run *r, lane *l, int64_t seed)
{
    const rlf_source_info *info = rlf_source_get_info(r->source);
    rlf_source_methods methods = {.next = echo_next};
    rlf_result result = rlf_source_create_custom(&methods, info, &r->frame, &l->echo);
    if (result == RLF_OK) {
        result = eval_collisions_scene((uint64_t)seed, THROWN_BODIES, &l->scene);
    }
    if (result != RLF_OK) {
        return result;
    }
    turn_scene(r, &l->scene);
    rlf_pipeline_def def = rlf_pipeline_def_default(l->profile, l->echo, NULL);
    def.scene = &l->scene;
    def.enable_render = false;
    settings_apply(r->settings, &def.reconstruct);
    result = rlf_pipeline_create(&def, &l->pipeline);
    if (result == RLF_OK) {
        result = eval_depth_init(&l->measures.depth, &info->rig.depth);
    }
    if (result == RLF_OK) {
        result = eval_collisions_init(&l->measures.collisions, THROWN_BODIES);
    }
    if (result == RLF_OK) {
        eval_collisions_restart(&l->measures.collisions);
        result = eval_solid_restart(&l->measures.solid, &info->rig);
    }
    if (result == RLF_OK) {
        result = eval_behind_init(&l->measures.behind, r->source);
    }
    return result;
}

static void close_lane(lane *l)
{
    eval_collisions_finish(&l->measures.collisions);
    eval_solid_finish(&l->measures.solid);
    eval_behind_finish(&l->measures.behind);
    eval_depth_finish(&l->measures.depth);
    rlf_pipeline_destroy(&l->pipeline);
    rlf_scene_destroy(&l->scene);
    rlf_source_destroy(&l->echo);
}

static rlf_result open_run(run *r, const char *name, int64_t seed, int profile_mask)
{
    rlf_result result = rlf_open_source(name, NULL, &r->source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_camera *depth = &rlf_source_get_info(r->source)->rig.depth;
    size_t pixels = (size_t)depth->width * (size_t)depth->height;
    r->band = rlf_alloc(pixels);
    r->scratch = rlf_alloc(pixels);
    if (r->band == NULL || r->scratch == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_OK; profile++) {
        if (profile_mask & (1 << profile)) {
            lane *l = &r->lanes[r->lane_count++];
            l->profile = (rlf_profile)profile;
            result = open_lane(r, l, seed);
        }
    }
    return result;
}

static void close_run(run *r)
{
    for (int32_t i = 0; i < r->lane_count; i++) {
        close_lane(&r->lanes[i]);
    }
    rlf_free(r->band);
    rlf_free(r->scratch);
    rlf_source_destroy(&r->source);
}

static void measure(run *r, eval_measures *m, const rlf_pipeline_output *out)
{
    const rlf_truth *truth = rlf_source_get_truth(r->source);
    const rlf_rig *rig = &rlf_source_get_info(r->source)->rig;
    eval_depth_add(&m->depth, out->surface, &out->frame, truth);
    eval_normals_add(&m->normals, out->surface, truth, rig, r->band);
    eval_distance_add(&m->distance, out->surface, &out->frame, truth, r->band);
    eval_centre_add(&m->centre, out->surface, truth, rig);
    eval_foreground_add(&m->foreground, out->surface, truth, rig);
    eval_solid_add(&m->solid, out->surface, truth, rig);
    eval_behind_add(&m->behind, out->surface, truth);
    eval_collisions_add(&m->collisions, out->snapshot, r->source);
}

static rlf_result step(run *r)
{
    rlf_result result = rlf_source_next(r->source, &r->frame);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_camera *depth = &rlf_source_get_info(r->source)->rig.depth;
    eval_mark_band(rlf_source_get_truth(r->source)->depth, depth->width, depth->height, r->band,
                   r->scratch);
    for (int32_t i = 0; i < r->lane_count; i++) {
        rlf_pipeline_output out;
        result = rlf_pipeline_step(r->lanes[i].pipeline, &out);
        if (result != RLF_OK) {
            return result;
        }
        measure(r, &r->lanes[i].measures, &out);
    }
    return RLF_OK;
}

static void report(const lane *l, const char *scene, eval_table *table)
{
    double values[EVAL_FIGURES_MAX];
    eval_figures_get(&l->measures, values);
    for (int32_t i = 0; i < eval_figure_count(); i++) {
        eval_table_add(table, scene, eval_figure_key(i), eval_figure_title(i), l->profile,
                       values[i]);
    }
    for (int32_t i = 0; i < eval_distance_count(); i++) {
        eval_table_add(table, scene, eval_distance_key(i), eval_distance_title(i), l->profile,
                       eval_distance_value(&l->measures.distance, i));
    }
}

rlf_result eval_scene_run(eval_table *table, const eval_scene *scene, int64_t seed, int64_t frames,
                          int profile_mask, const setting_list *settings)
{
    char name[128];
    snprintf(name, sizeof(name), "synthetic:%s?seed=%lld&frames=%lld&person=%lld%s", scene->source,
             (long long)seed, (long long)frames, (long long)(scene->has_others ? seed + 1 : 1),
             scene->options);
    run *r = rlf_alloc(sizeof(*r)); /* large: histograms */
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->settings = settings;
    rlf_result result = open_run(r, name, seed, profile_mask);
    while (result == RLF_OK && !command_interrupted) {
        result = step(r);
    }
    result = result == RLF_END ? RLF_OK : result;
    for (int32_t i = 0; i < r->lane_count && result == RLF_OK; i++) {
        report(&r->lanes[i], scene->name, table);
    }
    close_run(r);
    rlf_free(r);
    return result;
}
