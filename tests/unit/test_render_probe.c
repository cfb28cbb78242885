/* Light by place: nine harmonics of what a picture sends to a body, against a room whose every wall
 * is known. */
#include "render/probe.h"
#include "render_scene.h"
#include "test.h"

#include <math.h>

#define DIRECTIONS 4000

/* A box of walls about the camera, which stands at its end: half sizes, and light of the walls. */
typedef struct walls {
    rlf_vec3 low, high;
    float light[6][3]; /* -x, +x, -y, +y, -z, +z */
} walls;

/* Where a ray from within meets the walls. */
static int wall_of(const walls *w, rlf_vec3 from, rlf_vec3 d, double *out_t)
{
    const double o[3] = {from.x, from.y, from.z};
    const double v[3] = {d.x, d.y, d.z};
    const double low[3] = {w->low.x, w->low.y, w->low.z};
    const double high[3] = {w->high.x, w->high.y, w->high.z};
    int wall = 0;
    *out_t = 1e9;
    for (int i = 0; i < 3; i++) {
        const double to = v[i] > 0.0 ? high[i] : low[i];
        const double t = v[i] != 0.0 ? (to - o[i]) / v[i] : 1e9;
        wall = t < *out_t ? 2 * i + (v[i] > 0.0 ? 1 : 0) : wall;
        *out_t = t < *out_t ? t : *out_t;
    }
    return wall;
}

static render_scene *make_room(const walls *w)
{
    static const float inward[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                       {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    render_scene *s = scene_make(2.0);
    double t;
    for (int32_t i = 0; i < s->grid.width * s->grid.height; i++) {
        const rlf_vec3 ray = {(double)s->ray_x[i], (double)s->ray_y[i], 1.0};
        const int wall = wall_of(w, rlf_vec3_make(0, 0, 0), ray, &t);
        s->planes[PLANE_DEPTH][i] = (float)t;
        for (int k = 0; k < 3; k++) {
            s->planes[PLANE_NORMAL + k][i] = inward[wall][k];
        }
    }
    const rlf_vec3 eye = rlf_neg(s->rig.T_color_depth.p);
    for (int32_t i = 0; i < s->rig.color.width * s->rig.color.height; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&s->rig.color, i % s->rig.color.width, i / s->rig.color.width,
                                   &ray);
        const int wall = wall_of(w, eye, ray, &t);
        for (int k = 0; k < 3; k++) {
            s->color[4 * i + k] = (uint8_t)(255.0f * sqrtf(w->light[wall][k]) + 0.5f);
        }
    }
    return s;
}

/* Probes of the scene's bodies. Free with probe_set_destroy and free. */
static probe_set *look(render_scene *s)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    probe_set *set = calloc(1, sizeof(*set));
    const probe_def def = {.rig = &s->rig,
                           .lamp = white,
                           .T_picture_depth = s->rig.T_color_depth,
                           .T_picture_world = s->rig.T_color_depth,
                           .is_on = true};
    probe_set_init(set);
    assert_int_equal(probe_set_update(set, &def, &s->frame, &s->surface, &s->snapshot), RLF_OK);
    return set;
}

static double around(const light_probe *p, rlf_vec3 n, int c)
{
    const double d[PROBE_TERMS] = {
        1.0, n.x, n.y, n.z, n.x * n.y, n.y * n.z, n.z * n.x, n.z * n.z, n.x * n.x - n.y * n.y};
    double sum = 0.0;
    for (int i = 0; i < PROBE_TERMS; i++) {
        sum += d[i] * (double)p->around[i][c];
    }
    return sum;
}

/* The i-th of evenly spread directions (spiral of Vogel). */
static rlf_vec3 direction(int i)
{
    const double z = 1.0 - 2.0 * (i + 0.5) / DIRECTIONS;
    const double r = sqrt(1.0 - z * z);
    return rlf_vec3_make(r * cos(2.399963 * i), r * sin(2.399963 * i), z);
}

/* Light from all walls, those too that the camera does not see, weighted by the cosine: as a share
 * of PROBE_AMBIENT where the picture's mean comes from everywhere. */
static double truth(const walls *w, const probe_set *set, rlf_vec3 p, rlf_vec3 n, int c)
{
    double sum = 0.0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const rlf_vec3 d = direction(i);
        const double cosine = rlf_dot(d, n);
        double t;
        sum += cosine > 0.0 ? cosine * (double)w->light[wall_of(w, p, d, &t)][c] : 0.0;
    }
    return PROBE_AMBIENT * sum * 4.0 / DIRECTIONS / (double)set->room.mean[c];
}

/* Walls of one light send the same to all sides, wherever the body is. */
TEST_CASE(even_walls_light_evenly)
{
    walls w = {{-1.5, -1.2, -0.5}, {1.5, 1.0, 3.0}, {{0}}};
    for (int i = 0; i < 18; i++) {
        w.light[i / 3][i % 3] = 0.3f;
    }
    render_scene *s = make_room(&w);
    (void)scene_add_body(s, scene_box(0.2), rlf_vec3_make(0.4, 0.3, 1.7));
    probe_set *set = look(s);
    for (int i = 0; i < DIRECTIONS; i += 97) {
        const double here = around(&set->probes[0], direction(i), 1);
        assert_true(fabs(here - PROBE_AMBIENT) < 0.02 * PROBE_AMBIENT);
    }
    assert_true((double)set->probes[0].direct[0] > 0.99 * PROBE_DIRECT);
    probe_set_destroy(set);
    free(set);
    scene_free(s);
}

