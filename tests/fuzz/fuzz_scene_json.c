/* scene.json: any bytes give bodies that are sane, or an error line. */
#include "fuzz.h"

#include "io/scene/reader.h"

#include <math.h>
#include <stdlib.h>

static const char *const seeds[] = {
    "{\"gravity\":[0,9.81,0],\"bodies\":[{\"name\":\"a\",\"shape\":\"box\",\"size\":[0.1,0.1,0.1],"
    "\"mass\":1,\"position\":[0,0,1],\"orientation\":[0,0,0,1],\"velocity\":[1,2,3],"
    "\"restitution\":0.5,\"color\":[1,0,0]},{\"shape\":\"sphere\",\"radius\":0.1}]}",
    "{\"bodies\":[{\"shape\":\"capsule\",\"radius\":0.1,\"height\":0.2,\"release_time\":1},"
    "{\"shape\":\"hull\",\"model\":\"none.obj\"}]}",
    "{\"bodies\":[{\"kinematic\":true,\"linear_damping\":0.5,\"angular_damping\":2,\"vertices\":"
    "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],\"shape\":\"hull\"}],\"spawn\":[{\"body\":{\"name\":\"n\","
    "\"shape\":\"hull\",\"vertices\":[[0,0,0],[2,0,0],[0,2,0],[0,0,2]]},\"pattern\":\"random\","
    "\"count\":9,\"box\":[1,0.5,0],\"seed\":7,\"turned\":true,\"velocity_spread\":[1,2,3],"
    "\"angular_velocity_spread\":[3,2,1],\"interval\":0.5,\"colors\":[[1,0,0],[0,0.5,1]]}]}",
    "{\"gravity\":[0,3,4],\"spawn\":[{\"body\":{},\"pattern\":\"grid\",\"count\":[3,2,2],"
    "\"spacing\":[0.1,0.2,0.3]},{\"body\":{\"name\":\"a\"},\"pattern\":\"stack\",\"count\":5,"
    "\"spacing\":0.1},{\"body\":{\"name\":\"b\"},\"pattern\":\"ring\",\"count\":5,\"radius\":1}]}",
    "{\"known_objects\":[{\"name\":\"a\",\"size\":[0.1,0.2,0.3],\"position\":[1,2,3],"
    "\"orientation\":[0,0,0,1],\"friction\":1},{\"name\":\"b\",\"points\":[{\"model\":\"ltn\","
    "\"pixel\":[10,20]},{\"model\":[0,0,0.1],\"world\":[1,2,3]},{\"model\":\"rbf\",\"pixel\":"
    "[1.5,2e1]}],\"refine\":false},{\"name\":\"c\",\"shape\":\"sphere\",\"radius\":0.1}]}"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    io_bytes file = {"scene.json", data, size};
    rlf_scene scene;
    if (io_scene_parse(&file, "no-such-folder", &scene) != RLF_OK) {
        return 0;
    }
    for (int32_t i = 0; i < scene.body_count; i++) {
        const rlf_body_def *b = &scene.bodies[i];
        rlf_quat q = b->orientation;
        double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        if (!(b->mass > 0.0) || !rlf_vec3_is_finite(b->position) || b->name[RLF_NAME_MAX - 1] ||
            !rlf_vec3_is_finite(b->velocity) || !rlf_vec3_is_finite(b->angular_velocity) ||
            !(fabs(norm - 1.0) < 1e-6) || !(b->release_time >= 0.0 && b->release_time < 1e12)) {
            abort();
        }
    }
    for (int32_t i = 0; i < scene.known_count; i++) {
        const rlf_known_def *k = &scene.known[i];
        rlf_known_fit fit;
        bool has_place = k->has_pose || k->point_count >= RLF_KNOWN_POINTS_MIN;
        if (k->name[0] == 0 || k->name[RLF_NAME_MAX - 1] || (!has_place && k->point_count > 0) ||
            !rlf_vec3_is_finite(k->T_world_model.p)) {
            abort();
        }
        if (rlf_known_solve(k, NULL, &fit) == RLF_OK && !rlf_vec3_is_finite(fit.T_world_model.p)) {
            abort();
        }
    }
    rlf_scene_destroy(&scene);
    return 0;
}
