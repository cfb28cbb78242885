/* What bodies and known objects of a scene have in common: names, points, orientations. */
#include "io/scene/reader.h"
#include "io/scene/pattern.h"

#include <string.h>

static bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

rlf_result io_scene_read_name(const io_json_object *body, char out[RLF_NAME_MAX])
{
    static const io_json_field field = {"name", "a text of 1 to 63 bytes", 0, 0, false};
    const char *name = NULL;
    rlf_result result = io_json_get_text(body, &field, &name);
    if (result != RLF_OK || name == NULL) {
        return result;
    }
    size_t length = strlen(name);
    if (length == 0 || length >= RLF_NAME_MAX) {
        return io_json_fail(body, "name", "has %zu bytes: it must be %s", length, field.meaning);
    }
    for (size_t i = 0; i < length; i++) {
        if (is_control(name[i])) {
            return io_json_fail(body, "name", "holds a control character: use printable text");
        }
    }
    if (strcmp(name, "background") == 0 || strcmp(name, "foreground") == 0) {
        return io_json_fail(body, "name",
                            "is \"%s\", which contacts.csv uses for the real surface: choose "
                            "another",
                            name);
    }
    memcpy(out, name, length + 1);
    return RLF_OK;
}
