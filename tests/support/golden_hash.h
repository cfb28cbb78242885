/* What golden tests hash: planes, pictures and the states of all bodies of a replayed room. */
#ifndef RELIEF_TESTS_GOLDEN_HASH_H
#define RELIEF_TESTS_GOLDEN_HASH_H

#include "created.h"
#include "test.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"

#include <string.h>

typedef struct golden {
    rlf_profile profile;
    uint64_t surface; /* of all planes of every `every`-th frame */
    uint64_t world;   /* of all body states after the last frame */
    uint64_t picture; /* of the last picture */
} golden;

/* FNV-1a. */
static inline uint64_t golden_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return hash;
}

/* The same of 32-bit numbers, lowest byte first on every machine. */
static inline uint64_t golden_numbers(uint64_t hash, const void *data, size_t count)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < count; i++) {
        uint32_t number;
        memcpy(&number, bytes + 4 * i, sizeof(number));
        for (int k = 0; k < 32; k += 8) {
            hash = (hash ^ (number >> k & 0xFF)) * UINT64_C(1099511628211);
        }
    }
    return hash;
}

static inline uint64_t golden_surface(uint64_t hash, const rlf_surface *s)
{
    size_t count = (size_t)s->width * (size_t)s->height;
    const float *const planes[] = {s->depth,      s->normal_x,   s->normal_y,
                                   s->normal_z,   s->velocity_x, s->velocity_y,
                                   s->velocity_z, s->thickness,  s->background_depth};
    for (size_t i = 0; i < sizeof(planes) / sizeof(planes[0]); i++) {
        hash = golden_numbers(hash, planes[i], count);
    }
    hash = golden_numbers(hash, s->label, count);
    hash = golden_bytes(hash, s->reason, count);
    return golden_bytes(hash, s->foreground, count);
}

static inline golden golden_replay(rlf_profile profile, int32_t workers, int32_t frames,
                                   int32_t every)
{
    rlf_pool *pool = pool_of(workers);
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.frame_count = frames;
    synthetic.pool = pool;
    rlf_source *source = synthetic_of(&synthetic);
    rlf_scene scene;
    assert_int_equal(rlf_scene_create_two_cubes(&scene), RLF_OK);
    rlf_pipeline_def def = rlf_pipeline_def_default(profile, source, pool);
    def.scene = &scene;
    rlf_pipeline *pipeline = pipeline_of(&def);
    golden result = {.profile = profile, .surface = UINT64_C(14695981039346656037)};
    rlf_pipeline_output out;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        if (out.frame_index % every == every - 1) {
            result.surface = golden_surface(result.surface, out.surface);
        }
    }
    const rlf_image_rgba8 *image = &out.render.image;
    result.picture = UINT64_C(14695981039346656037);
    for (int32_t y = 0; y < image->height; y++) {
        result.picture =
            golden_bytes(result.picture, rlf_rgba8_row(image, y), 4 * (size_t)image->width);
    }
    result.world = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    rlf_pipeline_destroy(&pipeline);
    rlf_scene_destroy(&scene);
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return result;
}

static inline void golden_check(const golden *expected, int32_t workers, int32_t frames,
                                int32_t every)
{
    golden got = golden_replay(expected->profile, workers, frames, every);
    print_message("    {%d, 0x%016llxu, 0x%016llxu, 0x%016llxu} with %d workers\n",
                  (int)got.profile, (unsigned long long)got.surface, (unsigned long long)got.world,
                  (unsigned long long)got.picture, (int)workers);
    assert_true(got.surface == expected->surface);
    assert_true(got.world == expected->world);
    assert_true(got.picture == expected->picture);
}

#endif
