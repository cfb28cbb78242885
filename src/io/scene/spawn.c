/* scene.json's spawn patterns: many bodies from one. */
#include "io/scene/reader.h"
#include "io/scene/pattern.h"

#include <string.h>

#define COLORS_MAX 64
#define PREFIX_MAX 52 /* bytes of a name that a number is put behind */

typedef struct spawn {
    io_pattern pattern;
    rlf_vec3 velocity_spread, spin_spread;
    double interval;
    bool is_turned;
    float colors[COLORS_MAX][3]; /* taken in turn */
    size_t color_count;          /* 0: the body's own */
} spawn;

/* ---- pattern -------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    io_pattern_kind kind;
    const char *key; /* that says how large it is */
} patterns[] = {{"grid", IO_PATTERN_GRID, "spacing"},
                {"stack", IO_PATTERN_STACK, "spacing"},
                {"ring", IO_PATTERN_RING, "radius"},
                {"random", IO_PATTERN_RANDOM, "box"}};

/* A key that belongs to another pattern would be ignored silently. */
static rlf_result check_pattern_keys(const io_json_object *entry, const char *name, const char *own)
{
    static const char *const keys[3] = {"spacing", "radius", "box"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(keys[i], own) != 0 && json_object_get(entry->value, keys[i]) != NULL) {
            return io_json_fail(entry, keys[i],
                                "does not belong to the pattern \"%s\": take it out", name);
        }
    }
    return RLF_OK;
}

static rlf_result read_kind(const io_json_object *entry, io_pattern_kind *out)
{
    static const io_json_field field = {"pattern", "\"grid\", \"stack\", \"ring\" or \"random\"", 0,
                                        0, true};
    const char *name = "";
    rlf_result result = io_json_get_text(entry, &field, &name);
    if (result != RLF_OK) {
        return result;
    }
    for (size_t i = 0; i < sizeof(patterns) / sizeof(patterns[0]); i++) {
        if (strcmp(name, patterns[i].name) == 0) {
            *out = patterns[i].kind;
            return check_pattern_keys(entry, name, patterns[i].key);
        }
    }
    return io_json_fail(entry, "pattern", "is \"%.60s\": it must be %s", name, field.meaning);
}

/* A grid's three numbers, or one. */
static rlf_result read_count(const io_json_object *entry, const rlf_scene *scene, io_pattern *out)
{
    static const io_json_field three = {
        "count", "three whole numbers, each 1 to 65536: bodies along x, y and z", 1,
        IO_SCENE_BODIES_MAX, true};
    static const io_json_field one = {"count", "a whole number, 1 to 65536", 1, IO_SCENE_BODIES_MAX,
                                      true};
    double n[3] = {1, 1, 1};
    bool is_grid = out->kind == IO_PATTERN_GRID;
    rlf_result result =
        is_grid ? io_json_get_numbers(entry, &three, n, 3) : io_json_get_number(entry, &one, n);
    if (result != RLF_OK) {
        return result;
    }
    for (int i = 0; i < 3; i++) {
        out->along[i] = (int32_t)n[i];
        if (out->along[i] != n[i]) {
            return io_json_fail(entry, "count", "is %g: it must be %s", n[i],
                                is_grid ? three.meaning : one.meaning);
        }
    }
    double total = n[0] * n[1] * n[2];
    if (scene->body_count + total > IO_SCENE_BODIES_MAX) {
        return io_json_fail(entry, "count", "makes %.0f bodies, with those before it: at most %d",
                            scene->body_count + total, IO_SCENE_BODIES_MAX);
    }
    out->count = (int32_t)total;
    return RLF_OK;
}

static rlf_result read_box(const io_json_object *entry, io_pattern *out)
{
    static const io_json_field box = {
        "box", "three full extents in metres, each >= 0 and at most 1000", 0, 1000, true};
    rlf_result result = io_json_get_vec3(entry, &box, &out->box);
    double longest = rlf_max(rlf_max(out->box.x, out->box.y), out->box.z);
    if (result == RLF_OK && out->count > 1 && !(longest > 1e-6)) {
        return io_json_fail(entry, "box", "is a point: %d bodies need room", (int)out->count);
    }
    return result;
}

