/* What a caller fills in is looked at where it enters: each number of each def, of a source's info
 * and of a frame in turn is no number, infinite or absurd. What is not finite is refused with a
 * line that names the field; of the rest nothing may crash or hang. The fields are read from the
 * headers, by tests/headers/def_fields.awk. Each struct has a process of its own. */

#define _DEFAULT_SOURCE 1 /* MAP_ANONYMOUS */
#include "count_assert.h"
#include "test.h"
#include "valid_arguments.h"

#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

typedef enum field_kind {
    FIELD_DOUBLE,
    FIELD_FLOAT,
    FIELD_INT32_T,
    FIELD_INT64_T,
    FIELD_ENUM
} field_kind;

typedef struct def_field {
    const char *path;
    size_t offset;
    field_kind kind;
} def_field;

#include "def_fields.h"

/* ---- one use of each struct ------------------------------------------------------------------ */

static rlf_source_info tried_info;
static rlf_frame tried_frame;

static rlf_result next_tried(void *self, rlf_frame *out)
{
    (void)self;
    *out = tried_frame;
    return RLF_OK;
}

static rlf_result try_info(const void *value)
{
    tried_info = *(const rlf_source_info *)value;
    const rlf_source_methods methods = {.next = next_tried};
    rlf_source *source = NULL;
    rlf_result result = rlf_source_create_custom(&methods, &tried_info, NULL, &source);
    rlf_source_destroy(&source);
    return result;
}

/* As a source gives it, and given to the stages itself. */
static rlf_result try_frame(const void *value)
{
    const rlf_source_methods methods = {.next = next_tried};
    rlf_source *source = NULL;
    rlf_frame out;
    tried_frame = *(const rlf_frame *)value;
    rlf_result result = rlf_source_create_custom(&methods, &valid.info, NULL, &source);
    if (result == RLF_OK) {
        result = rlf_source_next(source, &out);
    }
    rlf_source_destroy(&source);
    const rlf_surface *surface = NULL;
    const rlf_result processed = rlf_reconstruct_process(valid.reconstruct, &tried_frame, &surface);
    rlf_render_input input = valid.input;
    rlf_render_output picture;
    input.frame = &tried_frame;
    const rlf_result drawn = rlf_compositor_render(valid.compositor, &input, &picture);
    return processed != result || (drawn != result && drawn != RLF_OK) ? RLF_ERROR_DEVICE : result;
}

static rlf_result try_reconstruct(const void *def)
{
    rlf_reconstruct *stage = NULL;
    const rlf_surface *surface = NULL;
    rlf_result result = rlf_reconstruct_create(def, &stage);
    for (int i = 0; i < 2 && result == RLF_OK; i++) {
        result = rlf_reconstruct_process(stage, &valid.output.frame, &surface);
    }
    rlf_reconstruct_destroy(&stage);
    return result;
}

static rlf_result try_hand_tracker(const void *def)
{
    rlf_hand_tracker *tracker = NULL;
    rlf_result result = rlf_hand_tracker_create(def, &tracker);
    if (result == RLF_OK) {
        (void)rlf_hand_tracker_update(tracker, valid.output.surface);
    }
    rlf_hand_tracker_destroy(&tracker);
    return result;
}

static rlf_result try_map(const void *def)
{
    rlf_map *map = NULL;
    rlf_prediction seen;
    rlf_result result = rlf_map_create(def, &map);
    if (result == RLF_OK) {
        result = rlf_map_integrate(map, &valid.map_view, &valid.pose, NULL);
    }
    if (result == RLF_OK) {
        result = rlf_map_predict(map, &valid.rig.depth, &valid.pose, &seen);
    }
    rlf_map_destroy(&map);
    return result;
}

static rlf_result try_tracker(const void *def)
{
    rlf_tracker *tracker = NULL;
    rlf_track_result out;
    rlf_result result = rlf_tracker_create(def, &tracker);
    if (result == RLF_OK) {
        result =
            rlf_tracker_align(tracker, &valid.track_view, &valid.prediction, &valid.pose, &out);
    }
    rlf_tracker_destroy(&tracker);
    return result;
}