/* A red wall on the left, a blue one on the right, a dark floor: each side of a body shows what is
 * there. The camera sees under a third of all directions; what is behind it is guessed. */
TEST_CASE(sides_take_their_walls_light)
{
    const walls w = {{-1.0, -1.2, -0.5},
                     {1.0, 0.9, 2.6},
                     {{0.5f, 0.05f, 0.05f},
                      {0.05f, 0.05f, 0.5f},
                      {0.4f, 0.4f, 0.4f},
                      {0.06f, 0.05f, 0.04f},
                      {0.25f, 0.22f, 0.25f},
                      {0.25f, 0.25f, 0.25f}}};
    render_scene *s = make_room(&w);
    const rlf_vec3 place = {0.1, 0.3, 1.9};
    (void)scene_add_body(s, scene_box(0.1), place);
    probe_set *set = look(s);
    double square = 0.0;
    double even = 0.0;
    double all = 0.0;
    for (int i = 0; i < DIRECTIONS; i += 29) {
        for (int c = 0; c < 3; c++) {
            const double right = truth(&w, set, place, direction(i), c);
            const double off = around(&set->probes[0], direction(i), c) - right;
            square += off * off;
            even += (PROBE_AMBIENT - right) * (PROBE_AMBIENT - right);
            all += right * right;
        }
    }
    const double error = sqrt(square / all);
    print_message("light from all sides is off by %.1f %%; the same from everywhere, by %.1f %%\n",
                  100.0 * error, 100.0 * sqrt(even / all));
    assert_true(error < 0.5 * sqrt(even / all));
    assert_true(error < 0.25);
    const rlf_vec3 left = {-1, 0, 0};
    const rlf_vec3 right = {1, 0, 0};
    const rlf_vec3 down = {0, 1, 0};
    const rlf_vec3 up = {0, -1, 0};
    const light_probe *p = &set->probes[0];
    assert_true(around(p, left, 0) > 1.5 * around(p, right, 0));
    assert_true(around(p, right, 2) > 1.5 * around(p, left, 2));
    assert_true(around(p, up, 1) > 1.5 * around(p, down, 1));
    probe_set_destroy(set);
    free(set);
    scene_free(s);
}

/* Near dark walls there is less of the lamp's light, too. */
TEST_CASE(a_dark_corner_is_dark)
{
    const walls w = {{-1.2, -1.2, -0.5},
                     {1.2, 0.9, 2.6},
                     {{0.02f, 0.02f, 0.02f},
                      {0.6f, 0.6f, 0.6f},
                      {0.3f, 0.3f, 0.3f},
                      {0.2f, 0.2f, 0.2f},
                      {0.3f, 0.3f, 0.3f},
                      {0.3f, 0.3f, 0.3f}}};
    render_scene *s = make_room(&w);
    (void)scene_add_body(s, scene_box(0.1), rlf_vec3_make(-1.0, 0.0, 1.8));
    (void)scene_add_body(s, scene_box(0.1), rlf_vec3_make(1.0, 0.0, 1.9));
    probe_set *set = look(s);
    const light_probe *dark = &set->probes[set->of[0]];
    const light_probe *light = &set->probes[set->of[1]];
    print_message("lamp's light beside the dark wall %.2f, beside the light one %.2f; around %.2f, "
                  "%.2f\n",
                  (double)dark->direct[1], (double)light->direct[1], (double)dark->around[0][1],
                  (double)light->around[0][1]);
    assert_true(dark->direct[1] < 0.8f * light->direct[1]);
    assert_true(dark->around[0][1] < 0.8f * light->around[0][1]);
    probe_set_destroy(set);
    free(set);
    scene_free(s);
}

/* Directions on all sides of an octahedron's folds: the map holds what it was filled with. */
TEST_CASE(the_map_goes_on_across_its_edges)
{
    walls w = {{-1.5, -1.2, -0.5}, {1.5, 1.0, 3.0}, {{0}}};
    for (int i = 0; i < 18; i++) {
        w.light[i / 3][i % 3] = i / 3 == 5 ? 0.6f : 0.2f;
    }
    render_scene *s = make_room(&w);
    (void)scene_add_body(s, scene_box(0.2), rlf_vec3_make(0.0, 0.0, 1.5));
    probe_set *set = look(s);
    const light_probe *p = &set->probes[0];
    const int32_t last = PROBE_SIDE;
    for (int32_t i = 1; i <= last; i++) {
        const int32_t other = PROBE_SIDE + 1 - i;
        assert_memory_equal(p->map[i * PROBE_ROW], p->map[other * PROBE_ROW + 1],
                            sizeof(p->map[0]));
        assert_memory_equal(p->map[(last + 1) * PROBE_ROW + i], p->map[last * PROBE_ROW + other],
                            sizeof(p->map[0]));
    }
    probe_set_destroy(set);
    free(set);
    scene_free(s);
}
