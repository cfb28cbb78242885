/* Milliseconds of registration and of whole composites by the CPU renderer, on one thread: least,
 * median and 95th percentile of many pictures of a wall with a strip before it, and of a floor; and
 * how long the bytes take that any renderer must move. Prints one row each; with --json FILE writes
 * them too. */
#include "model_sample.h"
#include "render/finish.h"
#include "render/probe.h"
#include "render_scene.h"

#include <stdio.h>

#define REPEATS 61
#define BODY_COUNT 100
#define FLOOR_M 0.9 /* below the camera */
#define ROW_MAX 32

typedef struct row {
    char name[64];
    double least, median, p95;
} row;

typedef struct report {
    row rows[ROW_MAX];
    int count;
} report;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

static void add_row(report *r, const char *name, double times[REPEATS])
{
    if (r->count < ROW_MAX) {
        qsort(times, REPEATS, sizeof(*times), compare);
        row *new_row = &r->rows[r->count++];
        *new_row = (row){.least = times[0],
                         .median = times[REPEATS / 2],
                         .p95 = times[(REPEATS - 1) * 95 / 100]};
        snprintf(new_row->name, sizeof(new_row->name), "%s", name);
        printf("%-44s %8.3f %8.3f %8.3f\n", name, new_row->least, new_row->median, new_row->p95);
    }
}

