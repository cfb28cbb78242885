/* Short replays whose bits the sanitizer build has to have, too: its kernels are the portable ones,
 * and little of it is optimised. A change of method changes them, as in test_replay_hash. */
#include "golden_hash.h"
#include "small_world.h"
#include "hulls.h"
#include "test.h"

#define FRAMES 8
#define STEPS 90
#define HEAP 40

static const golden room = {RLF_PROFILE_LIVE, 0xa0b43b4c2dfe5d38u, 0xb1514b4fddf6a5a8u,
                            0xcde82f67dba5e23bu};
static const uint64_t heap = 0x3be1d0738736a68eu;

static const rlf_vec3 TIPS[6] = {{0.06, 0, 0},  {-0.06, 0, 0}, {0, 0.06, 0},
                                 {0, -0.06, 0}, {0, 0, 0.06},  {0, 0, -0.06}};
static const rlf_hull OCTAHEDRON = {TIPS, 6, OCTAHEDRON_FACES, 8};

TEST_CASE(first_frames_of_the_room)
{
    golden_check(&room, 2, FRAMES, 1);
}

static rlf_body_def one_of_the_heap(int i)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = (rlf_shape_type)(i % 5);
    def.shape.size = rlf_vec3_make(0.1, 0.08, 0.06);
    def.shape.radius = 0.04;
    def.shape.height = 0.1;
    def.shape.hull = &OCTAHEDRON;
    def.position =
        rlf_vec3_make(0.11 * (i % 4) - 0.16, -0.12 * (i / 8) - 0.05, 1.0 + 0.12 * (i / 4 % 2));
    def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.3 * i, 0.7 * i, 0.1 * i));
    return def;
}

/* All shapes on one another. */
static uint64_t pour(int32_t workers)
{
    rlf_pool *pool = pool_of(workers);
    rlf_world_def def = rlf_world_def_default();
    def.gravity = rlf_vec3_make(0, 9.81, 0);
    def.pool = pool;
    rlf_world *world = world_of(&def);
    rlf_body_def ground = rlf_body_def_default();
    ground.shape.size = rlf_vec3_make(2, 0.2, 2);
    ground.position = rlf_vec3_make(0, 0.2, 1);
    ground.is_kinematic = true;
    add_body(world, &ground);
    for (int i = 0; i < HEAP; i++) {
        rlf_body_def body = one_of_the_heap(i);
        add_body(world, &body);
    }
    advance_steps(world, NULL, STEPS, 1.0 / 60);
    uint64_t hash = rlf_world_hash(world);
    rlf_world_destroy(&world);
    rlf_pool_destroy(&pool);
    return hash;
}

TEST_CASE(heap_of_all_shapes)
{
    uint64_t one = pour(1), three = pour(3);
    print_message("heap: 0x%016llxu\n", (unsigned long long)one);
    assert_true(one == three);
    assert_true(one == heap);
}
