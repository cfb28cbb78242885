/* rlf_synthetic_cast against the truth planes, and its independence of how rays are grouped. */

#include "created.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

static rlf_source *open_room(int32_t frames)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    def.enable_color = false;
    rlf_source *source = synthetic_of(&def);
    for (int32_t i = 0; i < frames; i++) {
        frame_of(source);
    }
    return source;
}

static rlf_vec3 ray_of(const rlf_camera *k, int32_t i)
{
    return rlf_vec3_make((i % k->width - k->cx) / k->fx, (i / k->width - k->cy) / k->fy, 1.0);
}

/* Along the depth camera's own rays it must see what the truth planes hold, person included. */
TEST_CASE(own_rays_see_the_truth)
{
    rlf_source *source = open_room(90);
    const rlf_truth *truth = rlf_source_get_truth(source);
    const rlf_camera *k = &rlf_source_get_info(source)->rig.depth;
    int32_t persons = 0;
    for (int32_t y = 0; y < k->height; y += 3) {
        rlf_vec3 rays[512];
        float z[512];
        int32_t labels[512];
        for (int32_t x = 0; x < k->width; x++) {
            rays[x] = ray_of(k, y * k->width + x);
        }
        assert_int_equal(
            rlf_synthetic_cast(source, rlf_vec3_make(0, 0, 0), rays, k->width, z, labels), RLF_OK);
        for (int32_t x = 0; x < k->width; x++) {
            int32_t i = y * k->width + x;
            assert_int_equal(labels[x], truth->label[i]);
            assert_true(fabsf(z[x] - truth->depth[i]) <= 1e-5f * z[x]);
            persons += labels[x] == RLF_SYNTHETIC_LABEL_PERSON;
        }
    }
    assert_true(persons > 1000);
    rlf_source_destroy(&source);
}

/* A bundle's cone only leaves out what none of its rays can hit: one ray at a time is the same,
 * from any origin and in any direction, backwards included. */
TEST_CASE(grouping_changes_nothing)
{
    rlf_source *source = open_room(60);
    rlf_vec3 origin = {0.3, -0.2, 0.9};
    rlf_vec3 rays[200];
    float z[200];
    int32_t labels[200];
    srand(7);
    for (int spread = 1; spread <= 100; spread *= 10) {
        for (int i = 0; i < 200; i++) {
            double wide = 0.02 * spread;
            rays[i].x = wide * (rand() % 2001 - 1000) / 1000.0;
            rays[i].y = wide * (rand() % 2001 - 1000) / 1000.0;
            rays[i].z = i % 2 == 0 || spread < 100 ? 1.0 : -1.0;
        }
        assert_int_equal(rlf_synthetic_cast(source, origin, rays, 200, z, labels), RLF_OK);
        for (int i = 0; i < 200; i++) {
            float alone;
            int32_t label;
            assert_int_equal(rlf_synthetic_cast(source, origin, &rays[i], 1, &alone, &label),
                             RLF_OK);
            assert_true(alone == z[i]);
            assert_int_equal(label, labels[i]);
            double distance;
            rlf_vec3 p = rlf_mad(origin, rays[i], z[i]);
            assert_int_equal(rlf_synthetic_distance(source, p, &distance, NULL, NULL), RLF_OK);
            assert_true(label == 0 || fabs(distance) < 1e-5 * rlf_length(p) + 1e-6);
        }
    }
    rlf_source_destroy(&source);
}

static rlf_result no_frame(void *self, rlf_frame *out)
{
    (void)self;
    (void)out;
    return RLF_END;
}

TEST_CASE(other_sources_know_no_truth)
{
    rlf_source_methods methods = {.next = no_frame};
    rlf_source_info info = {.name = "mine"};
    info.rig.depth = (rlf_camera){.width = 1, .height = 1, .fx = 1, .fy = 1};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, NULL, &source), RLF_OK);
    rlf_vec3 ray = {0, 0, 1};
    float z;
    assert_int_equal(rlf_synthetic_cast(source, ray, &ray, 1, &z, NULL), RLF_ERROR_INVALID);
    rlf_source_destroy(&source);
}
