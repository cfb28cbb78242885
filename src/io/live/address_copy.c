/* An address that lives longer than the call that gave it. */
#include "io/live/live.h"

#include <string.h>

static size_t text_size(const rlf_address *a)
{
    size_t size = strlen(a->source) + strlen(a->place) + 2;
    for (int32_t i = 0; i < a->key_count; i++) {
        size += strlen(a->keys[i]) + strlen(a->values[i]) + 2;
    }
    return size;
}

static const char *put(char **end, const char *text)
{
    char *copy = *end;
    const size_t size = strlen(text) + 1;
    memcpy(copy, text, size);
    *end += size;
    return copy;
}

rlf_result live_address_copy(const rlf_address *address, live_address *out)
{
    memset(out, 0, sizeof(*out));
    out->text = rlf_alloc(text_size(address));
    if (out->text == NULL) {
        return RLF_ERROR_MEMORY;
    }
    char *end = out->text;
    out->address = *address;
    out->address.source = put(&end, address->source);
    out->address.place = put(&end, address->place);
    for (int32_t i = 0; i < address->key_count; i++) {
        out->address.keys[i] = put(&end, address->keys[i]);
        out->address.values[i] = put(&end, address->values[i]);
    }
    if (address->rig != NULL) {
        out->rig = *address->rig;
        out->address.rig = &out->rig;
    }
    return RLF_OK;
}

void live_address_free(live_address *address)
{
    rlf_free(address->text);
    address->text = NULL;
}
