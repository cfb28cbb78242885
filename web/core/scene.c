/* Scenes and bodies as a page writes them: numbers at an address, in the order of PAGE_BODY. */
#include "page.h"

#include <string.h>

/* Places of a body's numbers; relief.js has the same list. */
enum {
    TYPE = 0,
    SIZE = 1,
    RADIUS = 4,
    HEIGHT = 5,
    MASS = 6,
    POSITION = 7,
    ORIENTATION = 10,
    VELOCITY = 14,
    SPIN = 17,
    RESTITUTION = 20,
    FRICTION = 21,
    GRAVITY_SCALE = 22,
    RELEASE = 23,
    COLLIDES = 24,
    ROLLING = 25,
    LINEAR_DAMPING = 26,
    ANGULAR_DAMPING = 27,
    KINEMATIC = 28,
    COLOR = 29,
    BODY_NUMBERS = 32
};

enum { BODIES_MAX = 65536, HULL_VERTICES_MAX = 4096, HULL_TRIANGLES_MAX = 8192 };

static double body[BODY_NUMBERS];
static rlf_scene scene;
static int32_t capacity;
static rlf_hull *hull; /* of the next bodies of type hull; the scene's once one has it */

/* ---- a body ------------------------------------------------------------------------------------
 */

static void put3(int32_t at, rlf_vec3 v)
{
    body[at] = v.x;
    body[at + 1] = v.y;
    body[at + 2] = v.z;
}

static rlf_vec3 get3(int32_t at)
{
    return rlf_vec3_make(body[at], body[at + 1], body[at + 2]);
}

/* Where the page writes a body, filled with the defaults. */
double *EXPORT(relief_body_in)(void)
{
    const rlf_body_def d = rlf_body_def_default();
    memset(body, 0, sizeof(body));
    body[TYPE] = d.shape.type;
    body[MASS] = d.mass;
    body[ORIENTATION + 3] = 1.0;
    body[RESTITUTION] = d.restitution;
    body[FRICTION] = d.friction;
    body[GRAVITY_SCALE] = d.gravity_scale;
    body[COLLIDES] = d.collides_with_bodies;
    put3(SIZE, d.shape.size);
    put3(POSITION, d.position);
    put3(COLOR, rlf_vec3_make((double)d.color[0], (double)d.color[1], (double)d.color[2]));
    return body;
}

static void read_material(rlf_body_def *def)
{
    def->mass = body[MASS];
    def->restitution = body[RESTITUTION];
    def->friction = body[FRICTION];
    def->gravity_scale = body[GRAVITY_SCALE];
    def->release_time = body[RELEASE];
    def->collides_with_bodies = body[COLLIDES] != 0.0;
    def->rolling_resistance = body[ROLLING];
    def->linear_damping = body[LINEAR_DAMPING];
    def->angular_damping = body[ANGULAR_DAMPING];
    def->is_kinematic = body[KINEMATIC] != 0.0;
    for (int i = 0; i < 3; i++) {
        def->color[i] = (float)body[COLOR + i];
    }
}

rlf_body_def page_body_read(void)
{
    rlf_body_def def = rlf_body_def_default();
    const double *q = body + ORIENTATION;
    def.shape.type = (rlf_shape_type)body[TYPE];
    def.shape.size = get3(SIZE);
    def.shape.radius = body[RADIUS];
    def.shape.height = body[HEIGHT];
    def.shape.hull = def.shape.type == RLF_SHAPE_HULL ? hull : NULL;
    def.position = get3(POSITION);
    def.orientation = rlf_quat_normalize((rlf_quat){q[0], q[1], q[2], q[3]});
    def.velocity = get3(VELOCITY);
    def.angular_velocity = get3(SPIN);
    read_material(&def);
    return def;
}

/* ---- a scene -----------------------------------------------------------------------------------
 */

static bool is_hull_used(void)
{
    return scene.body_count > 0 && scene.bodies[scene.body_count - 1].shape.hull == hull;
}

static void drop_hull(void)
{
    if (hull != NULL && !is_hull_used()) {
        rlf_free(hull);
    }
    hull = NULL;
}

/* Begins the page's own scene. gravity_kind: 0 the default, 1 the three numbers, 2 "floor". */
void EXPORT(relief_scene_begin)(int32_t gravity_kind, double x, double y, double z, int32_t is_open)
{
    drop_hull();
    rlf_scene_destroy(&scene);
    capacity = 0;
    scene.gravity = gravity_kind == 1 ? rlf_vec3_make(x, y, z) : rlf_world_def_default().gravity;
    scene.is_gravity_given = gravity_kind > 0;
    scene.finds_gravity = gravity_kind == 2;
    scene.border = is_open != 0 ? RLF_BORDER_OPEN : RLF_BORDER_EXTEND;
}

/* A hull for the bodies that follow. Returns where its vertices go (three doubles each), and behind
 * them its triangles (three int32 each); 0 = out of memory or too many. */
double *EXPORT(relief_scene_hull)(int32_t vertices, int32_t triangles)
{
    drop_hull();
    if (vertices < 4 || triangles < 4 || vertices > HULL_VERTICES_MAX ||
        triangles > HULL_TRIANGLES_MAX) {
        (void)rlf_fail(RLF_ERROR_INVALID, "hull: %d vertices, %d triangles: 4 to %d and %d",
                       (int)vertices, (int)triangles, HULL_VERTICES_MAX, HULL_TRIANGLES_MAX);
        return NULL;
    }
    const size_t place = sizeof(rlf_hull) + (size_t)vertices * sizeof(rlf_vec3);
    uint8_t *block = rlf_alloc(place + 3 * (size_t)triangles * sizeof(int32_t));
    if (block == NULL) {
        return NULL;
    }
    hull = (rlf_hull *)(void *)block;
    *hull = (rlf_hull){.vertices = (const rlf_vec3 *)(void *)(block + sizeof(rlf_hull)),
                       .vertex_count = vertices,
                       .triangles = (const int32_t *)(void *)(block + place),
                       .triangle_count = triangles};
    return (double *)(void *)(block + sizeof(rlf_hull));
}

static rlf_result reserve(void)
{
    if (scene.body_count < capacity) {
        return RLF_OK;
    }
    if (scene.body_count == BODIES_MAX) {
        return rlf_fail(RLF_ERROR_INVALID, "a scene has at most %d bodies", BODIES_MAX);
    }
    const int32_t more = capacity > 0 ? 2 * capacity : 16;
    rlf_body_def *bodies = rlf_alloc_array((size_t)more, sizeof(*bodies));
    if (bodies == NULL) {
        return RLF_ERROR_MEMORY;
    }
    if (scene.body_count > 0) {
        memcpy(bodies, scene.bodies, (size_t)scene.body_count * sizeof(*bodies));
    }
    rlf_free(scene.bodies);
    scene.bodies = bodies;
    capacity = more;
    return RLF_OK;
}

/* Adds the body at relief_body_in. Returns an rlf_result. */
int32_t EXPORT(relief_scene_add)(void)
{
    const rlf_result result = reserve();
    if (result == RLF_OK) {
        scene.bodies[scene.body_count++] = page_body_read();
    }
    return result;
}

rlf_result page_scene_make(page_scene kind, rlf_scene *out)
{
    memset(out, 0, sizeof(*out));
    if (kind == PAGE_SCENE_CUBES) {
        return rlf_scene_create_two_cubes(out);
    }
    if (kind == PAGE_SCENE_OWN) {
        *out = scene;
        drop_hull();
        memset(&scene, 0, sizeof(scene));
        capacity = 0;
    }
    return RLF_OK;
}
