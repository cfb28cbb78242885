/* The stage as a whole: memory, lifetime of surfaces, determinism, bad input. */

#include "seen_view.h"
#include "surface/stage.h"
#include "surface_check.h"
#include "created.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

/* A noisy wall with a ball that moves before it; some pixels missing. */
static void draw(const rlf_rig *rig, float *depth, int32_t number, uint64_t seed)
{
    analytic_random r = {seed + (uint64_t)number * 7919u};
    const rlf_camera *c = &rig->depth;
    for (int32_t y = 0; y < c->height; y++) {
        for (int32_t x = 0; x < c->width; x++) {
            double rx = (x - c->cx) / c->fx, ry = (y - c->cy) / c->fy;
            rlf_vec3 centre = {-0.5 + 0.05 * number, 0.1, 1.8};
            double z = sphere_depth(centre, 0.35, rx, ry);
            z = z > 0.0 && number > 6 ? z
                                      : plane_depth(rlf_vec3_make(0.1, 0.2, -0.97), -2.8, rx, ry);
            z += rlf_depth_noise_sigma(&rig->noise, z) * random_normal(&r);
            depth[(ptrdiff_t)y * c->width + x] = random_uniform(&r) < 0.02 ? 0.0f : (float)z;
        }
    }
}

static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211ull; /* FNV-1a */
    }
    return hash;
}

static uint64_t hash_surface(const rlf_surface *s)
{
    size_t n = (size_t)s->width * (size_t)s->height;
    const float *const planes[] = {s->depth,
                                   s->normal_x,
                                   s->normal_y,
                                   s->normal_z,
                                   s->velocity_x,
                                   s->velocity_y,
                                   s->velocity_z,
                                   s->thickness,
                                   s->background_depth,
                                   s->background_normal_x,
                                   s->background_normal_y,
                                   s->background_normal_z};
    uint64_t hash = 14695981039346656037ull;
    for (size_t k = 0; k < sizeof planes / sizeof planes[0]; k++) {
        hash = hash_bytes(hash, planes[k], n * sizeof(float));
    }
    hash = hash_bytes(hash, s->label, n * sizeof(int32_t));
    hash = hash_bytes(hash, s->background_label, n * sizeof(int32_t));
    hash = hash_bytes(hash, s->reason, n);
    hash = hash_bytes(hash, s->foreground, n);
    return hash_bytes(hash, s->regions, (size_t)s->region_count * sizeof *s->regions);
}

static rlf_reconstruct *make_stage(const rlf_rig *rig, rlf_profile profile, rlf_pool *pool)
{
    rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, rig);
    def.pool = pool;
    return stage_of(&def);
}

TEST_CASE(results_do_not_depend_on_workers)
{
    enum { W = 161, H = 121, FRAMES = 14 };
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    uint64_t hash[3][FRAMES];
    static const int32_t workers[3] = {0, 2, 5};
    for (int k = 0; k < 3; k++) {
        rlf_pool *pool = NULL;
        if (workers[k] > 0) {
            pool = pool_of(workers[k]);
        }
        rlf_reconstruct *stage = make_stage(&rig, RLF_PROFILE_LIVE, pool);
        for (int32_t t = 0; t < FRAMES; t++) {
            draw(&rig, depth, t, 99);
            rlf_frame frame = analytic_frame(&rig, depth, t);
            const rlf_surface *s = surface_of(stage, &frame);
            hash[k][t] = hash_surface(s);
            assert_true(t < 8 || s->foreground_count > 500);
        }
        rlf_reconstruct_destroy(&stage);
        rlf_pool_destroy(&pool);
    }
    assert_memory_equal(hash[0], hash[1], sizeof hash[0]);
    assert_memory_equal(hash[0], hash[2], sizeof hash[0]);
    assert_true(hash[0][7] != hash[0][13]);
}

/* Nothing that a step leaves in its scratch planes is read by a later one. */
TEST_CASE(scratch_holds_for_its_step_only)
{
    enum { W = 161, H = 121, FRAMES = 40 };
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stages[2];
        for (int k = 0; k < 2; k++) {
            stages[k] = make_stage(&rig, (rlf_profile)profile, NULL);
            stages[k]->arena.is_spoiled = k == 1;
        }
        for (int32_t t = 0; t < FRAMES; t++) {
            draw(&rig, depth, t, 77);
            rlf_frame frame = analytic_frame(&rig, depth, t);
            const rlf_surface *s[2];
            for (int k = 0; k < 2; k++) {
                s[k] = surface_of(stages[k], &frame);
            }
            assert_true(hash_surface(s[0]) == hash_surface(s[1]));
        }
        rlf_reconstruct_destroy(&stages[0]);
        rlf_reconstruct_destroy(&stages[1]);
    }
}

