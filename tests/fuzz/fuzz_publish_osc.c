/* Commands as OSC packets: any bytes give commands that are sane, or error lines. */
#include "fuzz.h"

#include "publish/inside.h"

#include <stdlib.h>

/* Zeros are written as ~, which no message has. */
static const char *const seeds[] = {
    "/relief/spawn~~~,sffff~~sphere~~\x3e\x4c\xcc\xcd~~~~~~~~\x3f\x80~~",
    "/relief/throw~~~,sfs~~~~box~\x3e\x4c\xcc\xcd"
    "ball~~~~",
    "/relief/gravity~,fff~~~~~~~~\x41\x1c\xf5\xc3~~~~",
    "/relief/scene~~~,s~~rain~~~~",
    "/relief/record~~,T~~",
    "#bundle~~~~~~~~\x01~~~\x14/relief/clear~~~,~~~~~~\x14/relief/hello~~~,~~~"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    const size_t size = index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
    for (size_t i = 0; i < size; i++) {
        out[i] = out[i] == '~' ? 0 : out[i];
    }
    return size;
}

static void look(void *context, publish_command *c, const char *error)
{
    (void)context;
    const rlf_body_def *b = &c->body;
    const bool is_right = rlf_vec3_is_finite(b->position) && rlf_vec3_is_finite(b->velocity) &&
                          rlf_vec3_is_finite(c->gravity) && b->mass >= 0.0 && b->mass <= 1000.0 &&
                          b->name[RLF_NAME_MAX - 1] == '\0' && c->name[RLF_NAME_MAX - 1] == '\0';
    if (error == NULL ? !is_right : error[0] == '\0') {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    publish_commands_from_osc(data, size, look, NULL);
    return 0;
}