static void measure_registration(report *r, render_scene *s, const char *name)
{
    rlf_registration *registration = NULL;
    if (rlf_registration_create(&s->grid, s->ray_x, s->ray_y, &s->rig.color, &s->rig.T_color_depth,
                                &registration) != RLF_OK) {
        return;
    }
    int32_t width = s->rig.color.width;
    int32_t height = s->rig.color.height;
    size_t pixels = (size_t)width * (size_t)height;
    rlf_plane_f32 z = {malloc(pixels * sizeof(float)), width, height,
                       width * (ptrdiff_t)sizeof(float)};
    rlf_plane_u8 state = {malloc(pixels), width, height, width};
    double times[REPEATS] = {0};
    for (int i = 0; i < REPEATS && z.data != NULL && state.data != NULL; i++) {
        int64_t start = rlf_clock_ns();
        rlf_registration_apply(registration, s->planes[PLANE_DEPTH], &z, &state);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    add_row(r, name, times);
    free(z.data);
    free(state.data);
    rlf_registration_destroy(&registration);
}

static void measure_composite(report *r, render_scene *s, rlf_occlusion occlusion, const char *what)
{
    char name[64];
    rlf_compositor_def def = scene_def(s);
    def.occlusion = occlusion;
    rlf_compositor *compositor = NULL;
    rlf_render_output out;
    if (rlf_compositor_create_soft(&def, &compositor) != RLF_OK) {
        return;
    }
    double times[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        int64_t start = rlf_clock_ns();
        s->frame.sequence++;
        rlf_compositor_render(compositor, &s->input, &out);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    const char *const modes[4] = {"hard", "thesis", "off", "soft"};
    snprintf(name, sizeof(name), "%dx%d %s, %d %s", (int)s->rig.color.width,
             (int)s->rig.color.height, modes[occlusion], (int)s->snapshot.body_count, what);
    add_row(r, name, times);
    rlf_compositor_destroy(&compositor);
}

static void fill_bodies(rlf_body_state bodies[BODY_COUNT], rlf_shape shape, double spacing)
{
    for (int i = 0; i < BODY_COUNT; i++) {
        rlf_vec3 axis = rlf_normalize(rlf_vec3_make(1, i % 5, 2));
        bodies[i] = (rlf_body_state){.shape = shape, .mass = 1, .color = {0.9f, 0.5f, 0.2f}};
        bodies[i].T_world_body.p =
            rlf_vec3_make((i % 10 - 4.5) * spacing, (i / 10 - 4.5) * 0.7 * spacing, 1.8 + 0.01 * i);
        bodies[i].T_world_body.q = rlf_quat_from_axis_angle(axis, i);
    }
}

/* The same scene for a colour camera of twice the pixels on each side. */
static bool enlarge(render_scene *s)
{
    s->rig.color = rlf_camera_resize(&s->rig.color, 1920, 1080);
    free(s->color);
    s->color = malloc((size_t)1920 * 1080 * 4);
    if (s->color == NULL) {
        return false;
    }
    scene_fill_color(s);
    s->frame.color = (rlf_image_rgba8){s->color, 1920, 1080, 4 * 1920};
    return true;
}

/* Light by place of two bodies. */
static void measure_probes(report *r, const render_scene *s)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    probe_set *set = calloc(1, sizeof(*set));
    const probe_def def = {.rig = &s->rig,
                           .lamp = white,
                           .T_picture_depth = s->rig.T_color_depth,
                           .T_picture_world = s->rig.T_color_depth,
                           .is_on = true};
    double times[REPEATS] = {0};
    for (int i = 0; i < REPEATS && set != NULL; i++) {
        int64_t start = rlf_clock_ns();
        if (i == 0) {
            probe_set_init(set);
        }
        (void)probe_set_update(set, &def, &s->frame, &s->surface, &s->snapshot);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    add_row(r, "of it: light by place", times);
    if (set != NULL) {
        probe_set_destroy(set);
    }
    free(set);
}

/* The camera's blur and noise: measured in each frame, and given to what the matte shows. */
static void measure_finish(report *r, render_scene *s)
{
    finish *f = calloc(1, sizeof(*f));
    rlf_compositor_def def = scene_def(s);
    rlf_compositor *compositor = NULL;
    rlf_render_output out;
    def.occlusion = RLF_OCCLUSION_SOFT;
    if (f == NULL || rlf_compositor_create_soft(&def, &compositor) != RLF_OK ||
        rlf_compositor_render(compositor, &s->input, &out) != RLF_OK ||
        finish_create(out.image.width, out.image.height, f) != RLF_OK) {
        rlf_compositor_destroy(&compositor);
        free(f);
        return;
    }
    double looks[REPEATS];
    double draws[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        int64_t start = rlf_clock_ns();
        s->frame.sequence++;
        finish_look(f, &s->frame);
        looks[i] = (double)(rlf_clock_ns() - start) * 1e-6;
        f->width_px = 2.5f; /* of a soft camera */
        f->noise.is_known = true;
        start = rlf_clock_ns();
        finish_picture(f, NULL, &out.image, &out.matte);
        draws[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    add_row(r, "of it: blur and noise, measuring", looks);
    add_row(r, "of it: blur and noise, drawing", draws);
    finish_destroy(f);
    rlf_compositor_destroy(&compositor);
    free(f);
}

static void measure_counts(report *r, render_scene *s, rlf_body_state *bodies)
{
    const int32_t counts[4] = {0, 2, 20, BODY_COUNT};
    const rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = 0.06};
    fill_bodies(bodies, scene_box(0.12), 0.2);
    for (int i = 0; i < 4; i++) {
        s->snapshot.body_count = counts[i];
        measure_composite(r, s, RLF_OCCLUSION_SOFT, "boxes of 12 cm");
        if (counts[i] == 2 && s->rig.color.width == 960) {
            measure_probes(r, s);
            measure_finish(r, s);
        }
    }
    measure_composite(r, s, RLF_OCCLUSION_DEPTH, "boxes of 12 cm");
    measure_composite(r, s, RLF_OCCLUSION_OFF, "boxes of 12 cm");
    measure_composite(r, s, RLF_OCCLUSION_THESIS, "boxes of 12 cm");
    fill_bodies(bodies, ball, 0.2);
    measure_composite(r, s, RLF_OCCLUSION_SOFT, "balls of 12 cm");
}

/* The same balls as textured models. */
static void measure_models(report *r, render_scene *s, rlf_body_state *bodies)
{
    rlf_model *model = sample_ball(8);
    if (model == NULL) {
        return;
    }
    s->snapshot.body_count = 20;
    for (int i = 0; i < s->snapshot.body_count; i++) {
        bodies[i].look = (rlf_look){model, 0.06, {0, 0, 0}};
    }
    char what[64];
    snprintf(what, sizeof(what), "balls as models of %d triangles", (int)model->triangle_count);
    measure_composite(r, s, RLF_OCCLUSION_SOFT, what);
    for (int i = 0; i < s->snapshot.body_count; i++) {
        bodies[i].look.model = NULL;
    }
    rlf_model_destroy(&model);
}

/* Boxes that stand on a floor before a wall, each turned another way. */
static void fill_floor(render_scene *s, rlf_body_state bodies[BODY_COUNT])
{
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        const double z = s->ray_y[i] > 0.0f ? FLOOR_M / (double)s->ray_y[i] : 1e9;
        if (z < (double)s->planes[PLANE_BACK][i]) {
            s->planes[PLANE_DEPTH][i] = s->planes[PLANE_BACK][i] = (float)z;
            s->planes[PLANE_NORMAL + 1][i] = -1.0f;
            s->planes[PLANE_NORMAL + 2][i] = 0.0f;
        }
    }
    for (int i = 0; i < BODY_COUNT; i++) {
        bodies[i] =
            (rlf_body_state){.shape = scene_box(0.12), .mass = 1, .color = {0.9f, 0.5f, 0.2f}};
        bodies[i].T_world_body.p =
            rlf_vec3_make((i % 10 - 4.5) * 0.22, FLOOR_M - 0.06, 2.0 + 0.19 * (i / 10));
        bodies[i].T_world_body.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), i);
    }
}

