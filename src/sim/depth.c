/* One frame of the depth camera. Only the rectangle that movers cover, or covered in the frame
 * before, is touched; the noise is drawn anew everywhere. */
#include "sim/depth.h"
#include "sim/material.h"
#include "kernel/kernel.h"

#include <string.h>

#define ROWS_PER_CHUNK 8

/* Copies row y, columns of `rect`, back from the room. */
static void restore_row(synth_depth *depth, synth_rect rect, int32_t y)
{
    const synth_depth_planes *room = &depth->room[depth->room_index];
    synth_depth_planes *now = &depth->now;
    size_t first = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)rect.x0;
    size_t count = (size_t)(rect.x1 - rect.x0);
    memcpy(now->z + first, room->z + first, count * sizeof(float));
    memcpy(now->sigma + first, room->sigma + first, count * sizeof(float));
    memcpy(now->margin + first, room->margin + first, count * sizeof(float));
    memcpy(now->jump + first, room->jump + first, count);
}

/* Cosines of the angles at which rays meet the surface. */
RLF_KERNEL static void find_cosines(const synth_touches *touches, int32_t count,
                                    float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float dot = 0.0f;
        float length2 = 0.0f;
        RLF_KERNEL_UNROLLED(3)
        for (int k = 0; k < 3; k++) {
            dot -= touches->normal[k][i] * touches->p[k][i];
            length2 += touches->p[k][i] * touches->p[k][i];
        }
        out[i] = dot / sqrtf(length2);
    }
}

/* What a stereo camera finds to match on a run, in place of the light that comes back. */
static void match_run(const synth_part *part, const synth_touches *touches, int32_t count,
                      float *margin)
{
    for (int32_t i = 0; i < count; i++) {
        const rlf_vec3 local = {touches->local[0][i], touches->local[1][i], touches->local[2][i]};
        margin[i] = synth_noise_match(synth_look_texture(part, local));
    }
}

/* Depth and noise of the movers' pixels in row y. */
static void resolve_row(synth_depth *depth, int32_t y)
{
    const synth_canvas *canvas = &depth->canvas;
    synth_touches touches;
    float cosine[SYNTH_RUN_MOST];
    synth_run run;
    for (int32_t x = canvas->drawn.x0; synth_canvas_next_run(canvas, x, y, &run); x = run.x1) {
        const size_t first = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)run.x0;
        const int32_t count = run.x1 - run.x0;
        const synth_part *part = &depth->scene->movers[run.id];
        const synth_noise_seen seen = {(float)synth_infrared(part), canvas->z + first, cosine,
                                       depth->vignette + first, count};
        synth_canvas_touch(canvas, &run, y, &touches);
        find_cosines(&touches, count, cosine);
        synth_noise_find(&depth->noise, &seen, depth->now.sigma + first, depth->now.margin + first);
        if (synth_depth_is_stereo(depth)) {
            match_run(part, &touches, count, depth->now.margin + first);
        }
        memcpy(depth->now.z + first, canvas->z + first, (size_t)count * sizeof(float));
    }
}

static void draw_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_depth *depth = context;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (synth_rect_has_row(depth->dirty, y)) {
            restore_row(depth, depth->dirty, y);
        }
        if (synth_rect_has_row(depth->canvas.drawn, y)) {
            synth_canvas_draw_row(&depth->canvas, depth->room[depth->room_index].z, y);
            resolve_row(depth, y);
        }
    }
}

/* Jumps where a mover's pixel takes part in the second difference. */
static void jump_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_depth *depth = context;
    synth_rect rect = synth_rect_grow(depth->canvas.drawn, 1, &depth->view.camera);
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (y < 1 || y > SYNTH_DEPTH_HEIGHT - 2 || !synth_rect_has_row(rect, y)) {
            continue;
        }
        int32_t x0 = rect.x0 < 1 ? 1 : rect.x0;
        int32_t x1 = rect.x1 > SYNTH_DEPTH_WIDTH - 1 ? SYNTH_DEPTH_WIDTH - 1 : rect.x1;
        const size_t first = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)x0;
        synth_noise_find_jumps(depth->now.z + first, x1 - x0, depth->now.jump + first);
    }
}

static void noise_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_depth *depth = context;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        synth_noise_row row = {.z = depth->now.z,
                               .sigma = depth->now.sigma,
                               .margin = depth->now.margin,
                               .jump = depth->now.jump,
                               .frame = depth->frame,
                               .y = y};
        synth_noise_apply(&depth->noise, &row, depth->out + (size_t)y * SYNTH_DEPTH_WIDTH);
    }
}

void synth_depth_render(synth_depth *depth, uint32_t frame, int32_t room_index)
{
    depth->frame = frame;
    depth->has_truth = false;
    if (room_index != depth->room_index) {
        depth->room_index = room_index;
        depth->dirty = (synth_rect){0, 0, SYNTH_DEPTH_WIDTH, SYNTH_DEPTH_HEIGHT};
    }
    synth_canvas_place(&depth->canvas, depth->scene);
    rlf_parallel_for(depth->pool, SYNTH_DEPTH_HEIGHT, ROWS_PER_CHUNK, draw_rows, depth);
    rlf_parallel_for(depth->pool, SYNTH_DEPTH_HEIGHT, ROWS_PER_CHUNK, jump_rows, depth);
    rlf_parallel_for(depth->pool, SYNTH_DEPTH_HEIGHT, ROWS_PER_CHUNK, noise_rows, depth);
    depth->dirty = synth_rect_grow(depth->canvas.drawn, 1, &depth->view.camera);
}
