/* The side of an edge that a dropped pixel is on, by the colour picture (as in guided upsampling of
 * depth: Kopf et al. 2007, "Joint bilateral upsampling").
 *
 * Beside an edge the nearer side has the same outline in both cameras' pictures. So the picture is
 * read as it shows what is at the depth of the nearer end: at the pixel, and at those about it that
 * were seen and whose side is known. The pixel's colour lies between the means of both sides, and
 * its share of the nearer one's says on which side of the outline the pixel's middle is. That
 * counts as far as the sides differ by more than each in itself, and as the colour is a mixture of
 * theirs at all.
 *
 * The outline has to be found to a fraction of a pixel, nearer than cameras are calibrated. The
 * votes of depth know it well on the whole, though not for each pixel: so the picture's offset from
 * them, two components and how much wider it shows what is nearer, is estimated by least squares
 * over the edges of the last frames. Where the two do not agree on pixels that depth is sure of, as
 * when the picture is late or of something else, it is not asked: trust falls to 0. */
#include "surface/stage.h"

#include "kernel/color.h"
#include "math/inverse.h"

#include <string.h>

enum { OFFSETS = 3, REACH = RLF_FILL_GAP + 1, NEAR_ROWS = 3 };

const int32_t rlf_line_step[RLF_LINE_NONE][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};

static const float most_votes = 5.0f; /* more against it need not be asked about */

static const double kept = 0.95;         /* of the sums, from frame to frame */
static const double least_pixels = 50.0; /* a frame has some hundreds; fewer tell little */
static const float widest_learnt = 5.0f; /* pixels without depth */
static const float least_vote = 0.05f, sure_votes = 3.0f, sure_share = 0.2f, sure_weight = 0.5f;
static const double good_differ = 0.03, bad_differ = 0.05; /* share of them */

static void read_between(const rlf_image_rgba8 *image, float u, float v, float out[3])
{
    int32_t x = (int32_t)u, y = (int32_t)v;
    float right = u - (float)x, below = v - (float)y;
    const uint8_t *top = rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x;
    const uint8_t *bottom = rlf_rgba8_row(image, y + 1) + 4 * (ptrdiff_t)x;
    for (int32_t k = 0; k < 3; k++) {
        float a = (float)top[k] + right * (float)(top[k + 4] - top[k]);
        float b = (float)bottom[k] + right * (float)(bottom[k + 4] - bottom[k]);
        out[k] = a + below * (b - a);
    }
}

/* Pixels along the line, towards the nearer end. */
typedef struct towards {
    float x, y;
} towards;

static towards towards_near(const rlf_guide_cases *c, int32_t k)
{
    const int32_t *line = rlf_line_step[c->line[k]];
    float sign = c->ends->before[k] < c->ends->after[k] ? -1.0f : 1.0f;
    return (towards){sign * (float)line[0], sign * (float)line[1]};
}

/* Where the picture shows the pixel if it is at the nearer end's depth. False where it does not, or
 * not all about it. */
static bool find_place(const rlf_reconstruct *stage, const rlf_guide_cases *c, int32_t k,
                       rlf_color_places *out)
{
    const rlf_color_guide *side = &stage->guide;
    const rlf_rig *rig = &stage->def.rig;
    ptrdiff_t i = (ptrdiff_t)c->y[k] * stage->grid.width + c->x[k];
    float before = c->ends->before[k], after = c->ends->after[k];
    double z = before < after ? before : after, u, v;
    rlf_vec3 p = {z * stage->grid.ray_x[i], z * stage->grid.ray_y[i], z};
    if (!rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u, &v)) {
        return false;
    }
    towards near_end = towards_near(c, k);
    float x = side->offset[0] + side->offset[2] * near_end.x;
    float y = side->offset[1] + side->offset[2] * near_end.y;
    float at_u = (float)u + side->step[0][0] * x + side->step[0][1] * y;
    float at_v = (float)v + side->step[1][0] * x + side->step[1][1] * y;
    float reach = side->reach;
    if (!(at_u >= reach && at_v >= reach && at_u < (float)rig->color.width - 1.0f - reach &&
          at_v < (float)rig->color.height - 1.0f - reach)) {
        return false;
    }
    int32_t near = rlf_least(NEAR_ROWS, (int32_t)reach); /* of the rows that are read, most */
    for (int32_t r = -near; r <= near; r++) {
        RLF_KERNEL_SOON(rlf_rgba8_row(&side->image, (int32_t)at_v + r) + 4 * (ptrdiff_t)at_u);
    }
    out->u[k] = at_u;
    out->v[k] = at_v;
    out->line[0][k] = (float)rlf_line_step[c->line[k]][0];
    out->line[1][k] = (float)rlf_line_step[c->line[k]][1];
    return true;
}

