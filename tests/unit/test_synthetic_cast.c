/* The caster leaves out what a ray cannot meet; what it finds is what a search among all finds. */

#include "sim/cast.h"
#include "sim/path.h"
#include "test.h"

static synth_hit search(const synth_scene *scene, const synth_ray *ray)
{
    synth_hit best = {-1, 1e9};
    for (int32_t i = 0; i < scene->static_count; i++) {
        synth_interval hit;
        if (synth_shape_intersect(&scene->statics[i].shape, ray, &hit) && hit.near > 0.0 &&
            hit.near < best.t) {
            best = (synth_hit){i, hit.near};
        }
    }
    return best;
}

TEST_CASE(test_nothing_is_overlooked)
{
    static synth_scene rest, scene;
    static synth_candidates candidates;
    const synth_view view = {
        {.width = 512, .height = 424, .fx = 365.5, .fy = 365.5, .cx = 255.5, .cy = 211.5},
        {0.052, 0.0, 0.0}};
    synth_path path;
    synth_scene_build(&rest, RLF_SYNTHETIC_ROOM);
    synth_path_close_room(&rest);
    synth_path_make(&path, RLF_SYNTHETIC_PATH_LOOK_AWAY, &rest);
    int32_t hits = 0;
    for (int32_t k = 0; k < 5; k++) {
        const rlf_pose pose = synth_path_pose(&path, 0.9 * k);
        synth_path_see(&rest, &pose, &scene);
        for (int32_t y0 = 0; y0 < 424; y0 += SYNTH_TILE) {
            for (int32_t x0 = 0; x0 < 512; x0 += SYNTH_TILE) {
                const synth_rect tile = {x0, y0, x0 + SYNTH_TILE, y0 + SYNTH_TILE};
                synth_tile_candidates(&scene, scene.static_count, &view, tile, &candidates);
                for (int32_t i = 0; i < 24; i++) {
                    const double u = x0 - 0.5 + 7 * i % (SYNTH_TILE + 1);
                    const double v = y0 - 0.5 + 5 * i % (SYNTH_TILE + 1);
                    const synth_ray ray = synth_view_ray(&view, u, v);
                    const synth_hit all = search(&scene, &ray);
                    const synth_hit found = synth_cast(&scene, &candidates, &ray);
                    assert_int_equal(found.part, all.part);
                    assert_true(found.t == all.t);
                    hits += found.part >= 0;
                }
            }
        }
    }
    assert_true(hits > 100000);
}
