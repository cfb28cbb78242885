/* Things that a test needs and that must come to be: each call creates one, or fails the test. */
#ifndef RLF_TEST_CREATED_H
#define RLF_TEST_CREATED_H

#include "test.h"
#include "relief/map.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"
#include "relief/world.h"

static inline rlf_pool *pool_of(int32_t workers)
{
    rlf_pool *pool = NULL;
    assert_int_equal(rlf_pool_create(workers, &pool), RLF_OK);
    return pool;
}

static inline rlf_source *synthetic_of(const rlf_synthetic_def *def)
{
    rlf_source *source = NULL;
    assert_int_equal(rlf_synthetic_create(def, &source), RLF_OK);
    return source;
}

/* By its name, e.g. "synthetic:room?color=0". */
static inline rlf_source *synthetic_named(const char *name, rlf_pool *pool)
{
    rlf_synthetic_def def = rlf_synthetic_def_default();
    assert_int_equal(rlf_synthetic_parse(name, &def), RLF_OK);
    def.pool = pool;
    return synthetic_of(&def);
}

static inline rlf_frame frame_of(rlf_source *source)
{
    rlf_frame frame;
    assert_int_equal(rlf_source_next(source, &frame), RLF_OK);
    return frame;
}

/* Goes on to the frame with this sequence number. */
static inline rlf_frame frame_at(rlf_source *source, uint64_t sequence)
{
    rlf_frame frame;
    do {
        frame = frame_of(source);
    } while (frame.sequence < sequence);
    return frame;
}

static inline rlf_pipeline *pipeline_of(const rlf_pipeline_def *def)
{
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(def, &pipeline), RLF_OK);
    return pipeline;
}

static inline rlf_map *map_of(const rlf_map_def *def)
{
    rlf_map *map = NULL;
    assert_int_equal(rlf_map_create(def, &map), RLF_OK);
    return map;
}

static inline rlf_world *world_of(const rlf_world_def *def)
{
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(def, &world), RLF_OK);
    return world;
}

static inline rlf_body_id add_body(rlf_world *world, const rlf_body_def *def)
{
    rlf_body_id id = {0, 0};
    assert_int_equal(rlf_world_add_body(world, def, &id), RLF_OK);
    return id;
}

#endif
