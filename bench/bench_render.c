/* Milliseconds of registration and of whole composites by the CPU renderer, on one thread: least
 * and median of many pictures of a wall with a strip before it. Prints one row each. */
#include "render_scene.h"

#include <stdio.h>

#define REPEATS 101
#define BODY_COUNT 100

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_row(const char *name, double times[REPEATS])
{
    qsort(times, REPEATS, sizeof(*times), compare);
    printf("%-34s %8.3f %8.3f\n", name, times[0], times[REPEATS / 2]);
}

static void measure_registration(render_scene *s, const char *name)
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
    double times[REPEATS];
    for (int i = 0; i < REPEATS && z.data != NULL && state.data != NULL; i++) {
        int64_t start = rlf_clock_ns();
        rlf_registration_apply(registration, s->planes[PLANE_DEPTH], &z, &state);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    print_row(name, times);
    free(z.data);
    free(state.data);
    rlf_registration_destroy(&registration);
}

static void measure_composite(render_scene *s, rlf_occlusion occlusion, const char *name)
{
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
        rlf_compositor_render(compositor, &s->input, &out);
        times[i] = (double)(rlf_clock_ns() - start) * 1e-6;
    }
    print_row(name, times);
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

int main(void)
{
    static rlf_body_state bodies[BODY_COUNT];
    render_scene *s = scene_make(3.0);
    scene_add_strip(s, 220, 280, 2.0);
    s->snapshot.bodies = bodies;
    printf("%-34s %8s %8s\n", "512x424 to 960x540, one thread", "least ms", "median");
    measure_registration(s, "registration");
    s->rig.color.distortion_model = RLF_DISTORTION_PLUMB_BOB;
    s->rig.color.distortion[0] = 0.05;
    measure_registration(s, "registration, distorted colour");
    s->rig = scene_rig();
    fill_bodies(bodies, scene_box(0.12), 0.2);
    const int32_t counts[4] = {0, 2, 20, BODY_COUNT};
    for (int i = 0; i < 4; i++) {
        char name[64];
        s->snapshot.body_count = counts[i];
        snprintf(name, sizeof(name), "composite, %d boxes of 12 cm", (int)counts[i]);
        measure_composite(s, RLF_OCCLUSION_DEPTH, name);
    }
    measure_composite(s, RLF_OCCLUSION_THESIS, "composite, 100 boxes, thesis");
    rlf_shape ball = {.type = RLF_SHAPE_SPHERE, .radius = 0.06};
    fill_bodies(bodies, ball, 0.2);
    measure_composite(s, RLF_OCCLUSION_DEPTH, "composite, 100 spheres");
    fill_bodies(bodies, scene_box(0.25), 0.2);
    bodies[0].T_world_body.p = rlf_vec3_make(-0.2, 0, 1.6);
    bodies[1].T_world_body.p = rlf_vec3_make(0.2, 0, 2.6);
    s->snapshot.body_count = 2;
    measure_composite(s, RLF_OCCLUSION_DEPTH, "composite, 2 boxes of 25 cm");
    scene_free(s);
    return 0;
}
