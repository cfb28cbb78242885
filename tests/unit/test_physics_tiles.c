/* What tiles and pixels tell of distances, against every pixel's solid. */
#include "draws.h"
#include "grid_fixture.h"
#include "physics/grid/cast.h"
#include "physics/grid/contact/search.h"
#include "physics/grid/tiles.h"
#include "test.h"

#include <math.h>

#define SIDE 16 /* pixels of a tile */
#define THICKNESS 0.15

static uint64_t seed = 11;

/* Two slanting planes with bumps, and before them a block whose outline crosses tiles. */
static grid_fixture *make_scene(void)
{
    grid_fixture *f = grid_fixture_create();
    rlf_grid_sheet *sheet = &f->grid.background;
    float *depth = f->planes[2], *normal[3] = {f->planes[3], f->planes[4], f->planes[5]};
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        int32_t x = i % GRID_W, y = i / GRID_W;
        bool is_block = x > 200 && x < 290 && y > 150 && y < 260;
        rlf_vec3 n = is_block ? rlf_vec3_make(0, 0, -1) : rlf_vec3_make(0.1, y < 240 ? 0 : -1, -1);
        rlf_vec3 ray = {(x - GRID_CX) / GRID_F, (y - GRID_CY) / GRID_F, 1};
        n = rlf_normalize(n);
        depth[i] = (float)((is_block ? -1.6 : -2.0) / rlf_dot(n, ray) + draw(&seed, -0.01, 0.01));
        depth[i] = draw(&seed, 0, 1) < 0.02 ? 0.0f : depth[i];
        normal[0][i] = (float)n.x;
        normal[1][i] = (float)n.y;
        normal[2][i] = (float)n.z;
    }
    *sheet = (rlf_grid_sheet){.depth = depth, .default_thickness = THICKNESS};
    sheet->normal_x = normal[0];
    sheet->normal_y = normal[1];
    sheet->normal_z = normal[2];
    return f;
}

/* Distance from p to the solid behind a pixel; a large one where it has none. */
static double distance_to(const grid_fixture *f, int32_t x, int32_t y, rlf_vec3 p)
{
    field_cell cell;
    if (!grid_cell_read(&f->grid, &f->grid.background, x, y, &cell)) {
        return 1e9;
    }
    rlf_vec3 inward = grid_cell_inward(&cell), d = rlf_sub(p, cell.point);
    double level = rlf_dot(d, inward) / rlf_dot(inward, inward);
    return rlf_length(rlf_mad(d, inward, -rlf_clamp(level, 0.0, cell.thickness)));
}

static rlf_vec3 next_place(void)
{
    double z = draw(&seed, 1.0, 3.0);
    return rlf_vec3_make(draw(&seed, -0.6, 0.6) * z, draw(&seed, -0.5, 0.5) * z, z);
}

/* A tile is never farther than it says, a block within reach is never left out, and what tiles say
 * is true to the size of a block with its solid. */
TEST_CASE(tiles_tell_no_longer_distances)
{
    grid_fixture *f = *state;
    const int32_t all[4] = {0, 0, GRID_W, GRID_H};
    grid_tiles tiles = {.tiles = calloc(TILES_MAX, sizeof(grid_tile)),
                        .marks = calloc(TILES_MAX, sizeof(uint64_t))};
    grid_tiles_start(&tiles, &f->grid, &f->grid.background, true);
    assert_int_equal(tiles.size, SIDE);
    assert_true(grid_tiles_make(&tiles, &f->grid, all));
    for (int32_t k = 0; k < 400; k++) {
        int32_t column = (int32_t)draw(&seed, 0, 32), row = (int32_t)draw(&seed, 0, 26);
        const grid_tile *tile = &tiles.tiles[row * tiles.columns + column];
        rlf_vec3 p = next_place();
        double reach = draw(&seed, 0.0, 2.0), least = 1e9;
        uint32_t near = grid_tile_blocks_near(tile, p, reach);
        for (int32_t i = 0; i < SIDE * SIDE; i++) {
            int32_t x = i % SIDE, y = i / SIDE, block = y / 4 * TILE_BLOCKS + x / 4;
            double distance = distance_to(f, column * SIDE + x, row * SIDE + y, p);
            least = fmin(least, distance);
            assert_true(distance > reach || (near >> block & 1u) != 0);
        }
        assert_true(near == 0 || least < reach + 2.0 * THICKNESS);
    }
    free(tiles.marks);
    free(tiles.tiles);
}

