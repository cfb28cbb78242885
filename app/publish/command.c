/* What a command may ask for, whichever way it came. */
#include "publish/inside.h"

#include <stdio.h>
#include <string.h>

/* Bounds of what strangers may throw: from a pea to a wardrobe, within a hall. */
#define SIZE_MIN_M 0.01
#define SIZE_MAX_M 2.0
#define PLACE_MAX_M 20.0 /* a world's default bounds */
#define SPEED_MAX 50.0   /* m/s, a world's default */
#define TURN_MAX 100.0   /* rad/s */
#define MASS_MAX_KG 1000.0
#define GRAVITY_MAX 1000.0 /* m/s^2, as --gravity's */
#define FRICTION_MAX 10.0

#define BALSA 115.0     /* kg/m^3, of the box around it, as the window's bodies */
#define THROW_SPEED 4.0 /* m/s, as the window's */
#define THROW_START_M 0.35

static const char *const verbs[PUBLISH_VERB_COUNT] = {"spawn",   "throw",  "remove", "clear",
                                                      "gravity", "record", "scene",  "hello"};

const char *publish_verb_name(publish_verb verb)
{
    return verbs[verb];
}

bool publish_command_begin(const char *name, publish_command *out)
{
    memset(out, 0, sizeof *out);
    out->body = rlf_body_def_default();
    out->body.mass = 0.0;
    for (int i = 0; i < PUBLISH_VERB_COUNT; i++) {
        if (strcmp(name, verbs[i]) == 0) {
            out->verb = (publish_verb)i;
            if (out->verb == PUBLISH_THROW) {
                out->body.position = rlf_vec3_make(0.0, 0.0, THROW_START_M);
                out->body.velocity = rlf_vec3_make(0.0, 0.0, THROW_SPEED);
            }
            return true;
        }
    }
    return false;
}

bool publish_command_shape(publish_command *c, const char *shape, double size_m)
{
    static const char *const names[4] = {"box", "sphere", "capsule", "cylinder"};
    rlf_shape *s = &c->body.shape;
    for (int i = 0; i < 4; i++) {
        if (strcmp(shape, names[i]) == 0) {
            const bool is_capsule = i == RLF_SHAPE_CAPSULE;
            *s = (rlf_shape){.type = (rlf_shape_type)i,
                             .size = rlf_vec3_make(size_m, size_m, size_m),
                             .radius = is_capsule ? 0.25 * size_m : 0.5 * size_m,
                             .height = is_capsule ? 0.5 * size_m : size_m};
            return true;
        }
    }
    return false;
}

static bool is_short(rlf_vec3 v, double most)
{
    return rlf_vec3_is_finite(v) && rlf_length(v) <= most;
}

static bool is_size(double x)
{
    return x >= SIZE_MIN_M && x <= SIZE_MAX_M; /* false for NaN */
}

/* Its sides, metres. */
static rlf_vec3 sides(const rlf_shape *s)
{
    const double width = 2.0 * s->radius;
    switch (s->type) {
    case RLF_SHAPE_BOX: return s->size;
    case RLF_SHAPE_CAPSULE: return rlf_vec3_make(width, s->height + width, width);
    case RLF_SHAPE_CYLINDER: return rlf_vec3_make(width, s->height, width);
    case RLF_SHAPE_SPHERE:
    case RLF_SHAPE_HULL: break;
    }
    return rlf_vec3_make(width, width, width);
}

/* Bytes that a name may have: what a terminal prints. */
static bool is_printable(const char *name)
{
    for (const char *c = name; *c != '\0'; c++) {
        if (*c < ' ' || *c > '~') {
            return false;
        }
    }
    return true;
}

static const char *wrong_of_body(publish_command *c)
{
    rlf_body_def *b = &c->body;
    const rlf_vec3 s = sides(&b->shape);
    const bool has_colors = b->color[0] >= 0.0f && b->color[0] <= 1.0f && b->color[1] >= 0.0f &&
                            b->color[1] <= 1.0f && b->color[2] >= 0.0f && b->color[2] <= 1.0f;
    if (!is_size(s.x) || !is_size(s.y) || !is_size(s.z) ||
        (b->shape.type == RLF_SHAPE_CAPSULE && !(b->shape.height > 0.0))) {
        return "size: use 0.01 to 2 metres";
    }
    b->mass = b->mass == 0.0 ? BALSA * s.x * s.y * s.z : b->mass;
    return !is_short(b->position, PLACE_MAX_M)          ? "position: within 20 metres"
           : !is_short(b->velocity, SPEED_MAX)          ? "velocity: at most 50 m/s"
           : !is_short(b->angular_velocity, TURN_MAX)   ? "angular_velocity: at most 100 rad/s"
           : !(b->mass > 0.0 && b->mass <= MASS_MAX_KG) ? "mass: above 0, at most 1000 kg"
           : !(b->restitution >= 0.0 && b->restitution <= 1.0)    ? "restitution: use 0 to 1"
           : !(b->friction >= 0.0 && b->friction <= FRICTION_MAX) ? "friction: use 0 to 10"
           : !has_colors            ? "color: three numbers from 0 to 1"
           : !is_printable(b->name) ? "name: use plain letters"
                                    : NULL;
}

bool publish_command_check(publish_command *c, char error[PUBLISH_ERROR_SIZE])
{
    const char *wrong = NULL;
    if (c->verb == PUBLISH_SPAWN || c->verb == PUBLISH_THROW) {
        wrong = wrong_of_body(c);
    } else if (c->verb == PUBLISH_GRAVITY && !is_short(c->gravity, GRAVITY_MAX)) {
        wrong = "at most 1000 m/s^2";
    } else if (c->verb == PUBLISH_REMOVE || c->verb == PUBLISH_SCENE) {
        wrong = c->name[0] == '\0' || !is_printable(c->name) ? "name: use plain letters" : NULL;
    }
    if (wrong != NULL) {
        (void)snprintf(error, PUBLISH_ERROR_SIZE, "%s: %s", verbs[c->verb], wrong);
    }
    return wrong == NULL;
}
