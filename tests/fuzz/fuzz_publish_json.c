/* Commands as JSON: any bytes give one that is sane, or an error line. */
#include "fuzz.h"

#include "publish/inside.h"

#include <stdlib.h>

static const char *const seeds[] = {
    "{\"type\":\"spawn\",\"shape\":\"sphere\",\"radius\":0.1,\"position\":[0,0,1.5],\"velocity\":"
    "[1,2,3],\"angular_velocity\":[3,2,1],\"name\":\"ball\",\"mass\":1,\"color\":[1,0,0.5]}",
    "{\"type\":\"throw\",\"shape\":\"cylinder\",\"radius\":0.1,\"height\":0.3,\"restitution\":0.5,"
    "\"friction\":1}",
    "{\"type\":\"spawn\",\"size\":[0.1,0.2,0.3]}",
    "{\"type\":\"gravity\",\"value\":[0,9.81,0]}",
    "{\"type\":\"record\",\"on\":true}",
    "{\"type\":\"scene\",\"name\":\"thesis/arm\"}",
    "{\"type\":\"remove\",\"name\":\"b\\u00e9ll\"}",
    "{\"type\":\"clear\"}"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    publish_command c;
    char error[PUBLISH_ERROR_SIZE] = "";
    if (!publish_command_from_json((const char *)data, size, &c, error)) {
        if (error[0] == '\0') {
            abort();
        }
        return 0;
    }
    const rlf_body_def *b = &c.body;
    if (!rlf_vec3_is_finite(b->position) || !rlf_vec3_is_finite(b->velocity) ||
        !rlf_vec3_is_finite(c.gravity) || !(b->mass >= 0.0 && b->mass <= 1000.0) ||
        b->name[RLF_NAME_MAX - 1] != '\0' || c.name[RLF_NAME_MAX - 1] != '\0') {
        abort();
    }
    return 0;
}