/* Reads the picture for those that are asked. */
static void read_samples(const rlf_color_guide *side, const rlf_guide_cases *c,
                         const bool *is_asked, const rlf_color_places *places,
                         rlf_color_samples *out)
{
    int32_t offset[RLF_COLOR_SAMPLES][RLF_BATCH];
    rlf_kernel_color_offsets(places, c->ends, offset);
    memset(out, 0, sizeof *out);
    for (int32_t k = 0; k < c->count; k++) {
        if (!is_asked[k]) {
            continue;
        }
        for (int32_t s = 0; s < RLF_COLOR_SAMPLES; s++) {
            const uint8_t *p = side->image.data + offset[s][k];
            out->sample[s][k] = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
                                (uint32_t)p[3] << 24; /* one load */
        }
        float color[3];
        read_between(&side->image, places->u[k], places->v[k], color);
        for (int32_t n = 0; n < 3; n++) {
            out->color[n][k] = color[n];
        }
    }
}

/* Unit vector towards the nearer side of what is about the pixel, times `along` the line; false
 * where that is no direction across the line's edge. */
static bool find_across(const rlf_guide_cases *c, int32_t k, const rlf_color_shares *shares,
                        double out[OFFSETS])
{
    towards near_end = towards_near(c, k);
    float x = shares->way[0][k], y = shares->way[1][k];
    float along = x * near_end.x + y * near_end.y;
    if (!(along > 0.0f) || along * along < 0.25f * (x * x + y * y)) {
        return false;
    }
    out[0] = x / along;
    out[1] = y / along;
    out[2] = 1.0;
    return true;
}

/* A line across an edge has as many pixels more of the nearer side, by the picture than by depth,
 * as the outline is off along it. */
static void note(const rlf_color_guide *side, const rlf_guide_cases *c, int32_t k,
                 const rlf_color_shares *shares, rlf_color_sum *sum)
{
    double across[OFFSETS];
    float share = shares->share[k], worth = shares->worth[k], votes = c->votes[k];
    float wide = c->ends->to_before[k] + c->ends->to_after[k] - 1.0f;
    float vote = votes > 0.0f ? 1.0f : 0.0f;
    if (rlf_kernel_abs(votes) > sure_votes && rlf_kernel_abs(share - 0.5f) > sure_share &&
        worth > sure_weight) {
        sum->agree += (share > 0.5f) == (vote > 0.5f) ? 1.0 : 0.0;
        sum->asked += 1.0;
    }
    if (wide > widest_learnt || rlf_kernel_abs(votes) < least_vote ||
        !find_across(c, k, shares, across)) {
        return;
    }
    double now = -(double)(wide * (share - vote)), weight = worth / wide;
    for (int32_t r = 0; r < OFFSETS; r++) {
        now += across[r] * (double)side->offset[r];
    }
    for (int32_t r = 0; r < OFFSETS; r++) {
        for (int32_t m = 0; m < OFFSETS; m++) {
            sum->square[r * OFFSETS + m] += weight * across[r] * across[m];
        }
        sum->value[r] += weight * across[r] * now;
    }
}

void rlf_color_guide_vote(const rlf_reconstruct *stage, const rlf_guide_cases *c,
                          const bool may_ask[RLF_BATCH], rlf_color_sum *sum)
{
    const rlf_color_guide *side = &stage->guide;
    rlf_color_places places;
    rlf_color_samples samples;
    rlf_color_shares shares;
    bool is_asked[RLF_BATCH];
    int32_t asked = 0;
    memset(&places, 0, sizeof places);
    memcpy(places.step, side->step, sizeof places.step);
    places.stride = (int32_t)side->image.stride;
    for (int32_t k = 0; k < c->count; k++) {
        is_asked[k] = may_ask[k] && rlf_kernel_abs(c->votes[k]) <= most_votes &&
                      find_place(stage, c, k, &places);
        asked += is_asked[k] ? 1 : 0;
    }
    if (asked == 0) {
        return;
    }
    read_samples(side, c, is_asked, &places, &samples);
    rlf_kernel_color_shares(c->depth, c->ends, &samples, &shares);
    for (int32_t k = 0; k < c->count; k++) {
        if (is_asked[k]) {
            note(side, c, k, &shares, sum);
            c->votes[k] +=
                side->trust * shares.worth[k] * (2.0f * shares.share[k] - 1.0f) * most_votes;
        }
    }
}

