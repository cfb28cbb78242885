/* Bodies that were deleted, and how they come back. */
#include "viewer/state.h"

#include <stdio.h>

static void keep(viewer *v, rlf_body_id id, int32_t group)
{
    viewer_undo *u = &v->undo;
    viewer_removed *slot = &u->removed[u->next];
    if (rlf_world_get_body_def(rlf_pipeline_get_world(v->stage.pipeline), id, &slot->def)) {
        slot->group = group;
        u->next = (u->next + 1) % VIEWER_UNDO_MAX;
        u->count += u->count < VIEWER_UNDO_MAX ? 1 : 0;
    }
}

void viewer_remove_body(viewer *v, rlf_body_id id)
{
    keep(v, id, ++v->undo.group);
    rlf_world_remove_body(rlf_pipeline_get_world(v->stage.pipeline), id);
    v->is_redraw_due = true;
}

void viewer_remove_all(viewer *v)
{
    rlf_world *world = rlf_pipeline_get_world(v->stage.pipeline);
    const int32_t group = ++v->undo.group;
    const int32_t count = rlf_world_get_snapshot(world)->body_count;
    for (int32_t left = count; left > 0; left--) {
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        if (s->body_count > 0) {
            const rlf_body_id id = s->bodies[s->body_count - 1].id;
            keep(v, id, group);
            rlf_world_remove_body(world, id);
        }
    }
    v->is_redraw_due = true;
}

/* Those that went together come back together, at rest where they were. */
void viewer_bring_back(viewer *v)
{
    viewer_undo *u = &v->undo;
    rlf_world *world = rlf_pipeline_get_world(v->stage.pipeline);
    char text[VIEWER_LINE_SIZE];
    int32_t count = 0, group = 0;
    while (u->count > 0) {
        const int32_t last = (u->next + VIEWER_UNDO_MAX - 1) % VIEWER_UNDO_MAX;
        const viewer_removed *r = &u->removed[last];
        if (count > 0 && r->group != group) {
            break;
        }
        rlf_body_def def = r->def;
        def.velocity = def.angular_velocity = rlf_vec3_make(0, 0, 0);
        group = r->group;
        if (rlf_world_add_body(world, &def, NULL) != RLF_OK) {
            viewer_show_error(v, rlf_error_text());
            return;
        }
        u->next = last;
        u->count--;
        count++;
    }
    (void)snprintf(text, sizeof text, "%d %s back", (int)count,
                   count == 1 ? "body is" : "bodies are");
    viewer_show_message(v, count > 0 ? text : "no deleted body to bring back");
    v->is_redraw_due = true;
}