TEST_CASE(processing_allocates_nothing)
{
    enum { W = 96, H = 72 };
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stage = make_stage(&rig, (rlf_profile)profile, NULL);
        uint64_t before = rlf_alloc_count();
        for (int32_t t = 0; t < 40; t++) {
            draw(&rig, depth, t, 5);
            rlf_frame frame = analytic_frame(&rig, depth, t);
            surface_of(stage, &frame);
        }
        assert_int_equal(rlf_alloc_count() - before, 0);
        rlf_reconstruct_destroy(&stage);
    }
}

/* A published surface keeps every bit during the next two calls. */
TEST_CASE(surfaces_stay_as_they_were_published)
{
    enum { W = 96, H = 72, FRAMES = 40 };
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    rlf_reconstruct *stage = make_stage(&rig, RLF_PROFILE_LIVE, NULL);
    const rlf_surface *published[FRAMES];
    uint64_t hash[FRAMES];
    for (int32_t t = 0; t < FRAMES; t++) {
        draw(&rig, depth, t, 31);
        rlf_frame frame = analytic_frame(&rig, depth, t);
        published[t] = surface_of(stage, &frame);
        hash[t] = hash_surface(published[t]);
        for (int32_t k = t - RLF_RECONSTRUCT_SURFACES + 1; k <= t; k++) {
            assert_true(k < 0 || hash_surface(published[k]) == hash[k]);
            assert_true(k < 0 || published[k]->sequence == (uint64_t)k);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

TEST_CASE(every_size_and_every_rubbish_is_survived)
{
    static const int32_t sizes[][2] = {{1, 1},  {2, 1},  {1, 3},   {3, 2},   {5, 5},
                                       {65, 1}, {1, 70}, {67, 66}, {63, 129}};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        rlf_rig rig = analytic_rig(sizes[k][0], sizes[k][1]);
        int32_t n = sizes[k][0] * sizes[k][1];
        float *depth = rlf_alloc_array((size_t)n, sizeof(float));
        analytic_random r = {k + 1};
        for (int profile = 0; profile < 2; profile++) {
            rlf_reconstruct_def def = rlf_reconstruct_def_default((rlf_profile)profile, &rig);
            def.scale_factor = 1;
            rlf_reconstruct *stage = stage_of(&def);
            for (int32_t t = 0; t < 24; t++) {
                for (int32_t i = 0; i < n; i++) {
                    double u = random_uniform(&r);
                    float rubbish = u < 0.5 ? (float)(5.0 * random_uniform(&r)) : NAN;
                    float valid = t < 8 ? 3.0f : (t < 16 ? 1.0f : rubbish);
                    depth[i] = t == 9 ? 0.0f : (t == 10 && i != n / 2 ? 0.0f : valid);
                }
                rlf_frame frame = analytic_frame(&rig, depth, t);
                const rlf_surface *s = surface_of(stage, &frame);
                surface_check(s);
            }
            rlf_reconstruct_destroy(&stage);
        }
        rlf_free(depth);
    }
}

/* Every normal of a valid pixel is there and faces the camera, in the live profile. */
TEST_CASE(live_normals_are_complete_and_face_the_camera)
{
    enum { W = 128, H = 96 };
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    rlf_reconstruct *stage = make_stage(&rig, RLF_PROFILE_LIVE, NULL);
    for (int32_t t = 0; t < 12; t++) {
        draw(&rig, depth, t, 77);
        rlf_frame frame = analytic_frame(&rig, depth, t);
        const rlf_surface *s = surface_of(stage, &frame);
        surface_check(s);
        for (int32_t i = 0; i < W * H; i++) {
            double facing =
                s->normal_x[i] * s->ray_x[i] + s->normal_y[i] * s->ray_y[i] + s->normal_z[i];
            assert_true(s->depth[i] > 0.0f ? facing < 0.0 : facing == 0.0);
        }
    }
    rlf_reconstruct_destroy(&stage);
}

static bool ignore_assert(void *context, const char *condition, const char *file, int line)
{
    (void)condition;
    (void)file;
    (void)line;
    ++*(int *)context;
    return false;
}

static void expect_refusal(rlf_reconstruct_def def, const char *field)
{
    rlf_reconstruct *stage = NULL;
    assert_int_equal(rlf_reconstruct_create(&def, &stage), RLF_ERROR_INVALID);
    assert_null(stage);
    assert_non_null(strstr(rlf_error_text(), field));
    assert_null(strchr(rlf_error_text(), '\n'));
}

TEST_CASE(bad_settings_are_refused_by_name)
{
    rlf_rig rig = analytic_rig(64, 48);
    rlf_reconstruct_def good = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    rlf_reconstruct_def def = good;
    def.scale_factor = 0;
    expect_refusal(def, "scale_factor");
    def = good;
    def.scale_factor = 65;
    expect_refusal(def, "scale_factor");
    def = good;
    def.depth_max_m = def.depth_min_m;
    expect_refusal(def, "depth_max_m");
    def = good;
    def.depth_min_m = NAN;
    expect_refusal(def, "depth_min_m");
    def = good;
    def.background_frames = 0;
    expect_refusal(def, "background_frames");
    def = good;
    def.region_capacity = 0;
    expect_refusal(def, "region_capacity");
    def = good;
    def.segment_tau_m = -1.0;
    expect_refusal(def, "segment_tau_m");
    def = good;
    def.rig.depth.fx = 0.0;
    expect_refusal(def, "fx");
    int asserts = 0;
    rlf_set_assert(ignore_assert, &asserts);
    def = good;
    def.cookie = 0;
    expect_refusal(def, "rlf_reconstruct_def_default");
    assert_int_equal(asserts, 1);
    rlf_set_assert(NULL, NULL);
}

TEST_CASE(bad_frames_are_refused)
{
    static float depth[64 * 48];
    static uint16_t raw[64 * 48];
    rlf_rig rig = analytic_rig(64, 48);
    rlf_reconstruct *stage = make_stage(&rig, RLF_PROFILE_LIVE, NULL);
    const rlf_surface *s;
    rlf_frame good = analytic_frame(&rig, depth, 0);
    rlf_frame frame = good;
    frame.depth_f32 = NULL;
    assert_int_equal(rlf_reconstruct_process(stage, &frame, &s), RLF_ERROR_INVALID);
    assert_null(s);
    frame = good;
    frame.depth_u16 = raw;
    assert_int_equal(rlf_reconstruct_process(stage, &frame, &s), RLF_ERROR_INVALID);
    frame = good;
    frame.depth_stride -= 4;
    assert_int_equal(rlf_reconstruct_process(stage, &frame, &s), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "depth_stride"));
    frame = good;
    frame.depth_f32 = NULL;
    frame.depth_u16 = raw;
    frame.depth_units_per_metre = 0.0;
    assert_int_equal(rlf_reconstruct_process(stage, &frame, &s), RLF_ERROR_INVALID);
    rlf_rig other = analytic_rig(32, 24);
    frame = good;
    frame.rig = &other;
    assert_int_equal(rlf_reconstruct_process(stage, &frame, &s), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "32 x 24"));
    s = surface_of(stage, &good); /* all missing: fine */
    assert_int_equal(s->valid_count, 0);
    rlf_reconstruct_destroy(&stage);
}

