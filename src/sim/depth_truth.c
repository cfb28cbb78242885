/* Truth about a frame of the depth camera, for those who ask. As with depth, only the rectangle
 * that movers cover, or covered in the frame that was asked about before, is touched. */
#include "sim/depth.h"

#include <string.h>

#define ROWS_PER_CHUNK 8

/* Copies row y, columns of `rect`, back from the room. */
static void restore_row(synth_depth *depth, synth_rect rect, int32_t y)
{
    const synth_depth_planes *room = &depth->room[depth->room_index];
    synth_depth_planes *now = &depth->now;
    const size_t first = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)rect.x0;
    const size_t count = (size_t)(rect.x1 - rect.x0);
    memcpy(now->label + first, room->label + first, count * sizeof(int32_t));
    memcpy(now->thickness + first, room->thickness + first, count * sizeof(float));
    memset(depth->foreground + first, 0, count);
    for (int k = 0; k < 3; k++) {
        memcpy(now->normal[k] + first, room->normal[k] + first, count * sizeof(float));
        memset(depth->velocity[k] + first, 0, count * sizeof(float));
    }
}

/* Movers whose rectangle holds pixel (x, y). */
static void movers_at(int32_t x, int32_t y, const synth_canvas *canvas, synth_candidates *out)
{
    out->count = 0;
    for (int32_t i = 0; i < canvas->stamp_count; i++) {
        const synth_rect *r = &canvas->stamps[i].rect;
        if (x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1) {
            out->of[out->count++].part = i;
        }
    }
}

static void store(synth_depth *depth, const synth_run *run, int32_t y, int32_t i,
                  const synth_touches *touches)
{
    const synth_part *part = &depth->scene->movers[run->id];
    const rlf_vec3 p = {touches->p[0][i], touches->p[1][i], touches->p[2][i]};
    const rlf_vec3 velocity = synth_part_velocity(part, p);
    const synth_ray ray = {depth->view.origin, rlf_scale(p, 1.0 / p.z)};
    const size_t at = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)(run->x0 + i);
    synth_candidates candidates;
    movers_at(run->x0 + i, y, &depth->canvas, &candidates);
    depth->now.label[at] = part->label;
    depth->now.thickness[at] =
        (float)(synth_exit(depth->scene->movers, &candidates, part->label, &ray, p.z) - p.z);
    depth->foreground[at] = 1;
    for (int k = 0; k < 3; k++) {
        depth->now.normal[k][at] = touches->normal[k][i];
    }
    depth->velocity[0][at] = (float)velocity.x;
    depth->velocity[1][at] = (float)velocity.y;
    depth->velocity[2][at] = (float)velocity.z;
}

static void find_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_depth *depth = context;
    const synth_canvas *canvas = &depth->canvas;
    synth_touches touches;
    synth_run run;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (synth_rect_has_row(depth->truth_dirty, y)) {
            restore_row(depth, depth->truth_dirty, y);
        }
        if (!synth_rect_has_row(canvas->drawn, y)) {
            continue;
        }
        for (int32_t x = canvas->drawn.x0; synth_canvas_next_run(canvas, x, y, &run); x = run.x1) {
            synth_canvas_touch(canvas, &run, y, &touches);
            for (int32_t i = 0; i < run.x1 - run.x0; i++) {
                store(depth, &run, y, i, &touches);
            }
        }
    }
}

void synth_depth_find_truth(synth_depth *depth)
{
    if (depth->truth_room_index != depth->room_index) {
        depth->truth_room_index = depth->room_index;
        depth->truth_dirty = (synth_rect){0, 0, SYNTH_DEPTH_WIDTH, SYNTH_DEPTH_HEIGHT};
    }
    rlf_parallel_for(depth->pool, SYNTH_DEPTH_HEIGHT, ROWS_PER_CHUNK, find_rows, depth);
    depth->truth_dirty = depth->canvas.drawn;
    depth->has_truth = true;
}
