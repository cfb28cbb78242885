/* Keys of an OpenNI2 address. */
#include "io/live/driver.h"
#include "io/openni2/openni2.h"

#include <string.h>

static rlf_result read_switch(const rlf_address *address, const char *key, int *out)
{
    const char *value = rlf_address_get(address, key);
    if (value == NULL) {
        return RLF_OK;
    }
    if (strcmp(value, "0") != 0 && strcmp(value, "1") != 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %s=%.40s: must be 0 or 1", address->source, key,
                        value);
    }
    *out = value[0] - '0';
    return RLF_OK;
}

rlf_result openni2_read_wish(const rlf_address *address, openni2_wish *out)
{
    *out = (openni2_wish){.color = 1, .aligned = -1, .mirror = -1};
    if (address->rig != NULL) {
        out->width = address->rig->depth.width;
        out->height = address->rig->depth.height;
        out->color_width = address->rig->has_color ? address->rig->color.width : 0;
        out->color_height = address->rig->has_color ? address->rig->color.height : 0;
    }
    io_mode mode = {out->width, out->height, 0};
    rlf_result result = io_mode_get(address, "mode", &mode);
    out->width = mode.width;
    out->height = mode.height;
    out->fps = mode.frames_per_second;
    if (result == RLF_OK) {
        result = read_switch(address, "color", &out->color);
    }
    if (result == RLF_OK) {
        result = read_switch(address, "aligned", &out->aligned);
    }
    return result == RLF_OK ? read_switch(address, "mirror", &out->mirror) : result;
}