static rlf_result add_and_advance(const rlf_world_def *world_def, const rlf_body_def *body)
{
    rlf_world *world = NULL;
    rlf_result result = rlf_world_create(world_def, &world);
    if (result == RLF_OK) {
        result = rlf_world_add_body(world, body, NULL);
    }
    if (result == RLF_OK) {
        rlf_world_advance(world, &valid.grid, 1.0 / 30.0);
    }
    rlf_world_destroy(&world);
    return result;
}

static rlf_result try_world(const void *def)
{
    return add_and_advance(def, &valid.body_def);
}

static rlf_result try_body(const void *def)
{
    return add_and_advance(&valid.world_def, def);
}

static rlf_result try_known(const void *def)
{
    rlf_known_fit fit;
    return rlf_known_solve(def, &valid.known_view, &fit);
}

static rlf_result try_compositor(const void *def)
{
    rlf_compositor *compositor = NULL;
    rlf_render_output picture;
    rlf_result result = rlf_compositor_create_soft(def, &compositor);
    if (result == RLF_OK) {
        result = rlf_compositor_render(compositor, &valid.input, &picture);
    }
    rlf_compositor_destroy(&compositor);
    return result;
}

static rlf_result try_pipeline(const void *def)
{
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output out;
    rlf_result result = rlf_pipeline_create(def, &pipeline);
    if (result == RLF_OK) {
        result = rlf_pipeline_step(pipeline, &out);
    }
    rlf_pipeline_destroy(&pipeline);
    return result;
}

static rlf_result try_synthetic(const void *def)
{
    rlf_source *source = NULL;
    rlf_result result = rlf_synthetic_create(def, &source);
    rlf_source_destroy(&source);
    return result;
}

/* ---- all of them ----------------------------------------------------------------------------- */

/* Numbers that count for another choice only: of a box, of depth in metres, of one scene. */
static const char *const unused[] = {"shape.radius", "shape.height", "points[",
                                     "depth_units_per_metre"};
/* Numbers that are data, told where they are used: the pose that a source says. */
static const char *const data[] = {"rlf_frame.T_world_camera"};
/* Parts of a pipeline's def that have a def of their own here. */
static const char *const parts[] = {"reconstruct.", "world.", "compositor."};

typedef struct def_try {
    const char *name;
    const void *value;
    size_t size;
    const def_field *fields;
    int count;
    rlf_result (*make)(const void *value);
} def_try;

#define TRY(type, value, make)                                                                     \
    {                                                                                              \
        #type, value, sizeof(type), fields_##type, COUNT_##type, make                              \
    }

static const def_try tries[] = {
    TRY(rlf_source_info, &valid.info, try_info),
    TRY(rlf_frame, &valid.output.frame, try_frame),
    TRY(rlf_reconstruct_def, &valid.reconstruct_def, try_reconstruct),
    TRY(rlf_hand_tracker_def, &valid.hand_tracker_def, try_hand_tracker),
    TRY(rlf_map_def, &valid.map_def, try_map),
    TRY(rlf_tracker_def, &valid.tracker_def, try_tracker),
    TRY(rlf_world_def, &valid.world_def, try_world),
    TRY(rlf_body_def, &valid.body_def, try_body),
    TRY(rlf_known_def, &valid.known_def, try_known),
    TRY(rlf_compositor_def, &valid.compositor_def, try_compositor),
    TRY(rlf_pipeline_def, &valid.pipeline_def, try_pipeline),
    TRY(rlf_synthetic_def, &valid.synthetic_def, try_synthetic),
};

static const double absurd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, -1.0, 0.0};
#define ABSURD_COUNT 7
static const int64_t absurd_counts[] = {-1, 0, INT32_MIN, INT32_MAX};
#define ABSURD_COUNTS 4

/* The part of a path that says most: the last that is no coordinate, without its index. */
static void name_of(const char *path, char *out, size_t size)
{
    char copy[128];
    (void)snprintf(copy, sizeof(copy), "%s", path);
    char *last = strrchr(copy, '.');
    while (last != NULL && (strlen(last) == 2 || strcmp(last, ".min") == 0 ||
                            strcmp(last, ".max") == 0)) { /* .x, .q */
        *last = '\0';
        last = strrchr(copy, '.');
    }
    (void)snprintf(out, size, "%s", last != NULL ? last + 1 : copy);
    out[strcspn(out, "[")] = '\0';
}

