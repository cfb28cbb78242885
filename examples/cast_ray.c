/* A question to the real room: what does a ray meet? Twenty rays fan out from the camera over the
 * floor; where each ends, and whether on the room or on somebody, is drawn from above. */
#include "relief/relief.h"
#include "relief/synthetic.h"

#include <stdio.h>
#include <string.h>

#define RAYS 20
#define COLUMNS 60
#define ROWS 24
#define CELL_M 0.2

static int draw_from_above(const rlf_world *world, const rlf_grid *grid)
{
    char map[ROWS][COLUMNS + 1];
    memset(map, ' ', sizeof(map));
    int hits = 0;
    for (int i = 0; i < RAYS; i++) {
        const rlf_vec3 direction = {-0.6 + 1.2 * i / (RAYS - 1), 0.05, 1.0};
        const rlf_ray_hit hit =
            rlf_world_cast_ray(world, grid, rlf_vec3_make(0, 0, 0), direction, 10.0);
        const int column = COLUMNS / 2 + (int)(hit.point.x / CELL_M * 2);
        const int row = ROWS - 1 - (int)(hit.point.z / CELL_M);
        if (hit.reason == RLF_QUERY_HIT && column >= 0 && column < COLUMNS && row >= 0) {
            map[row][column] = hit.other == RLF_CONTACT_FOREGROUND ? '*' : '+';
            hits++;
        }
    }
    map[ROWS - 1][COLUMNS / 2] = 'V';
    for (int y = 0; y < ROWS; y++) {
        map[y][COLUMNS] = '\0';
        printf("%s\n", map[y]);
    }
    return hits;
}

int main(void)
{
    rlf_synthetic_def room = rlf_synthetic_def_default();
    rlf_source *source = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output frame;
    int hits = 0;
    rlf_result result = rlf_synthetic_create(&room, &source);
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.enable_render = false;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    for (int i = 0; i < 60 && result == RLF_OK; i++) {
        result = rlf_pipeline_step(pipeline, &frame);
    }
    if (result == RLF_OK) {
        rlf_grid grid;
        rlf_grid_from_surface(frame.surface, &frame.T_world_camera, NULL, 0, &grid);
        hits = draw_from_above(rlf_pipeline_get_world(pipeline), &grid);
        printf("V camera, + the room, * somebody: %d of %d rays met something\n", hits, RAYS);
    } else {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return hits > RAYS / 2 ? 0 : 1;
}