/* A cube of 10 cm that flies and spins somewhere near the scene; its footprint is scanned. */
static void throw_cube(grid_job *job, const grid_query *query, phys_body *body)
{
    const rlf_vec3 turn = {draw(&seed, -3, 3), draw(&seed, -3, 3), draw(&seed, -3, 3)};
    memset(job, 0, sizeof(*job));
    job->query = query;
    job->sheet = query->background->sheet;
    job->tiles = query->background;
    job->body = body;
    job->motion.centre = next_place();
    job->motion.centre.z = draw(&seed, 1.4, 2.3);
    job->motion.v = rlf_vec3_make(draw(&seed, -2, 2), draw(&seed, -2, 2), draw(&seed, -2, 2));
    job->motion.w = rlf_vec3_make(draw(&seed, -4, 4), draw(&seed, -4, 4), draw(&seed, -4, 4));
    job->motion.speed = rlf_length(job->motion.v);
    job->motion.spin = rlf_length(job->motion.w);
    job->motion.R_grid_body = rlf_quat_to_mat3(rlf_quat_from_rotation_vector(turn));
    job->motion.R_body_grid = rlf_mat3_transpose(&job->motion.R_grid_body);
    job->window.horizon = 2.0 * query->step;
    job->window.reach = body->shape.radius + GRID_MARGIN + job->window.horizon * job->motion.speed;
    job->side = (field_side){FIELD_NONE, job->motion.centre, true};
    job->scan.is_listed = true;
    grid_scan_footprint(job);
}

/* Whatever point of a cube touches, it is one of those that were told to be near. */
TEST_CASE(what_touches_is_told_to_be_near)
{
    grid_fixture *f = *state;
    const int32_t all[4] = {0, 0, GRID_W, GRID_H};
    grid_tiles tiles = {.tiles = calloc(TILES_MAX, sizeof(grid_tile)),
                        .marks = calloc(TILES_MAX, sizeof(uint64_t))};
    const grid_query query = {.grid = &f->grid, .step = 1.0 / 240.0, .background = &tiles};
    rlf_vec3 points[PHYS_POINTS_MAX];
    phys_body body = {0};
    const rlf_shape cube = {.type = RLF_SHAPE_BOX, .size = {0.1, 0.1, 0.1}};
    assert_int_equal(phys_shape_init(&body.shape, &cube, points), RLF_OK);
    grid_tiles_start(&tiles, &f->grid, &f->grid.background, true);
    assert_true(grid_tiles_make(&tiles, &f->grid, all));
    int32_t touches = 0, told = 0, asked = 0;
    for (int32_t k = 0; k < 3000; k++) {
        grid_job job;
        throw_cube(&job, &query, &body);
        for (int32_t i = 0; i < body.shape.point_count && job.scan.is_near; i++) {
            field_hit hit;
            rlf_vec3 r = rlf_mat3_mul_vec(&job.motion.R_grid_body, points[i]);
            rlf_vec3 way =
                rlf_scale(rlf_add(job.motion.v, rlf_cross(job.motion.w, r)), job.window.horizon);
            bool is_near = (grid_points_near(&job, &points[i], 1) & 1u) != 0;
            bool does = grid_cast(&f->grid, job.sheet, rlf_add(job.motion.centre, r), way,
                                  GRID_MARGIN, &job.side, &hit);
            assert_true(!does || is_near);
            touches += does;
            told += is_near;
            asked++;
        }
    }
    assert_true(touches > 3000 && told < asked * 3 / 4);
    phys_shape_finish(&body.shape);
    free(tiles.marks);
    free(tiles.tiles);
}

/* What is asked for its state alone has the same, inside, before and behind, at any depth. */
TEST_CASE(a_state_alone_is_the_same)
{
    grid_fixture *f = *state;
    int32_t counts[FIELD_BEHIND + 1] = {0};
    for (int32_t k = 0; k < 20000; k++) {
        field_cell whole, cheap;
        int32_t i = (int32_t)draw(&seed, 0, GRID_W * GRID_H);
        double z = (double)f->grid.background.depth[i] + draw(&seed, -0.02, 0.3);
        rlf_vec3 q = {z * (double)f->grid.ray_x[i], z * (double)f->grid.ray_y[i], z};
        field_state told = grid_field_at(&f->grid, &f->grid.background, q, &whole);
        assert_int_equal(grid_field_state(&f->grid, &f->grid.background, q, &cheap), told);
        counts[told]++;
    }
    assert_true(counts[FIELD_FRONT] > 200 && counts[FIELD_INSIDE] > 200 &&
                counts[FIELD_BEHIND] > 200);
}

static int open_scene(void **state)
{
    *state = make_scene();
    return 0;
}

static int close_scene(void **state)
{
    grid_fixture *f = *state;
    grid_fixture_destroy(&f);
    return 0;
}

TEST_GROUP(open_scene, close_scene)
