/* Scenes: the bodies to start with. */
#include "relief/model.h"
#include "relief/pipeline.h"

#include <string.h>

static rlf_body_def cube(const char *name, rlf_vec3 position, rlf_vec3 velocity, rlf_vec3 spin)
{
    rlf_body_def def = rlf_body_def_default();
    size_t length = strlen(name);
    memcpy(def.name, name, length < RLF_NAME_MAX ? length : RLF_NAME_MAX - 1);
    def.shape.size = rlf_vec3_make(0.2, 0.2, 0.2);
    def.mass = 0.5;
    def.restitution = 0.5;
    def.position = position;
    def.velocity = velocity;
    def.angular_velocity = spin;
    return def;
}

rlf_result rlf_scene_create_two_cubes(rlf_scene *out)
{
    if (!RLF_ASSERT(out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    memset(out, 0, sizeof(*out));
    out->gravity = rlf_world_def_default().gravity;
    out->border = RLF_BORDER_EXTEND;
    out->bodies = rlf_alloc_array(2, sizeof(*out->bodies));
    if (out->bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    out->body_count = 2;
    out->bodies[0] = cube("from_camera", rlf_vec3_make(-0.1, 0.0, 0.5), rlf_vec3_make(0, -1.6, 3.0),
                          rlf_vec3_make(2, 0.5, 1));
    out->bodies[1] = cube("from_right", rlf_vec3_make(1.2, -0.3, 2.2), rlf_vec3_make(-2.2, -1.5, 0),
                          rlf_vec3_make(0.5, 1, 2.5));
    const float blue[3] = {0.25f, 0.5f, 0.9f};
    memcpy(out->bodies[1].color, blue, sizeof(blue));
    return RLF_OK;
}

void rlf_scene_destroy(rlf_scene *scene)
{
    if (scene == NULL) {
        return;
    }
    for (int32_t i = 0; i < scene->body_count; i++) {
        const rlf_hull *hull = scene->bodies[i].shape.hull;
        bool is_last = i + 1 == scene->body_count || scene->bodies[i + 1].shape.hull != hull;
        rlf_free(is_last ? (void *)(uintptr_t)hull : NULL);
    }
    for (int32_t i = 0; i < scene->known_count; i++) {
        rlf_free((void *)(uintptr_t)scene->known[i].shape.hull);
    }
    for (int32_t i = 0; i < scene->model_count; i++) {
        rlf_model_destroy(&scene->models[i]);
    }
    rlf_free(scene->models);
    rlf_free(scene->bodies);
    rlf_free(scene->known);
    memset(scene, 0, sizeof(*scene));
}