/* How large it is. */
static rlf_result read_extent(const io_json_object *entry, io_pattern *out)
{
    static const io_json_field three = {
        "spacing", "three numbers of metres between centres, each > 0 and at most 100", IO_POSITIVE,
        100, true};
    static const io_json_field one = {"spacing",
                                      "a number of metres between centres, > 0 and at most 100",
                                      IO_POSITIVE, 100, true};
    static const io_json_field radius = {"radius", "a number of metres, > 0 and at most 1000",
                                         IO_POSITIVE, 1000, true};
    switch (out->kind) {
    case IO_PATTERN_GRID: return io_json_get_vec3(entry, &three, &out->spacing);
    case IO_PATTERN_STACK: return io_json_get_number(entry, &one, &out->spacing.y);
    case IO_PATTERN_RING: return io_json_get_number(entry, &radius, &out->radius);
    case IO_PATTERN_RANDOM: break;
    }
    return read_box(entry, out);
}

/* Against gravity as the file has it; up in the picture where it has none. */
static rlf_vec3 find_up(const rlf_scene *scene)
{
    double strength = rlf_length(scene->gravity);
    return strength > 0.0 ? rlf_scale(scene->gravity, -1.0 / strength) : rlf_vec3_make(0, -1, 0);
}

static rlf_result read_pattern(const io_json_object *entry, const rlf_scene *scene, io_pattern *out)
{
    static const io_json_field seed = {"seed", "a whole number, 0 to 2147483647", 0, INT32_MAX,
                                       false};
    rlf_result result = read_kind(entry, &out->kind);
    result = result == RLF_OK ? read_count(entry, scene, out) : result;
    result = result == RLF_OK ? read_extent(entry, out) : result;
    result = result == RLF_OK ? io_json_get_integer(entry, &seed, &out->seed) : result;
    out->up = find_up(scene);
    return result;
}

/* ---- what differs from body to body --------------------------------------------------------- */

static rlf_result read_colors(const io_json_object *entry, spawn *out)
{
    const json_t *list = json_object_get(entry->value, "colors");
    size_t count = json_array_size(list);
    if (list == NULL) {
        return RLF_OK;
    }
    if (count < 1 || count > COLORS_MAX) {
        return io_json_fail(entry, "colors", "must be an array of 1 to %d colours", COLORS_MAX);
    }
    for (size_t i = 0; i < count; i++) {
        const json_t *color = json_array_get(list, i);
        bool is_color = json_array_size(color) == 3;
        for (size_t k = 0; k < 3 && is_color; k++) {
            const json_t *part = json_array_get(color, k);
            double value = json_number_value(part);
            is_color = json_is_number(part) && value >= 0.0 && value <= 1.0;
            out->colors[i][k] = (float)value;
        }
        if (!is_color) {
            return io_json_fail(entry, "colors",
                                "[%zu] must be three numbers from 0 to 1 (red, green, blue)", i);
        }
    }
    out->color_count = count;
    return RLF_OK;
}

static rlf_result read_variety(const io_json_object *entry, spawn *out)
{
    static const io_json_field velocity = {
        "velocity_spread", "three numbers of m/s, each >= 0 and at most 1000", 0, 1000, false};
    static const io_json_field spin = {"angular_velocity_spread",
                                       "three numbers of rad/s, each >= 0 and at most 1000", 0,
                                       1000, false};
    static const io_json_field interval = {"interval", "a number of seconds, >= 0 and at most 1e6",
                                           0, 1e6, false};
    static const io_json_field turned = {"turned", "true or false", 0, 0, false};
    rlf_result result = io_json_get_vec3(entry, &velocity, &out->velocity_spread);
    result = result == RLF_OK ? io_json_get_vec3(entry, &spin, &out->spin_spread) : result;
    result = result == RLF_OK ? io_json_get_number(entry, &interval, &out->interval) : result;
    result = result == RLF_OK ? io_json_get_bool(entry, &turned, &out->is_turned) : result;
    return result == RLF_OK ? read_colors(entry, out) : result;
}

/* All numbers are drawn, needed or not: a key changes nothing but what it is for. */
static void vary_body(const spawn *s, int32_t index, rlf_body_def *def)
{
    io_random r = io_random_make(s->pattern.seed, index);
    rlf_quat orientation = io_random_turn(&r);
    def->orientation = s->is_turned ? orientation : def->orientation;
    def->velocity = rlf_add(def->velocity, io_random_about(&r, s->velocity_spread));
    def->angular_velocity = rlf_add(def->angular_velocity, io_random_about(&r, s->spin_spread));
    def->release_time += index * s->interval;
    if (s->color_count > 0) {
        memcpy(def->color, s->colors[(size_t)index % s->color_count], sizeof(def->color));
    }
}