static void measure_floor(report *r, rlf_body_state *bodies)
{
    render_scene *s = scene_make(4.0);
    fill_floor(s, bodies);
    scene_add_strip(s, 220, 280, 2.0);
    s->rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    s->snapshot.bodies = bodies;
    s->snapshot.body_count = BODY_COUNT;
    measure_composite(r, s, RLF_OCCLUSION_SOFT, "boxes of 12 cm on a floor");
    if (enlarge(s)) {
        measure_composite(r, s, RLF_OCCLUSION_SOFT, "boxes of 12 cm on a floor");
    }
    scene_free(s);
}

/* What every composite must read and write: the camera's picture into the composite, the matte, and
 * both sheets of the depth grid. A copy of as many bytes, and how many of them a picture takes. */
static void measure_moved(report *r, int32_t width, int32_t height)
{
    const size_t pixels = (size_t)width * (size_t)height;
    const size_t grid = (size_t)512 * 424 * 2 * sizeof(float);
    uint8_t *color = calloc(pixels, 4);
    uint8_t *picture = calloc(pixels, 4);
    uint8_t *matte = calloc(pixels, 1);
    uint8_t *sheets = calloc(grid, 2);
    double times[REPEATS] = {0};
    const bool has_all = color != NULL && picture != NULL && matte != NULL && sheets != NULL;
    for (int i = 0; i < REPEATS && has_all; i++) {
        int64_t start = rlf_clock_ns();
        memcpy(picture, color, 4 * pixels);
        memset(matte, i, pixels);
        memcpy(sheets + grid, sheets, grid);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
        color[i] = picture[pixels + (size_t)i] ^ matte[i] ^ sheets[grid + (size_t)i];
    }
    char name[64];
    snprintf(name, sizeof(name), "%dx%d what must be moved", (int)width, (int)height);
    add_row(r, name, times);
    const double copy = r->rows[r->count - 1].least;
    snprintf(name, sizeof(name), "%dx%d soft, %d boxes of 12 cm", (int)width, (int)height,
             BODY_COUNT);
    for (int i = 0; i < r->count; i++) {
        if (strcmp(r->rows[i].name, name) == 0 && copy > 0.0) {
            printf("  the picture of %d boxes takes %.1f times as long\n", BODY_COUNT,
                   r->rows[i].least / copy);
        }
    }
    free(color);
    free(picture);
    free(matte);
    free(sheets);
}

static int write_json(const report *r, const char *path)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        fprintf(stderr, "bench_render: %s: cannot be written\n", path);
        return 1;
    }
    fprintf(file, "{\n");
    for (int i = 0; i < r->count; i++) {
        fprintf(file, "  \"%s\": {\"least_ms\": %.4f, \"median_ms\": %.4f, \"p95_ms\": %.4f}%s\n",
                r->rows[i].name, r->rows[i].least, r->rows[i].median, r->rows[i].p95,
                i + 1 < r->count ? "," : "");
    }
    fprintf(file, "}\n");
    return fclose(file) == 0 ? 0 : 1;
}

int main(int argc, char **argv)
{
    static rlf_body_state bodies[BODY_COUNT];
    static report r;
    if (argc != 1 && (argc != 3 || strcmp(argv[1], "--json") != 0)) {
        fprintf(stderr, "usage: bench_render [--json FILE]\n");
        return 2;
    }
    render_scene *s = scene_make(3.0);
    scene_add_strip(s, 220, 280, 2.0);
    s->rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    s->snapshot.bodies = bodies;
    printf("%-44s %8s %8s %8s\n", "512x424 depth, one thread", "least ms", "median", "p95");
    measure_registration(&r, s, "registration to 960x540");
    s->rig.color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    s->rig.color.distortion[0] = 0.05;
    measure_registration(&r, s, "registration to 960x540, distorted colour");
    s->rig.color = scene_rig().color;
    measure_counts(&r, s, bodies);
    measure_models(&r, s, bodies);
    if (enlarge(s)) {
        measure_registration(&r, s, "registration to 1920x1080");
        measure_counts(&r, s, bodies);
    }
    scene_free(s);
    measure_floor(&r, bodies);
    measure_moved(&r, 960, 540);
    measure_moved(&r, 1920, 1080);
    return argc == 3 ? write_json(&r, argv[2]) : 0;
}
