/* Replays the synthetic room and compares hashes with those written down here. The same bits must
 * come out of every compiler, optimisation level, instruction set and worker count; a change of
 * method changes them, and then the new ones are written down in the same commit. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "relief/pipeline.h"
#include "relief/synthetic.h"

#include <stdio.h>

#define FRAMES 90

typedef struct golden {
    rlf_profile profile;
    uint64_t surface; /* of all planes of all frames */
    uint64_t world;   /* of all body states after the last frame */
    uint64_t picture; /* of the last picture */
} golden;

static const golden goldens[] = {
    {RLF_PROFILE_LIVE, 0x81989697d1bf1b05u, 0x23b5a669c46e4e45u, 0xa936bc981ae2fb83u},
    {RLF_PROFILE_THESIS, 0xa393eb06e579d241u, 0xd84652fb54683851u, 0xc064b44391e1e990u},
};

/* FNV-1a. */
static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return hash;
}

static uint64_t hash_surface(uint64_t hash, const rlf_surface *s)
{
    size_t count = (size_t)s->width * (size_t)s->height;
    const float *const planes[] = {s->depth,      s->normal_x,   s->normal_y,
                                   s->normal_z,   s->velocity_x, s->velocity_y,
                                   s->velocity_z, s->thickness,  s->background_depth};
    for (size_t i = 0; i < sizeof(planes) / sizeof(planes[0]); i++) {
        hash = hash_bytes(hash, planes[i], count * sizeof(float));
    }
    hash = hash_bytes(hash, s->label, count * sizeof(int32_t));
    hash = hash_bytes(hash, s->reason, count);
    return hash_bytes(hash, s->foreground, count);
}

static golden replay(rlf_profile profile, int32_t workers)
{
    rlf_pool *pool = NULL;
    assert_int_equal(rlf_pool_create(workers, &pool), RLF_OK);
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.frame_count = FRAMES;
    synthetic.pool = pool;
    rlf_source *source = NULL;
    assert_int_equal(rlf_synthetic_create(&synthetic, &source), RLF_OK);
    rlf_scene scene;
    assert_int_equal(rlf_scene_create_two_cubes(&scene), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(profile, source, pool);
    def.scene = &scene;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    golden result = {.profile = profile, .surface = UINT64_C(14695981039346656037)};
    rlf_pipeline_output out;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        if (out.frame_index % 15 == 14) {
            result.surface = hash_surface(result.surface, out.surface);
        }
    }
    const rlf_image_rgba8 *image = &out.render.image;
    result.picture = UINT64_C(14695981039346656037);
    for (int32_t y = 0; y < image->height; y++) {
        result.picture =
            hash_bytes(result.picture, rlf_rgba8_row(image, y), 4 * (size_t)image->width);
    }
    result.world = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return result;
}

static void check(const golden *expected, int32_t workers)
{
    golden got = replay(expected->profile, workers);
    print_message("    {%d, 0x%016llxu, 0x%016llxu, 0x%016llxu} with %d workers\n",
                  (int)got.profile, (unsigned long long)got.surface, (unsigned long long)got.world,
                  (unsigned long long)got.picture, (int)workers);
    assert_true(got.surface == expected->surface);
    assert_true(got.world == expected->world);
    assert_true(got.picture == expected->picture);
}

static void live_profile_replays_exactly(void **state)
{
    (void)state;
    check(&goldens[0], 1);
    check(&goldens[0], 3);
}

static void thesis_profile_replays_exactly(void **state)
{
    (void)state;
    check(&goldens[1], 1);
    check(&goldens[1], 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(live_profile_replays_exactly),
        cmocka_unit_test(thesis_profile_replays_exactly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
