/* A person who walks through the synthetic room, as the surface stage sees him: one region with one
 * label, where he is. */

#include "heavy.h"
#include "created.h"
#include "seen_view.h"
#include "test.h"

#include <stdlib.h>

enum { FRAMES = 130, WHOLE_FROM = 81 }; /* from then on nothing hides a part of him */

typedef struct walk {
    rlf_source *source;
    rlf_reconstruct *stage;
    const rlf_truth *truth;
    const rlf_surface *surface;
} walk;

static int start(void **state)
{
    static walk w;
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.enable_color = false;
    synthetic.frame_count = FRAMES;
    w.source = synthetic_of(&synthetic);
    rlf_reconstruct_def def =
        rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(w.source)->rig);
    w.stage = stage_of(&def);
    *state = &w;
    return 0;
}

static int finish(void **state)
{
    walk *w = *state;
    rlf_reconstruct_destroy(&w->stage);
    rlf_source_destroy(&w->source);
    return 0;
}

static bool next(walk *w)
{
    rlf_frame frame;
    if (rlf_source_next(w->source, &frame) != RLF_OK) {
        return false;
    }
    w->surface = surface_of(w->stage, &frame);
    w->truth = rlf_source_get_truth(w->source);
    return true;
}

/* The largest foreground region. */
static const rlf_region *person(const rlf_surface *s)
{
    const rlf_region *best = NULL;
    for (int32_t r = 0; r < s->region_count; r++) {
        const rlf_region *region = &s->regions[r];
        if (region->layer == RLF_LAYER_FOREGROUND &&
            (best == NULL || region->point_count > best->point_count)) {
            best = region;
        }
    }
    return best;
}

typedef struct outline {
    int32_t count, hit, x0, y0, x1, y1;
    rlf_vec3 mean;
} outline;

static outline true_outline(const walk *w, int32_t label)
{
    outline o = {0, 0, w->surface->width, w->surface->height, 0, 0, {0, 0, 0}};
    for (int32_t i = 0; i < w->surface->width * w->surface->height; i++) {
        if (w->truth->label[i] != RLF_SYNTHETIC_LABEL_PERSON) {
            continue;
        }
        int32_t x = i % w->surface->width, y = i / w->surface->width;
        double z = w->truth->depth[i];
        rlf_vec3 p = {z * w->surface->ray_x[i], z * w->surface->ray_y[i], z};
        o.mean = rlf_add(o.mean, p);
        o.count++;
        o.hit += w->surface->label[i] == label;
        o.x0 = x < o.x0 ? x : o.x0;
        o.y0 = y < o.y0 ? y : o.y0;
        o.x1 = x + 1 > o.x1 ? x + 1 : o.x1;
        o.y1 = y + 1 > o.y1 ? y + 1 : o.y1;
    }
    o.mean = rlf_scale(o.mean, o.count > 0 ? 1.0 / o.count : 0.0);
    return o;
}

static void is_one_region_with_one_label(const walk *w, int32_t *label)
{
    const rlf_region *region = person(w->surface);
    assert_non_null(region);
    *label = *label == 0 ? region->label : *label;
    assert_int_equal(region->label, *label);
    outline o = true_outline(w, *label);
    assert_true(o.hit >= 0.93 * o.count);
    assert_true(abs(region->x0 - o.x0) <= 4 && abs(region->x1 - o.x1) <= 4);
    assert_true(abs(region->y0 - o.y0) <= 4 && abs(region->y1 - o.y1) <= 4);
    assert_true(rlf_length(rlf_sub(region->centroid, o.mean)) < 0.03);
    assert_true(region->plane_residual > 0.02 && region->plane_residual < 0.3);
    rlf_vec3 x = rlf_rotate(region->oriented_pose.q, rlf_vec3_make(1, 0, 0));
    assert_true(x.y * x.y > 0.85); /* he stands */
    assert_true(region->oriented_half.x > 0.7 && region->oriented_half.x < 1.1);
}

/* Pixels that are still, and those of them that are said to move. */
typedef struct stillness {
    int64_t still, moves;
} stillness;

static void add_frame(const walk *w, stillness *m)
{
    const rlf_surface *s = w->surface;
    const rlf_truth *t = w->truth;
    for (int32_t i = 0; i < s->width * s->height; i++) {
        rlf_vec3 real = {t->velocity_x[i], t->velocity_y[i], t->velocity_z[i]};
        rlf_vec3 found = {s->velocity_x[i], s->velocity_y[i], s->velocity_z[i]};
        m->still += rlf_length(real) == 0.0;
        m->moves += rlf_length(real) == 0.0 && rlf_length(found) > 0.0;
    }
}

/* How fast his limbs are is judged by lab.bounds_room. */
TEST_CASE(a_walking_person_is_one_region_and_the_room_is_still)
{
    walk *w = *state;
    stillness m = {0, 0};
    int32_t label = 0;
    for (int t = 0; t < heavy(FRAMES, 60) && next(w); t++) {
        add_frame(w, &m);
        if (t >= WHOLE_FROM) {
            is_one_region_with_one_label(w, &label);
        }
    }
    assert_true(m.moves * 1000 < m.still);
    if (heavy_is_whole()) {
        assert_true(person(w->surface)->age_ns > (FRAMES - WHOLE_FROM) * INT64_C(33000000));
    }
}

TEST_EACH(start, finish)
