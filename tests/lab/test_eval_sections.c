/* The sheets that bodies meet in section physics of `relief-lab eval`. */

#include "eval/physics/sheet.h"
#include "test.h"

TEST_CASE(sheet_shows_walls_and_slab)
{
    const eval_wall walls[2] = {{{0, 0, -1}, -3.0}, {{0, -1, 0}, -1.0}};
    const eval_slab slab = {{{0, 0, -1}, -2.0}, {0, 0, 2}, {0.1, 0.1, 0}, 0.3, {1, 2, 3}};
    eval_sheet sheet;
    assert_int_equal(eval_sheet_open(&sheet), RLF_OK);
    eval_sheet_set_room(&sheet, walls, 2);
    const rlf_grid *g = &sheet.grid;
    int32_t middle = g->height / 2 * g->width + g->width / 2;
    int32_t bottom = (g->height - 1) * g->width + g->width / 2;
    assert_true(fabs(g->background.depth[middle] - 3.0) < 1e-6);
    assert_true(fabs(g->background.depth[bottom] * g->ray_y[bottom] - 1.0) < 1e-5);
    assert_true(g->background.normal_y[bottom] == -1.0f);
    assert_int_equal(g->foreground.mask[middle], 0);
    int64_t seen_at = g->time_ns;
    eval_sheet_set_slab(&sheet, &slab);
    assert_true(g->time_ns > seen_at);
    assert_int_equal(g->foreground.mask[middle], 1);
    assert_int_equal(g->foreground.mask[bottom], 0);
    assert_true(g->foreground.depth[middle] == 2.0f && g->foreground.velocity_z[middle] == 3.0f);
    assert_true(g->foreground.thickness[middle] == 0.3f);
    int64_t pixels = 0; /* 0.2 m at 2 m are 36.55 pixels of 365.5 */
    for (int32_t i = 0; i < g->width * g->height; i++) {
        pixels += g->foreground.mask[i];
    }
    assert_in_range(pixels, 36 * 36, 37 * 37);
    assert_true(eval_sheet_sees(rlf_vec3_make(0, 0, 1)));
    assert_false(eval_sheet_sees(rlf_vec3_make(0, 0, -1)));
    eval_sheet_close(&sheet);
}
