/* The colour criterion (Abramov et al. 2012): neighbours that belong together have nearly the same
 * hue, saturation and value.
 *
 * Colours are compared in the HSV cone, (s v cos h, s v sin h, v): hue says nothing where a colour
 * is grey or dark, and there the cone is narrow. Hue and chroma are the circular ones (Hanbury and
 * Serra 2003), which need no trigonometry. */
#include "surface/steps.h"

enum { NO_COLOR = 0, HAS_COLOR = 1 << 24 };

typedef struct color_job {
    const rlf_reconstruct *stage;
    const rlf_image_rgba8 *image;
    const float *depth;
    uint32_t *out;
} color_job;

/* Nearest pixel of the colour image where a point of the depth camera is seen. */
static uint32_t color_of(const color_job *job, ptrdiff_t i)
{
    const image_grid *grid = &job->stage->grid;
    const rlf_rig *rig = &job->stage->def.rig;
    double z = job->depth[i], u, v;
    rlf_vec3 p = {z * grid->ray_x[i], z * grid->ray_y[i], z};
    if (!(z > 0.0) ||
        !rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u, &v)) {
        return NO_COLOR;
    }
    if (!(u > -0.5) || !(v > -0.5) || !(u < job->image->width - 0.5) ||
        !(v < job->image->height - 0.5)) {
        return NO_COLOR;
    }
    const uint8_t *c = rlf_rgba8_row(job->image, (int32_t)(v + 0.5)) + 4 * (int32_t)(u + 0.5);
    return HAS_COLOR | (uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | (uint32_t)c[2];
}

static void color_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const color_job *job = context;
    ptrdiff_t width = job->stage->grid.width;
    for (ptrdiff_t i = begin * width; i < end * width; i++) {
        job->out[i] = color_of(job, i);
    }
}

void rlf_color_sample(rlf_reconstruct *stage, const rlf_frame *frame, const float *depth)
{
    stage->has_color =
        stage->def.segment_color_tau > 0.0 && stage->def.rig.has_color && frame->color.data != NULL;
    if (stage->has_color) {
        color_job job = {stage, &frame->color, depth, stage->work.color};
        rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, color_rows, &job);
    }
}

void rlf_color_learn(rlf_reconstruct *stage, const uint8_t *foreground)
{
    for (int32_t i = 0; i < stage->grid.count && stage->has_color; i++) {
        if (foreground[i] == 0 && stage->work.color[i] != NO_COLOR) {
            stage->background.color[i] = stage->work.color[i];
        }
    }
}

bool rlf_color_is_near(uint32_t a, uint32_t b, double tau)
{
    if (a == NO_COLOR || b == NO_COLOR) {
        return true; /* what was not seen does not separate */
    }
    double cone[2][3];
    const uint32_t color[2] = {a, b};
    for (int k = 0; k < 2; k++) {
        double red = color[k] >> 16 & 255, green = color[k] >> 8 & 255, blue = color[k] & 255;
        cone[k][0] = red - 0.5 * (green + blue);
        cone[k][1] = 0.8660254037844386 * (green - blue);
        cone[k][2] = rlf_max(red, rlf_max(green, blue));
    }
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double step = (cone[0][k] - cone[1][k]) / 255.0;
        sum += step * step;
    }
    return sum <= tau * tau;
}

void rlf_color_cut_links(const rlf_reconstruct *stage, const uint32_t *color, const rlf_span *spans)
{
    const image_grid *grid = &stage->grid;
    double tau = stage->def.segment_color_tau;
    const int32_t bits[4] = {RLF_LINK_LEFT, RLF_LINK_UP, RLF_LINK_UP_LEFT, RLF_LINK_UP_RIGHT};
    const ptrdiff_t step[4] = {-1, -grid->width, -grid->width - 1, -grid->width + 1};
    for (int32_t y = 0; y < grid->height; y++) {
        const rlf_span span = spans != NULL ? spans[y] : (rlf_span){0, grid->width};
        ptrdiff_t row = (ptrdiff_t)y * grid->width;
        for (ptrdiff_t i = row + span.x0; i < row + span.x1; i++) {
            int32_t link = stage->work.links[i];
            for (int k = 0; k < 4; k++) {
                if ((link & bits[k]) && !rlf_color_is_near(color[i], color[i + step[k]], tau)) {
                    link &= ~bits[k];
                }
            }
            stage->work.links[i] = (uint8_t)link;
        }
    }
}