static void set_field(void *value, const def_field *field, int k)
{
    void *place = (char *)value + field->offset;
    const float f = (float)absurd[k];
    const int32_t count = (int32_t)absurd_counts[k % ABSURD_COUNTS];
    const int64_t wides[ABSURD_COUNTS] = {-1, 0, INT64_MIN, INT64_MAX};
    const int64_t wide = wides[k % ABSURD_COUNTS];
    switch (field->kind) {
    case FIELD_DOUBLE: memcpy(place, &absurd[k], sizeof(double)); break;
    case FIELD_FLOAT: memcpy(place, &f, sizeof(f)); break;
    case FIELD_INT32_T: memcpy(place, &count, sizeof(count)); break;
    case FIELD_INT64_T: memcpy(place, &wide, sizeof(wide)); break;
    case FIELD_ENUM: memcpy(place, &count, sizeof(count)); break;
    }
}

static bool begins_with(const char *path, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strncmp(path, list[i], strlen(list[i])) == 0) {
            return true;
        }
    }
    return false;
}

/* What was tried last, for a process that ends. */
static char *tried;

static int try_field(const def_try *t, const def_field *field)
{
    int wrong = 0;
    const bool is_real = field->kind == FIELD_DOUBLE || field->kind == FIELD_FLOAT;
    for (int k = 0; k < (is_real ? ABSURD_COUNT : ABSURD_COUNTS); k++) {
        char value[16384], name[128];
        assert_true(t->size <= sizeof(value));
        memcpy(value, t->value, t->size);
        set_field(value, field, k);
        (void)snprintf(tried, 256, "%s.%s, value %d", t->name, field->path, k);
        alarm(20);
        rlf_fail(RLF_OK, "no line");
        const rlf_result result = t->make(value);
        name_of(field->path, name, sizeof(name));
        const bool must_refuse =
            is_real && k < 3 &&
            !begins_with(field->path, unused, sizeof(unused) / sizeof(unused[0])) &&
            !begins_with(tried, data, sizeof(data) / sizeof(data[0]));
        if ((must_refuse && result != RLF_ERROR_INVALID) ||
            (result < 0 && result != RLF_ERROR_MEMORY && strstr(rlf_error_text(), name) == NULL)) {
            print_error("%s.%s, value %d (%g): result %d, '%s'\n", t->name, field->path, k,
                        is_real ? absurd[k] : (double)absurd_counts[k % ABSURD_COUNTS], (int)result,
                        rlf_error_text());
            wrong++;
        }
    }
    return wrong;
}

static int try_all_fields(const def_try *t)
{
    int wrong = 0, count = 0;
    rlf_set_assert(count_assert, &count);
    for (int i = 0; i < t->count; i++) {
        if (!begins_with(t->fields[i].path, parts, sizeof(parts) / sizeof(parts[0]))) {
            wrong += try_field(t, &t->fields[i]);
        }
    }
    return wrong < 100 ? wrong : 100;
}

TEST_CASE(no_number_of_a_def_goes_unchecked)
{
    int wrong = 0;
    for (size_t i = 0; i < sizeof(tries) / sizeof(tries[0]); i++) {
        fflush(NULL);
        const pid_t child = fork();
        if (child == 0) {
            const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}; /* cmocka's own */
            for (int k = 0; k < 5; k++) {
                signal(crashes[k], SIG_DFL);
            }
            const int bad = try_all_fields(&tries[i]);
            fflush(NULL);
            _exit(bad);
        }
        int status = 0;
        assert_int_equal(waitpid(child, &status, 0), child);
        if (!WIFEXITED(status) || WEXITSTATUS(status) > 100) {
            print_error("%s ends the program (%d)\n", tried, status);
        }
        wrong += status != 0;
    }
    assert_int_equal(wrong, 0);
}

static int set_up(void **state)
{
    (void)state;
    mkdir("def_fields", 0777);
    tried = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (tried == MAP_FAILED || chdir("def_fields") != 0 || !valid_make()) {
        print_error("%s\n", rlf_error_text());
        return -1;
    }
    valid.output.frame.has_pose = true;
    valid.output.frame.T_world_camera = valid.pose;
    return 0;
}

TEST_GROUP(set_up, NULL)
