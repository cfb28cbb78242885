/* What installations couple sound and light to: a line for every touch that begins or ends, and how
 * hard a body struck. The first ten seconds of two cubes in the synthetic room. */
#include "relief/relief.h"
#include "relief/synthetic.h"

#include <stdio.h>

static const char *name_of(const rlf_snapshot *s, rlf_body_id id)
{
    for (int32_t i = 0; i < s->body_count; i++) {
        if (s->bodies[i].id.index1 == id.index1 && s->bodies[i].id.generation == id.generation) {
            return s->bodies[i].name;
        }
    }
    return "a body that has gone";
}

/* The hardest blow that the body got in this frame, N s. */
static double blow_of(const rlf_snapshot *s, rlf_body_id id)
{
    double hardest = 0.0;
    for (int32_t i = 0; i < s->contact_count; i++) {
        const rlf_contact *c = &s->contacts[i];
        if (c->body.index1 == id.index1 && c->impulse > hardest) {
            hardest = c->impulse;
        }
    }
    return hardest;
}

static int tell(double time_s, const rlf_snapshot *s)
{
    static const char *const others[] = {"another body", "the room", "something that moves"};
    int begun = 0;
    for (int32_t i = 0; i < s->event_count; i++) {
        const rlf_contact_event *e = &s->events[i];
        begun += e->is_begin;
        printf("%5.2f s  %s %s %s", time_s, name_of(s, e->body), e->is_begin ? "touches" : "leaves",
               others[e->other]);
        printf(e->is_begin ? ", %.2f N s\n" : "\n", blow_of(s, e->body));
    }
    return begun;
}

int main(void)
{
    rlf_synthetic_def room = rlf_synthetic_def_default();
    rlf_source *source = NULL;
    rlf_scene scene = {0};
    rlf_pipeline *pipeline = NULL;
    int begun = 0;
    rlf_result result = rlf_synthetic_create(&room, &source);
    if (result == RLF_OK) {
        result = rlf_scene_create_two_cubes(&scene);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.scene = &scene;
        def.enable_render = false;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    for (int i = 0; i < 90 && result == RLF_OK; i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(pipeline, &frame);
        if (result == RLF_OK) {
            begun += tell(frame.time_s, frame.snapshot);
        }
    }
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    return result == RLF_OK && begun > 0 ? 0 : 1;
}
