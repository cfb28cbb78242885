/* The compositor object: whatever renderer stands behind it, and the names of the views. */
#include "relief/compositor.h"

#include "base/checks.h"
#include "camera/checks.h"

#include <string.h>

struct rlf_compositor {
    rlf_compositor_methods methods;
    void *self;
};

static const char *const view_names[RLF_VIEW_COUNT] = {
    "camera",    "depth",  "normals", "mesh",     "regions", "foreground", "background", "velocity",
    "thickness", "reason", "points",  "contacts", "known",   "hands",      "map",        "bodies",
};

const char *rlf_view_name(rlf_view view)
{
    return (int)view >= 0 && view < RLF_VIEW_COUNT ? view_names[view] : NULL;
}

bool rlf_view_parse(const char *name, rlf_view *out)
{
    if (!RLF_ASSERT(name != NULL && out != NULL)) {
        return false;
    }
    for (int i = 0; i < RLF_VIEW_COUNT; i++) {
        if (strcmp(name, view_names[i]) == 0) {
            *out = (rlf_view)i;
            return true;
        }
    }
    return false;
}

rlf_compositor_def rlf_compositor_def_default(void)
{
    rlf_compositor_def def = {.cookie = RLF_DEF_COOKIE, .occlusion = RLF_OCCLUSION_DEPTH};
    def.rig.T_color_depth = rlf_pose_identity();
    def.light_color[0] = def.light_color[1] = def.light_color[2] = 1.0f;
    def.enable_real_shade = true;
    def.enable_real_ambient = true;
    def.light_direction = rlf_normalize(rlf_vec3_make(0.3, 0.8, 0.5));
    return def;
}

rlf_result rlf_compositor_create_custom(const rlf_compositor_methods *methods, void *self,
                                        rlf_compositor **out)
{
    if (!RLF_ASSERT(methods != NULL && methods->render != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_compositor *compositor = rlf_alloc(sizeof(*compositor));
    if (compositor == NULL) {
        return RLF_ERROR_MEMORY;
    }
    compositor->methods = *methods;
    compositor->self = self;
    *out = compositor;
    return RLF_OK;
}

void rlf_compositor_destroy(rlf_compositor **compositor)
{
    if (compositor == NULL || *compositor == NULL) {
        return;
    }
    if ((*compositor)->methods.destroy != NULL) {
        (*compositor)->methods.destroy((*compositor)->self);
    }
    rlf_free(*compositor);
    *compositor = NULL;
}

const char *rlf_compositor_name(const rlf_compositor *compositor)
{
    if (!RLF_ASSERT(compositor != NULL)) {
        return NULL;
    }
    return compositor->methods.name != NULL ? compositor->methods.name : "custom";
}

rlf_result rlf_compositor_render(rlf_compositor *compositor, const rlf_render_input *input,
                                 rlf_render_output *out)
{
    if (!RLF_ASSERT(compositor != NULL && input != NULL && out != NULL) ||
        !RLF_ASSERT(input->frame != NULL && input->surface != NULL) ||
        !RLF_ASSERT((int)input->view >= 0 && input->view < RLF_VIEW_COUNT)) {
        return RLF_ERROR_INVALID;
    }
    rlf_result result = color_check(input->frame, "compositor"); /* depth is the surface's */
    if (result == RLF_OK) {
        result = pose_check(&input->T_world_camera, "compositor", "T_world_camera");
    }
    return result == RLF_OK ? compositor->methods.render(compositor->self, input, out) : result;
}
