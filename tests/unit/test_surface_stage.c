/* The stage as a whole: memory, lifetime of surfaces, determinism, bad input. */

#include "surface/stage.h" /* before the names of painted.h */

#include "count_assert.h"
#include "created.h"
#include "painted.h"
#include "surface_check.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

/* A noisy wall with a ball that moves before it; some pixels missing. */
static void draw(int32_t number, uint64_t seed)
{
    analytic_random r = {seed + (uint64_t)number * 7919u};
    const rlf_camera *c = &rig.depth;
    for (int32_t y = 0; y < c->height; y++) {
        for (int32_t x = 0; x < c->width; x++) {
            double rx = (x - c->cx) / c->fx, ry = (y - c->cy) / c->fy;
            rlf_vec3 centre = {-0.5 + 0.05 * number, 0.1, 1.8};
            double z = sphere_depth(centre, 0.35, rx, ry);
            z = z > 0.0 && number > 6 ? z
                                      : plane_depth(rlf_vec3_make(0.1, 0.2, -0.97), -2.8, rx, ry);
            z += rlf_depth_noise_sigma(&rig.noise, z) * random_normal(&r);
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

static void begin(int32_t width, int32_t height, rlf_profile profile)
{
    see_size(width, height);
    const rlf_reconstruct_def def = rlf_reconstruct_def_default(profile, &rig);
    start_seeing(&def);
}

/* The next frame of what is drawn. */
static const rlf_surface *see_drawn(uint64_t seed)
{
    draw(frames_seen, seed);
    return see();
}

TEST_CASE(results_do_not_depend_on_workers)
{
    enum { W = 161, H = 121, FRAMES = 14 };
    uint64_t hash[3][FRAMES];
    static const int32_t workers[3] = {0, 2, 5};
    for (int k = 0; k < 3; k++) {
        rlf_reconstruct_def def = see_size(W, H);
        rlf_pool *pool = workers[k] > 0 ? pool_of(workers[k]) : NULL;
        def.pool = pool;
        start_seeing(&def);
        for (int32_t t = 0; t < FRAMES; t++) {
            const rlf_surface *s = see_drawn(99);
            hash[k][t] = hash_surface(s);
            assert_true(t < 8 || s->foreground_count > 500);
        }
        stop_seeing(NULL);
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
    see_size(W, H);
    for (int profile = 0; profile < 2; profile++) {
        rlf_reconstruct *stages[2];
        for (int k = 0; k < 2; k++) {
            const rlf_reconstruct_def def = rlf_reconstruct_def_default((rlf_profile)profile, &rig);
            stages[k] = stage_of(&def);
            stages[k]->arena.is_spoiled = k == 1;
        }
        for (int32_t t = 0; t < FRAMES; t++) {
            draw(t, 77);
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
    for (int profile = 0; profile < 2; profile++) {
        begin(W, H, (rlf_profile)profile);
        uint64_t before = rlf_alloc_count();
        for (int32_t t = 0; t < 40; t++) {
            see_drawn(5);
        }
        assert_int_equal(rlf_alloc_count() - before, 0);
    }
}

/* A published surface keeps every bit during the next two calls. */
TEST_CASE(surfaces_stay_as_they_were_published)
{
    enum { W = 96, H = 72, FRAMES = 40 };
    begin(W, H, RLF_PROFILE_LIVE);
    const rlf_surface *published[FRAMES];
    uint64_t hash[FRAMES];
    for (int32_t t = 0; t < FRAMES; t++) {
        published[t] = see_drawn(31);
        hash[t] = hash_surface(published[t]);
        for (int32_t k = t - RLF_RECONSTRUCT_SURFACES + 1; k <= t; k++) {
            assert_true(k < 0 || hash_surface(published[k]) == hash[k]);
            assert_true(k < 0 || published[k]->sequence == (uint64_t)k);
        }
    }
}

TEST_CASE(every_size_and_every_rubbish_is_survived)
{
    static const int32_t sizes[][2] = {{1, 1},  {2, 1},  {1, 3},   {3, 2},   {5, 5},
                                       {65, 1}, {1, 70}, {67, 66}, {63, 129}};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        const int32_t n = sizes[k][0] * sizes[k][1];
        analytic_random r = {k + 1};
        for (int profile = 0; profile < 2; profile++) {
            see_size(sizes[k][0], sizes[k][1]);
            rlf_reconstruct_def def = rlf_reconstruct_def_default((rlf_profile)profile, &rig);
            def.scale_factor = 1;
            start_seeing(&def);
            for (int32_t t = 0; t < 24; t++) {
                for (int32_t i = 0; i < n; i++) {
                    double u = random_uniform(&r);
                    float rubbish = u < 0.5 ? (float)(5.0 * random_uniform(&r)) : NAN;
                    float valid = t < 8 ? 3.0f : (t < 16 ? 1.0f : rubbish);
                    depth[i] = t == 9 ? 0.0f : (t == 10 && i != n / 2 ? 0.0f : valid);
                }
                surface_check(see());
            }
        }
    }
}

/* Every normal of a valid pixel is there and faces the camera, in the live profile. */
TEST_CASE(live_normals_are_complete_and_face_the_camera)
{
    enum { W = 128, H = 96 };
    begin(W, H, RLF_PROFILE_LIVE);
    for (int32_t t = 0; t < 12; t++) {
        const rlf_surface *s = see_drawn(77);
        surface_check(s);
        for (int32_t i = 0; i < W * H; i++) {
            double facing =
                s->normal_x[i] * s->ray_x[i] + s->normal_y[i] * s->ray_y[i] + s->normal_z[i];
            assert_true(s->depth[i] > 0.0f ? facing < 0.0 : facing == 0.0);
        }
    }
}

static void expect_refusal(const rlf_reconstruct_def *def, const char *field)
{
    rlf_reconstruct *made = NULL;
    assert_int_equal(rlf_reconstruct_create(def, &made), RLF_ERROR_INVALID);
    assert_null(made);
    assert_non_null(strstr(rlf_error_text(), field));
    assert_null(strchr(rlf_error_text(), '\n'));
}

/* What is finite and yet no setting; unit.def_fields tries what is not finite. */
#define AT(member) offsetof(rlf_reconstruct_def, member)
TEST_CASE(bad_settings_are_refused_by_name)
{
    static const struct {
        size_t at;
        int32_t value;
        const char *field;
    } counts[] = {{AT(scale_factor), 0, "scale_factor"},
                  {AT(scale_factor), 65, "scale_factor"},
                  {AT(background_frames), 0, "background_frames"},
                  {AT(region_capacity), 0, "region_capacity"}};
    const rlf_reconstruct_def good = see_size(64, 48);
    rlf_reconstruct_def def;
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        def = good;
        memcpy((char *)&def + counts[i].at, &counts[i].value, sizeof(int32_t));
        expect_refusal(&def, counts[i].field);
    }
    def = good;
    def.depth_max_m = def.depth_min_m;
    expect_refusal(&def, "depth_max_m");
    def = good;
    def.segment_tau_m = -1.0;
    expect_refusal(&def, "segment_tau_m");
    def = good;
    def.rig.depth.fx = 0.0;
    expect_refusal(&def, "fx");
    int asserts = 0;
    rlf_set_assert(count_assert, &asserts);
    def = good;
    def.cookie = 0;
    expect_refusal(&def, "rlf_reconstruct_def_default");
    assert_int_equal(asserts, 1);
    rlf_set_assert(NULL, NULL);
}

static void expect_bad_frame(const rlf_frame *frame, const char *word)
{
    const rlf_surface *s = NULL;
    assert_int_equal(rlf_reconstruct_process(stage, frame, &s), RLF_ERROR_INVALID);
    assert_null(s);
    assert_non_null(strstr(rlf_error_text(), word));
}

TEST_CASE(bad_frames_are_refused)
{
    static uint16_t raw[64 * 48];
    begin(64, 48, RLF_PROFILE_LIVE);
    paint_all(0.0f);
    const rlf_frame good = analytic_frame(&rig, depth, 0);
    rlf_frame frame = good;
    frame.depth_f32 = NULL;
    expect_bad_frame(&frame, "");
    frame = good;
    frame.depth_u16 = raw;
    expect_bad_frame(&frame, "");
    frame = good;
    frame.depth_stride -= 4;
    expect_bad_frame(&frame, "depth_stride");
    frame = good;
    frame.depth_f32 = NULL;
    frame.depth_u16 = raw;
    frame.depth_units_per_metre = 0.0;
    expect_bad_frame(&frame, "");
    const rlf_rig other = analytic_rig(32, 24);
    frame = good;
    frame.rig = &other;
    expect_bad_frame(&frame, "32 x 24");
    assert_int_equal(see()->valid_count, 0); /* all missing: fine */
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
    const rlf_reconstruct_def def = see_size(64, 48);
    bool was_made = false;
    for (int calls = 0; !was_made; calls++) {
        rlf_reconstruct *made = NULL;
        short_store store = {.left = calls};
        rlf_set_allocator(short_alloc, short_free, &store);
        rlf_result result = rlf_reconstruct_create(&def, &made);
        was_made = result == RLF_OK;
        assert_true(was_made || (result == RLF_ERROR_MEMORY && made == NULL));
        rlf_reconstruct_destroy(&made);
        rlf_set_allocator(NULL, NULL, NULL);
        assert_int_equal(store.held, 0);
        assert_true(was_made == (calls == 2)); /* the stage, and all its planes */
    }
}

/* The same place of two planes never falls upon the same lines of a cache that goes by 4 KiB. */
TEST_CASE(planes_lie_apart_in_the_cache)
{
    enum { W = 64, H = 64 }; /* four pages a plane: packed ones would all begin at one place */
    begin(W, H, RLF_PROFILE_LIVE);
    const rlf_surface *s = see_drawn(1);
    const float *plane[] = {s->depth,      s->normal_x,   s->normal_y,   s->normal_z,
                            s->velocity_x, s->velocity_y, s->velocity_z, s->thickness};
    enum { PLANES = sizeof plane / sizeof plane[0] };
    for (int i = 0; i < PLANES; i++) {
        assert_int_equal((uintptr_t)plane[i] % 64, 0);
        for (int k = 0; k < i; k++) {
            assert_true((uintptr_t)plane[i] % 4096 != (uintptr_t)plane[k] % 4096);
        }
    }
}

TEST_EACH(NULL, stop_seeing)
