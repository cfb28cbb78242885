/* What a pointer does in the picture: the window's own throws and grabs. */
#include "page.h"

#include "relief/query.h"
#include "viewer/mouse.h"

static viewer_grab grab;
static int32_t thrown; /* gives the next one its colour */

void page_hand_forget(void)
{
    grab.is_on = false;
    thrown = 0;
}

void page_hand_pull(double dt)
{
    viewer_grab_pull(&grab, rlf_pipeline_get_world(page_pipeline()), dt);
}

/* False before the first picture. */
static bool ray_at(double u, double v, viewer_ray *out)
{
    rlf_pipeline *pipeline = page_pipeline();
    if (pipeline == NULL || page_output()->surface == NULL) {
        return false;
    }
    const rlf_compositor_def def = rlf_pipeline_get_compositor_def(pipeline);
    *out = viewer_ray_make(&def, &page_output()->T_world_camera, u, v);
    return true;
}

static bool find(double u, double v, viewer_ray *out_ray, rlf_ray_hit *out)
{
    return ray_at(u, v, out_ray) &&
           viewer_grab_find(rlf_pipeline_get_world(page_pipeline()), out_ray, out);
}

/* Whether a body is at a pixel of the picture. */
int32_t EXPORT(relief_has_body_at)(double u, double v)
{
    viewer_ray ray;
    rlf_ray_hit hit;
    return find(u, v, &ray, &hit);
}

/* Takes hold of the body at a pixel; 0 = there is none. */
int32_t EXPORT(relief_grab)(double u, double v)
{
    viewer_ray ray;
    rlf_ray_hit hit;
    grab.is_on = false;
    if (find(u, v, &ray, &hit)) {
        viewer_grab_begin(&grab, rlf_pipeline_get_world(page_pipeline()), &ray, &hit);
    }
    return grab.is_on;
}

/* What is held follows to this pixel. */
void EXPORT(relief_drag)(double u, double v)
{
    viewer_ray ray;
    if (grab.is_on && ray_at(u, v, &ray)) {
        grab.ray = ray;
    }
}

/* What is held comes nearer, steps > 0, or goes away. */
void EXPORT(relief_reach)(double steps)
{
    viewer_grab_reach(&grab, steps);
}

void EXPORT(relief_release)(void)
{
    grab.is_on = false;
}

/* Throws a body from the camera through a pixel. drag: share of the picture's height that the
 * pointer was drawn along, which gives the speed; kind, a viewer_throw_kind but a model. Returns an
 * rlf_result. */
int32_t EXPORT(relief_throw)(double u, double v, double drag, int32_t kind, double size_m,
                             double restitution, double friction)
{
    viewer_ray ray;
    if (kind < 0 || kind >= VIEWER_THROW_MODEL || !ray_at(u, v, &ray)) {
        return rlf_fail(RLF_ERROR_INVALID, "no picture yet, or no shape of number %d", (int)kind);
    }
    viewer_throw_def def = viewer_throw_def_default();
    def.kind = (viewer_throw_kind)kind;
    def.size_m = size_m;
    def.restitution = restitution;
    rlf_body_def body = viewer_throw_body(&def, &ray, viewer_throw_speed(drag), thrown++);
    body.friction = friction;
    return rlf_world_add_body(rlf_pipeline_get_world(page_pipeline()), &body, NULL);
}

/* Removes the body at a pixel; 0 = there is none. */
int32_t EXPORT(relief_remove)(double u, double v)
{
    viewer_ray ray;
    rlf_ray_hit hit;
    const bool is_found = find(u, v, &ray, &hit);
    if (is_found) {
        rlf_world_remove_body(rlf_pipeline_get_world(page_pipeline()), hit.body);
    }
    return is_found;
}
