/* Points of shapes by name. */
#include "relief/known.h"

#include <string.h>

/* -1, 0 or 1 for the first, second or third of three letters; 2 for none of them. */
static int32_t side_of(char c, const char *letters)
{
    for (int32_t i = 0; i < 3; i++) {
        if (c == letters[i]) {
            return i - 1;
        }
    }
    return 2;
}

static rlf_vec3 half_extents(const rlf_shape *s)
{
    double r = s->radius;
    switch (s->type) {
    case RLF_SHAPE_BOX: return rlf_scale(s->size, 0.5);
    case RLF_SHAPE_CAPSULE: return rlf_vec3_make(r, r + 0.5 * s->height, r);
    case RLF_SHAPE_CYLINDER: return rlf_vec3_make(r, 0.5 * s->height, r);
    case RLF_SHAPE_SPHERE:
    case RLF_SHAPE_HULL: break;
    }
    return rlf_vec3_make(r, r, r);
}

static bool vertex_of(const rlf_hull *hull, const char *digits, rlf_vec3 *out)
{
    int32_t index = 0;
    size_t length = strlen(digits);
    if (hull == NULL || length < 1 || length > 6) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        if (digits[i] < '0' || digits[i] > '9') {
            return false;
        }
        index = 10 * index + (digits[i] - '0');
    }
    if (index >= hull->vertex_count) {
        return false;
    }
    *out = hull->vertices[index];
    return true;
}

bool rlf_known_name_point(const rlf_shape *shape, const char *name, rlf_vec3 *out)
{
    if (!RLF_ASSERT(shape != NULL && name != NULL && out != NULL)) {
        return false;
    }
    if (shape->type == RLF_SHAPE_HULL) {
        return name[0] == 'v' && vertex_of(shape->hull, name + 1, out);
    }
    if (strlen(name) != 3) {
        return false;
    }
    int32_t x = side_of(name[0], "lcr"), y = side_of(name[1], "tcb"), z = side_of(name[2], "ncf");
    if (x > 1 || y > 1 || z > 1) {
        return false;
    }
    rlf_vec3 half = half_extents(shape);
    *out = rlf_vec3_make(x * half.x, y * half.y, z * half.z);
    return true;
}
