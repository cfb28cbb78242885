/* What bodies and known objects of a scene have in common: names, points, orientations. */
#include "io/scene/reader.h"
#include "io/scene/pattern.h"

#include <string.h>

rlf_result io_scene_read_vec3(const io_json_object *object, const io_json_field *field,
                              rlf_vec3 *out)
{
    double v[3] = {out->x, out->y, out->z};
    rlf_result result = io_json_get_numbers(object, field, v, 3);
    *out = rlf_vec3_make(v[0], v[1], v[2]);
    return result;
}

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

rlf_result io_scene_read_orientation(const io_json_object *body, rlf_quat *out)
{
    static const io_json_field field = {
        "orientation", "a quaternion [x, y, z, w] of about unit length", -1e3, 1e3, false};
    double q[4] = {out->x, out->y, out->z, out->w};
    rlf_result result = io_json_get_numbers(body, &field, q, 4);
    if (result != RLF_OK) {
        return result;
    }
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(norm > 0.9 && norm < 1.1)) {
        return io_json_fail(body, "orientation", "has the length %g: it must be %s", norm,
                            field.meaning);
    }
    rlf_quat quaternion = {q[0], q[1], q[2], q[3]};
    *out = rlf_quat_normalize(quaternion);
    return RLF_OK;
}
