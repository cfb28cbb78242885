/* One frame of the depth camera. Only the rectangle that movers cover, or covered in the frame
 * before, is touched; the noise is drawn anew everywhere. */
#include "capture/synthetic/depth.h"
#include "capture/synthetic/material.h"

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
    if (now->label == NULL) {
        return;
    }
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
            out->index[out->count++] = i;
        }
    }
}

static void store_truth(synth_depth *depth, const synth_part *part, const synth_touch *touch,
                        size_t i)
{
    const synth_scene *scene = depth->scene;
    rlf_vec3 p = rlf_vec3_make(touch->p[0], touch->p[1], touch->p[2]);
    rlf_vec3 velocity = synth_part_velocity(part, p);
    synth_ray ray = {depth->view.origin, rlf_scale(p, 1.0 / p.z)};
    synth_candidates candidates;
    movers_at((int32_t)(i % SYNTH_DEPTH_WIDTH), (int32_t)(i / SYNTH_DEPTH_WIDTH), &depth->canvas,
              &candidates);
    depth->now.label[i] = part->label;
    depth->now.thickness[i] =
        (float)(synth_exit(scene->movers, &candidates, part->label, &ray, p.z) - p.z);
    depth->foreground[i] = 1;
    for (int k = 0; k < 3; k++) {
        depth->now.normal[k][i] = touch->normal[k];
    }
    depth->velocity[0][i] = (float)velocity.x;
    depth->velocity[1][i] = (float)velocity.y;
    depth->velocity[2][i] = (float)velocity.z;
}

/* Depth, noise and truth of the movers' pixels in row y. */
static void resolve_row(synth_depth *depth, int32_t y)
{
    const synth_canvas *canvas = &depth->canvas;
    for (int32_t x = canvas->drawn.x0; x < canvas->drawn.x1; x++) {
        size_t i = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)x;
        int32_t id = canvas->part[i];
        if (id < 0) {
            continue;
        }
        const synth_part *part = &depth->scene->movers[id];
        float z = canvas->z[i];
        synth_touch touch = synth_stamp_touch(&canvas->stamps[id], &depth->view, x, y, z);
        float dot = 0.0f;
        float length2 = 0.0f;
        for (int k = 0; k < 3; k++) {
            dot -= touch.normal[k] * touch.p[k];
            length2 += touch.p[k] * touch.p[k];
        }
        float cosine = dot / sqrtf(length2);
        depth->now.z[i] = z;
        depth->now.sigma[i] = synth_noise_sigma(&depth->noise, z, cosine);
        depth->now.margin[i] = synth_noise_margin((float)synth_infrared(part->material), z, cosine,
                                                  depth->vignette[i]);
        if (depth->now.label != NULL) {
            store_truth(depth, part, &touch, i);
        }
    }
}

static bool has_row(synth_rect rect, int32_t y)
{
    return y >= rect.y0 && y < rect.y1 && rect.x0 < rect.x1;
}

static void draw_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    synth_depth *depth = context;
    (void)worker;
    for (int32_t y = begin; y < end; y++) {
        if (has_row(depth->dirty, y)) {
            restore_row(depth, depth->dirty, y);
        }
        if (has_row(depth->canvas.drawn, y)) {
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
        if (y < 1 || y > SYNTH_DEPTH_HEIGHT - 2 || !has_row(rect, y)) {
            continue;
        }
        int32_t x0 = rect.x0 < 1 ? 1 : rect.x0;
        int32_t x1 = rect.x1 > SYNTH_DEPTH_WIDTH - 1 ? SYNTH_DEPTH_WIDTH - 1 : rect.x1;
        for (int32_t x = x0; x < x1; x++) {
            size_t i = (size_t)y * SYNTH_DEPTH_WIDTH + (size_t)x;
            depth->now.jump[i] = synth_is_jump(depth->now.z, i);
        }
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
