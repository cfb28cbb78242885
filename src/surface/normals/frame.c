/* Normals of a frame: of the planes that smooth its depth, of what no plane explains, and, when
 * what moves is known, of both layers. */
#include "surface/steps.h"

#include <string.h>

/* Depth and, with them, normals of the planes that explain the pixels. */
static void make_planes(rlf_reconstruct *stage, const float *depth, float *smooth, rlf_slot *slot)
{
    rlf_normals_job job = rlf_normals_job_make(stage, depth, slot->normal);
    job.smooth = smooth;
    job.frames = stage->work.zero_plane; /* less than one is one */
    if (stage->temporal.frames != NULL) {
        rlf_lasting_measure(stage, depth);
        job.frames = stage->temporal.frames;
        job.lasting = stage->normals.lasting.sigma;
    }
    rlf_normals_plane_fit(&job);
    rlf_normals_widen(stage, &job);
}

void normals_smooth(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    if (stage->def.enable_smoothing) {
        make_planes(stage, kept, slot->depth, slot);
        oversmooth_undo(stage, kept, slot->depth, slot->normal);
        rlf_stage_add_time(stage, RLF_SURFACE_SMOOTH);
    } else {
        memcpy(slot->depth, kept, (size_t)stage->grid.count * sizeof *kept);
    }
}

void normals_complete(rlf_reconstruct *stage, rlf_slot *slot, const uint8_t *was_seen)
{
    if (!stage->def.enable_smoothing) {
        return;
    }
    if (stage->def.enable_edge_normals) {
        rlf_normals_crease(stage, slot, was_seen);
    }
    if (stage->def.enable_fill && stage->def.enable_edge_normals) {
        rlf_normals_contour(stage, slot, was_seen, &stage->normals.contour);
    }
    rlf_normals_job job = rlf_normals_job_make(stage, slot->depth, slot->normal);
    rlf_normals_plane_complete(&job);
    rlf_stage_add_time(stage, RLF_SURFACE_COMPLETE);
}

/* Thesis 4.4.1: the background's normals are computed once; per frame only the foreground's point
 * cloud has normals computed, by itself. */
static void make_layered_normals(rlf_reconstruct *stage, rlf_normals_job *job, rlf_slot *slot)
{
    const background_image *image = background_image_newest(stage);
    float *front = stage->normals.front;
    int32_t count = stage->grid.count;
    for (int32_t i = 0; i < count; i++) {
        front[i] = slot->foreground[i] ? slot->depth[i] : 0.0f;
    }
    job->depth = front;
    rlf_normals_compute(job);
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            bool behind = !slot->foreground[i] && slot->depth[i] > 0.0f;
            slot->normal[k][i] = behind ? image->normal[k][i] : slot->normal[k][i];
        }
    }
}

void normals_finish(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    rlf_normals_job job = rlf_normals_job_make(stage, slot->depth, slot->normal);
    bool is_exact = stage->def.normal_method == RLF_NORMALS_INVERSE_DEPTH;
    bool is_layered = stage->def.background_method == RLF_BACKGROUND_AVERAGE && !is_exact &&
                      background_image_newest(stage) != NULL;
    if (is_exact && stage->def.enable_smoothing && job.face_camera) {
        if (stage->normals.vote.votes != NULL) { /* the rest was made with the depth */
            vote_normals(stage, slot);
        }
    } else if (is_layered) {
        make_layered_normals(stage, &job, slot);
    } else {
        if (stage->def.enable_fill && is_exact) { /* what was filled shapes none of what was seen */
            job.depth = kept;
            job.filled = slot->depth;
        }
        rlf_normals_compute(&job);
    }
    rlf_stage_add_time(stage, RLF_SURFACE_NORMALS);
}

static void take_wide(normals_state *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                      const image_grid *grid)
{
    const float *ray_x = grid->ray_x, *ray_y = grid->ray_y;
    int32_t width = grid->width, height = grid->height;
    for (int level = 0; level < RLF_WIDE_LEVELS && rlf_wide_is_wanted(def, grid); level++) {
        rlf_wide *wide = &state->wide[level];
        wide->width = width / 2;
        wide->height = height / 2;
        size_t n = (size_t)wide->width * (size_t)wide->height;
        float **const planes[] = {&wide->ray_x,     &wide->ray_y,     &wide->depth,
                                  &wide->smooth,    &wide->normal[0], &wide->normal[1],
                                  &wide->normal[2], &wide->frames};
        for (size_t k = 0; k < sizeof planes / sizeof planes[0]; k++) {
            *planes[k] = arena_take(arena, n, sizeof(float));
        }
        if (wide->ray_x != NULL) {
            rlf_wide_fill_rays(ray_x, ray_y, width, wide);
        }
        ray_x = wide->ray_x;
        ray_y = wide->ray_y;
        width = wide->width;
        height = wide->height;
    }
}

void normals_allocate(normals_state *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                      const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    arena_next_owner(arena);
    state->bent = arena_lend(arena, n, 1);
    arena_next_owner(arena);
    state->front = arena_lend(arena, n, sizeof(float));
    arena_next_owner(arena);
    for (int k = 0; k < 3; k++) {
        state->contour.normal[k] = arena_lend(arena, n, sizeof(float));
    }
    state->contour.mark = arena_lend(arena, n, 1);
    state->contour.front = arena_lend(arena, n, 1);
    if (vote_is_wanted(def)) {
        state->vote.votes = arena_take(arena, n, sizeof *state->vote.votes);
        state->vote.watch = arena_take(arena, n, 1);
    }
    take_wide(state, arena, def, grid);
}

void normals_reset(normals_state *state, const image_grid *grid)
{
    size_t n = (size_t)grid->count;
    state->lasting = (rlf_lasting){.sigma = (float)RLF_LASTING_ALL};
    if (state->vote.votes != NULL) {
        memset(state->vote.votes, 0, n * sizeof *state->vote.votes);
        memset(state->vote.watch, 0, n);
    }
}