/* ---- the bodies ----------------------------------------------------------------------------- */

/* The scene's last body becomes the first of the pattern. */
static rlf_result place_bodies(const io_json_object *body, io_scene_reader *reader, const spawn *s,
                               const rlf_vec3 *places)
{
    rlf_scene *scene = reader->scene;
    const rlf_body_def base = scene->bodies[scene->body_count - 1];
    rlf_result result = RLF_OK;
    for (int32_t i = 0; i < s->pattern.count && result == RLF_OK; i++) {
        scene->body_count += i > 0 ? 1 : 0;
        rlf_body_def *def = &scene->bodies[scene->body_count - 1];
        *def = base;
        def->position = rlf_add(base.position, places[i]);
        vary_body(s, i, def);
        if (base.name[0] != '\0') {
            (void)snprintf(def->name, sizeof(def->name), "%.*s_%04d", PREFIX_MAX, base.name,
                           (int)i + 1);
        }
        result = io_scene_note_body(body, reader);
    }
    return result;
}

static rlf_result read_body(const io_json_object *entry, io_scene_reader *reader, spawn *s)
{
    static const io_json_field field = {"body", "an object as in \"bodies\"", 0, 0, true};
    io_json_object body;
    rlf_result result = io_json_get_object(entry, &field, &body);
    result = result == RLF_OK ? io_scene_reserve(reader, s->pattern.count) : result;
    result = result == RLF_OK ? io_scene_read_body(&body, reader) : result;
    if (result != RLF_OK) {
        return result;
    }
    const rlf_body_def *def = &reader->scene->bodies[reader->scene->body_count - 1];
    if (strlen(def->name) > PREFIX_MAX) {
        return io_json_fail(&body, "name", "has %zu bytes: with a number behind it, at most %d",
                            strlen(def->name), PREFIX_MAX);
    }
    s->pattern.reach = rlf_shape_radius(&def->shape);
    rlf_vec3 *places = rlf_alloc_array((size_t)s->pattern.count, sizeof(*places));
    result = places != NULL ? io_pattern_place(&s->pattern, places) : RLF_ERROR_MEMORY;
    result = result == RLF_OK ? place_bodies(&body, reader, s, places) : result;
    rlf_free(places);
    return result;
}

static rlf_result read_entry(const io_json_object *entry, io_scene_reader *reader, int32_t index)
{
    static const char *const known[] = {
        "body",   "pattern",  "count", "spacing",         "radius",
        "box",    "interval", "seed",  "velocity_spread", "angular_velocity_spread",
        "turned", "colors"};
    const char *unknown = io_json_unknown_key(entry, known, sizeof(known) / sizeof(known[0]));
    if (unknown != NULL) {
        return io_json_fail(entry, unknown, "is not a known key: see the list in docs/formats.md");
    }
    spawn s;
    memset(&s, 0, sizeof(s));
    s.pattern.seed = index;
    rlf_result result = read_pattern(entry, reader->scene, &s.pattern);
    result = result == RLF_OK ? read_variety(entry, &s) : result;
    return result == RLF_OK ? read_body(entry, reader, &s) : result;
}

rlf_result io_spawn_read(const io_json_object *top, io_scene_reader *reader)
{
    const json_t *list = json_object_get(top->value, "spawn");
    size_t count = json_array_size(list);
    if (list == NULL) {
        return RLF_OK;
    }
    if (!json_is_array(list) || count > IO_SCENE_BODIES_MAX) {
        return io_json_fail(top, "spawn", "must be an array of at most %d objects",
                            IO_SCENE_BODIES_MAX);
    }
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < count && result == RLF_OK; i++) {
        io_json_object entry = {.file = top->file, .value = json_array_get(list, i)};
        snprintf(entry.path, sizeof(entry.path), "spawn[%zu]", i);
        result = json_is_object(entry.value) ? read_entry(&entry, reader, (int32_t)i)
                                             : io_json_fail(&entry, "", "must be an object {...}");
    }
    return result;
}
