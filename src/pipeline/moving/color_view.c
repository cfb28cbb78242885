/* Each depth pixel looks up its colour. */
#include "pipeline/moving/moving.h"

#include <string.h>

#define GRAIN 16 /* rows */

/* Tables of where the rig's depth pixels are seen. */
static rlf_result make_tables(color_view *c, const rlf_rig *rig)
{
    const rlf_camera *depth = &rig->depth;
    const size_t pixels = (size_t)depth->width * (size_t)depth->height;
    float *ray_x = rlf_alloc_array(pixels, sizeof(float));
    float *ray_y = rlf_alloc_array(pixels, sizeof(float));
    rlf_result result = ray_x != NULL && ray_y != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (size_t i = 0; i < pixels && result == RLF_OK; i++) {
        const size_t width = (size_t)depth->width;
        rlf_vec3 ray;
        (void)rlf_camera_unproject(depth, (double)(i % width), (double)(i / width), &ray);
        ray_x[i] = (float)ray.x;
        ray_y[i] = (float)ray.y;
    }
    if (result == RLF_OK) {
        result = rlf_registration_create(depth, ray_x, ray_y, &rig->color, &rig->T_color_depth,
                                         &c->registration);
    }
    rlf_free(ray_x);
    rlf_free(ray_y);
    return result;
}

rlf_result color_view_open(color_view *c, const rlf_rig *rig, rlf_pool *pool)
{
    const size_t pixels = (size_t)rig->depth.width * (size_t)rig->depth.height;
    *c = (color_view){.pool = pool};
    if (!rig->has_color) {
        return RLF_OK;
    }
    c->rgba = rlf_alloc_array(pixels, 4);
    c->grey = rlf_alloc(pixels);
    return c->rgba != NULL && c->grey != NULL ? make_tables(c, rig) : RLF_ERROR_MEMORY;
}

typedef struct color_job {
    const color_view *view;
    const rlf_image_rgba8 *color;
    const rlf_surface *s;
} color_job;

static void take_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const color_job *job = context;
    const int32_t width = job->s->width;
    int32_t seen_at[RLF_IMAGE_SIZE_MAX];
    for (int32_t y = begin; y < end; y++) {
        rlf_registration_find_pixels(job->view->registration, job->s->depth, y, job->color->stride,
                                     seen_at);
        uint8_t *rgba = job->view->rgba + 4 * (ptrdiff_t)y * width;
        uint8_t *grey = job->view->grey + (ptrdiff_t)y * width;
        for (int32_t x = 0; x < width; x++, rgba += 4) {
            memset(rgba, 0, 4);
            grey[x] = 0;
            if (seen_at[x] >= 0) {
                memcpy(rgba, job->color->data + seen_at[x], 3);
                rgba[3] = 255;
                grey[x] = (uint8_t)(1 + (77 * rgba[0] + 150 * rgba[1] + 29 * rgba[2]) / 257);
            }
        }
    }
}

/* What is behind a nearer surface gets that one's colour: the parallax of a rig is small, and other
 * views tell. */
bool color_view_take(const color_view *c, const rlf_frame *frame, const rlf_surface *s)
{
    if (c->rgba == NULL || frame->color.data == NULL) {
        return false;
    }
    color_job job = {c, &frame->color, s};
    rlf_parallel_for(c->pool, s->height, GRAIN, take_rows, &job);
    return true;
}

void color_view_close(color_view *c)
{
    rlf_registration_destroy(&c->registration);
    rlf_free(c->rgba);
    rlf_free(c->grey);
    c->rgba = c->grey = NULL;
}