/* Memory for so many more calls. */
typedef struct short_store {
    int left, held;
} short_store;

static void *short_alloc(void *context, size_t size)
{
    short_store *store = context;
    void *memory = store->left-- > 0 ? aligned_alloc(64, size) : NULL;
    store->held += memory != NULL;
    return memory;
}

static void short_free(void *context, void *memory)
{
    ((short_store *)context)->held--;
    free(memory);
}

TEST_CASE(short_memory_is_an_error)
{
    rlf_rig rig = analytic_rig(64, 48);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    bool was_made = false;
    for (int calls = 0; !was_made; calls++) {
        rlf_reconstruct *stage = NULL;
        short_store store = {.left = calls};
        rlf_set_allocator(short_alloc, short_free, &store);
        rlf_result result = rlf_reconstruct_create(&def, &stage);
        was_made = result == RLF_OK;
        assert_true(was_made || (result == RLF_ERROR_MEMORY && stage == NULL));
        rlf_reconstruct_destroy(&stage);
        rlf_set_allocator(NULL, NULL, NULL);
        assert_int_equal(store.held, 0);
        assert_true(was_made == (calls == 2)); /* the stage, and all its planes */
    }
}

/* The same place of two planes never falls upon the same lines of a cache that goes by 4 KiB. */
TEST_CASE(planes_lie_apart_in_the_cache)
{
    enum { W = 64, H = 64 }; /* four pages a plane: packed ones would all begin at one place */
    static float depth[W * H];
    rlf_rig rig = analytic_rig(W, H);
    rlf_reconstruct *stage = make_stage(&rig, RLF_PROFILE_LIVE, NULL);
    draw(&rig, depth, 0, 1);
    rlf_frame frame = analytic_frame(&rig, depth, 0);
    const rlf_surface *s = surface_of(stage, &frame);
    const float *plane[] = {s->depth,      s->normal_x,   s->normal_y,   s->normal_z,
                            s->velocity_x, s->velocity_y, s->velocity_z, s->thickness};
    enum { PLANES = sizeof plane / sizeof plane[0] };
    for (int i = 0; i < PLANES; i++) {
        assert_int_equal((uintptr_t)plane[i] % 64, 0);
        for (int k = 0; k < i; k++) {
            assert_true((uintptr_t)plane[i] % 4096 != (uintptr_t)plane[k] % 4096);
        }
    }
    rlf_reconstruct_destroy(&stage);
}