/* Colour pixels from one pixel of the grid to the next, where both cameras look. */
static bool find_steps(const rlf_reconstruct *stage, rlf_color_guide *side)
{
    const rlf_camera *grid = &stage->grid.camera;
    const rlf_rig *rig = &stage->def.rig;
    const double z = 0.5 * (stage->def.depth_min_m + stage->def.depth_max_m);
    double u[3], v[3];
    for (int32_t k = 0; k < 3; k++) {
        rlf_vec3 p = {k == 1 ? z / grid->fx : 0.0, k == 2 ? z / grid->fy : 0.0, z};
        if (!rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u[k], &v[k])) {
            return false;
        }
    }
    side->reach = 1.0f;
    for (int32_t k = 0; k < 2; k++) {
        side->step[0][k] = (float)(u[k + 1] - u[0]);
        side->step[1][k] = (float)(v[k + 1] - v[0]);
    }
    for (int32_t k = 0; k < 4; k++) {
        side->reach += (float)REACH * rlf_kernel_abs(side->step[k / 2][k % 2]);
    }
    return true;
}

void rlf_color_guide_start(rlf_reconstruct *stage, const rlf_frame *frame)
{
    const rlf_rig *rig = &stage->def.rig;
    rlf_color_guide *side = &stage->guide;
    bool is_it = frame->color.data != NULL && side->can_tell &&
                 frame->color.width == rig->color.width && frame->color.height == rig->color.height;
    side->image = is_it ? frame->color : (rlf_image_rgba8){.data = NULL};
    if (is_it) {
        memset(side->part, 0, (size_t)side->parts * sizeof *side->part);
    }
}

void rlf_color_guide_reset(rlf_reconstruct *stage)
{
    rlf_color_guide *side = &stage->guide;
    side->can_tell = side->part != NULL && find_steps(stage, side);
    side->sum = (rlf_color_sum){.asked = 0.0};
    memset(side->offset, 0, sizeof side->offset);
    side->trust = 0.0f;
}

/* `to` counts so much from now on, and `more` in full. */
static void add_sum(rlf_color_sum *to, double share, const rlf_color_sum *more)
{
    to->agree = share * to->agree + more->agree;
    to->asked = share * to->asked + more->asked;
    for (int32_t k = 0; k < OFFSETS * OFFSETS; k++) {
        to->square[k] = share * to->square[k] + more->square[k];
    }
    for (int32_t k = 0; k < OFFSETS; k++) {
        to->value[k] = share * to->value[k] + more->value[k];
    }
}

void rlf_color_guide_learn(rlf_reconstruct *stage)
{
    rlf_color_guide *side = &stage->guide;
    double inverse[OFFSETS * OFFSETS];
    if (side->image.data == NULL) {
        return;
    }
    for (int32_t p = 0; p < side->parts; p++) {
        add_sum(&side->sum, p == 0 ? kept : 1.0, &side->part[p]);
    }
    side->image.data = NULL; /* the caller's */
    memcpy(inverse, side->sum.square, sizeof inverse);
    for (int32_t k = 0; k < OFFSETS; k++) {
        inverse[k * OFFSETS + k] += least_pixels;
    }
    math_invert(inverse, OFFSETS);
    for (int32_t k = 0; k < OFFSETS; k++) {
        double offset = 0.0;
        for (int32_t m = 0; m < OFFSETS; m++) {
            offset += inverse[k * OFFSETS + m] * side->sum.value[m];
        }
        side->offset[k] = (float)offset;
    }
    double asked = side->sum.asked, differ = asked - side->sum.agree;
    double trust = (bad_differ * asked - differ) / ((bad_differ - good_differ) * (asked + 1e-9));
    side->trust = asked < least_pixels ? 0.0f : (float)rlf_clamp(trust, 0.0, 1.0);
}

void color_guide_allocate(rlf_color_guide *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                          const image_grid *grid)
{
    if (def->enable_color_sides && def->enable_fill && def->rig.has_color) {
        state->parts = (grid->height + RLF_ROW_GRAIN - 1) / RLF_ROW_GRAIN;
        state->part = arena_take(arena, (size_t)state->parts, sizeof *state->part);
    }
}
