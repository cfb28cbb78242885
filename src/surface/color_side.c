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
#include "surface/color_side.h"

#include "math/inverse.h"

#include <string.h>

enum { OFFSETS = 3, PX = RLF_WINDOW_ABOUT, REACH = RLF_FILL_GAP + 1, WIDEST_LEARNT = 5 };

const int32_t rlf_line_step[RLF_LINE_NONE][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};

enum { ABOUT = 12 }; /* pixels whose colours are read, besides the ends */

/* Their columns and rows from the pixel, and what each counts: exp(-d^2 / 1.6 px^2). */
static const int32_t about[ABOUT][2] = {{0, -2}, {-1, -1}, {0, -1}, {1, -1}, {-2, 0}, {-1, 0},
                                        {1, 0},  {2, 0},   {-1, 1}, {0, 1},  {1, 1},  {0, 2}};
static const float weight_at[ABOUT] = {0.082f, 0.287f, 0.535f, 0.287f, 0.082f, 0.535f,
                                       0.535f, 0.082f, 0.287f, 0.535f, 0.287f, 0.082f};
static const float end_weight = 0.2f;      /* that of an end */
static const float noise = 36.0f;          /* variance of a colour, sRGB steps squared */
static const float within_weight = 1.333f; /* of the variance within the sides beside it */
static const float off_line = 0.6f;        /* see silhouette_mixture.h */
static const float most_votes = 5.0f;      /* more against it need not be asked about */

static const double kept = 0.95, kept_trust = 0.9; /* of the sums, from frame to frame */
static const double ridge = 50.0;                  /* pixels; a frame has some hundreds */
static const float least_vote = 0.05f, sure_votes = 3.0f, sure_share = 0.2f, sure_weight = 0.5f;
static const double least_sure = 50.0;                     /* pixels */
static const double good_differ = 0.03, bad_differ = 0.05; /* share of them */

/* Colours of one side, and their fourth channel, which nobody asks for. */
typedef struct palette {
    float weight, sum[4], square[4];
} palette;

typedef struct place {
    float u, v;   /* in the picture */
    float dx, dy; /* pixels along the line, towards the nearer end */
} place;

/* The colour of the pixel that is so many columns and rows on. */
static void add_color(palette *p, const rlf_color_side *side, const place *at, const int32_t to[2],
                      float weight)
{
    float x = (float)to[0], y = (float)to[1];
    float u = at->u + side->step[0][0] * x + side->step[0][1] * y + 0.5f;
    float v = at->v + side->step[1][0] * x + side->step[1][1] * y + 0.5f;
    const uint8_t *c = rlf_rgba8_row(&side->image, (int32_t)v) + 4 * (ptrdiff_t)(int32_t)u;
    p->weight += weight;
    for (int32_t k = 0; k < 4; k++) {
        float value = (float)c[k], part = weight * value;
        p->sum[k] += part;
        p->square[k] += part * value;
    }
}

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

/* Where the picture shows the pixel if it is at the nearer end's depth. False where it does not, or
 * not all about it. */
static bool find_place(const rlf_reconstruct *stage, const rlf_side_case *c, place *out)
{
    const rlf_color_side *side = &stage->side;
    const rlf_rig *rig = &stage->def.rig;
    ptrdiff_t i = (ptrdiff_t)c->y * stage->grid.width + c->x;
    float towards = c->before < c->after ? -1.0f : 1.0f;
    double z = c->before < c->after ? c->before : c->after, u, v;
    rlf_vec3 p = {z * stage->grid.ray_x[i], z * stage->grid.ray_y[i], z};
    if (!rlf_camera_project(&rig->color, rlf_transform(&rig->T_color_depth, p), &u, &v)) {
        return false;
    }
    out->dx = towards * (float)rlf_line_step[c->line][0];
    out->dy = towards * (float)rlf_line_step[c->line][1];
    float x = side->offset[0] + side->offset[2] * out->dx;
    float y = side->offset[1] + side->offset[2] * out->dy;
    out->u = (float)u + side->step[0][0] * x + side->step[0][1] * y;
    out->v = (float)v + side->step[1][0] * x + side->step[1][1] * y;
    float reach = side->reach;
    return out->u >= reach && out->v >= reach && out->u < (float)rig->color.width - 1.0f - reach &&
           out->v < (float)rig->color.height - 1.0f - reach;
}

/* [1] = of the nearer side. */
static void gather(const rlf_color_side *side, const rlf_side_case *c, const place *at,
                   palette out[2])
{
    const int32_t to_ends[2] = {-c->to_before, c->to_after};
    const float ends[2] = {c->before, c->after};
    memset(out, 0, 2 * sizeof *out);
    for (int32_t k = 0; k < ABOUT; k++) {
        float z = c->depth->at[(about[k][1] + PX) * RLF_WINDOW_SIDE + about[k][0] + PX][c->lane];
        if (z > 0.0f) {
            add_color(&out[z < c->middle ? 1 : 0], side, at, about[k], weight_at[k]);
        }
    }
    for (int32_t k = 0; k < 2; k++) {
        const int32_t to[2] = {to_ends[k] * rlf_line_step[c->line][0],
                               to_ends[k] * rlf_line_step[c->line][1]};
        add_color(&out[ends[k] < c->middle ? 1 : 0], side, at, to, end_weight);
    }
}

/* Share of the nearer side in a colour, 0..1, and what that is worth, 0..1. */
static float find_share(const palette sides[2], const float color[3], float *worth)
{
    float apart = 0.0f, along = 0.0f, from_far = 0.0f, within = 0.0f;
    float inverse[2] = {1.0f / sides[0].weight, 1.0f / sides[1].weight};
    for (int32_t k = 0; k < 3; k++) {
        float far_mean = sides[0].sum[k] * inverse[0], near_mean = sides[1].sum[k] * inverse[1];
        float step = near_mean - far_mean, off = color[k] - far_mean;
        within += sides[0].square[k] * inverse[0] - far_mean * far_mean;
        within += sides[1].square[k] * inverse[1] - near_mean * near_mean;
        apart += step * step;
        along += step * off;
        from_far += off * off;
    }
    within = within > 0.0f ? within : 0.0f;
    *worth = apart / (apart + within_weight * within + noise);
    if (!(apart > 1.0f)) {
        *worth = 0.0f;
        return 0.5f;
    }
    float share = along / apart, strange = (from_far - share * along) / (off_line * apart);
    strange = strange > 0.0f ? strange : 0.0f;
    *worth /= 1.0f + strange * strange;
    return share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
}

/* Unit vector towards the nearer side of what is about the pixel, times `along` the line; false
 * where that is no direction across the line's edge. */
static bool find_across(const rlf_side_case *c, const place *at, double out[OFFSETS])
{
    float x = 0.0f, y = 0.0f;
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        float z = c->depth->at[k][c->lane];
        float sign = z > 0.0f ? (z < c->middle ? 1.0f : -1.0f) : 0.0f;
        x += sign * (float)(k % RLF_WINDOW_SIDE - PX);
        y += sign * (float)(k / RLF_WINDOW_SIDE - PX);
    }
    float along = x * at->dx + y * at->dy;
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
static void note(const rlf_color_side *side, const rlf_side_case *c, const place *at, float share,
                 float worth, rlf_color_sum *sum)
{
    double across[OFFSETS];
    int32_t wide = c->to_before + c->to_after - 1;
    float vote = c->votes > 0.0f ? 1.0f : 0.0f;
    if (rlf_kernel_abs(c->votes) > sure_votes && rlf_kernel_abs(share - 0.5f) > sure_share &&
        worth > sure_weight) {
        sum->agree += (share > 0.5f) == (vote > 0.5f) ? 1.0 : 0.0;
        sum->asked += 1.0;
    }
    if (wide > WIDEST_LEARNT || rlf_kernel_abs(c->votes) < least_vote ||
        !find_across(c, at, across)) {
        return;
    }
    double now = -(double)((float)wide * (share - vote)), weight = worth / (float)wide;
    for (int32_t k = 0; k < OFFSETS; k++) {
        now += across[k] * (double)side->offset[k];
    }
    for (int32_t k = 0; k < OFFSETS; k++) {
        for (int32_t m = 0; m < OFFSETS; m++) {
            sum->square[k * OFFSETS + m] += weight * across[k] * across[m];
        }
        sum->value[k] += weight * across[k] * now;
    }
}

float rlf_color_side_vote(const rlf_reconstruct *stage, const rlf_side_case *c, rlf_color_sum *sum)
{
    const rlf_color_side *side = &stage->side;
    place at;
    palette sides[2];
    float color[3], worth;
    if (rlf_kernel_abs(c->votes) > most_votes || !find_place(stage, c, &at)) {
        return 0.0f;
    }
    gather(side, c, &at, sides);
    read_between(&side->image, at.u, at.v, color);
    float share = find_share(sides, color, &worth);
    note(side, c, &at, share, worth, sum);
    return side->trust * worth * (2.0f * share - 1.0f) * most_votes;
}

/* Colour pixels from one pixel of the grid to the next, where both cameras look. */
static bool find_steps(const rlf_reconstruct *stage, rlf_color_side *side)
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

void rlf_color_side_start(rlf_reconstruct *stage, const rlf_frame *frame)
{
    const rlf_rig *rig = &stage->def.rig;
    rlf_color_side *side = &stage->side;
    bool is_it = frame->color.data != NULL && side->can_tell &&
                 frame->color.width == rig->color.width && frame->color.height == rig->color.height;
    side->image = is_it ? frame->color : (rlf_image_rgba8){.data = NULL};
    if (is_it) {
        memset(side->part, 0, (size_t)side->parts * sizeof *side->part);
    }
}

void rlf_color_side_reset(rlf_reconstruct *stage)
{
    rlf_color_side *side = &stage->side;
    side->can_tell = side->part != NULL && find_steps(stage, side);
    side->sum = (rlf_color_sum){.asked = 0.0};
    memset(side->offset, 0, sizeof side->offset);
    side->trust = 0.0f;
}

static void add_parts(rlf_color_side *side)
{
    rlf_color_sum *sum = &side->sum;
    sum->agree *= kept_trust;
    sum->asked *= kept_trust;
    for (int32_t k = 0; k < OFFSETS * OFFSETS; k++) {
        sum->square[k] *= kept;
    }
    for (int32_t k = 0; k < OFFSETS; k++) {
        sum->value[k] *= kept;
    }
    for (int32_t p = 0; p < side->parts; p++) {
        const rlf_color_sum *part = &side->part[p];
        sum->agree += part->agree;
        sum->asked += part->asked;
        for (int32_t k = 0; k < OFFSETS * OFFSETS; k++) {
            sum->square[k] += part->square[k];
        }
        for (int32_t k = 0; k < OFFSETS; k++) {
            sum->value[k] += part->value[k];
        }
    }
}

void rlf_color_side_learn(rlf_reconstruct *stage)
{
    rlf_color_side *side = &stage->side;
    double inverse[OFFSETS * OFFSETS];
    if (side->image.data == NULL) {
        return;
    }
    add_parts(side);
    side->image.data = NULL; /* the caller's */
    memcpy(inverse, side->sum.square, sizeof inverse);
    for (int32_t k = 0; k < OFFSETS; k++) {
        inverse[k * OFFSETS + k] += ridge;
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
    side->trust = asked < least_sure ? 0.0f : (float)rlf_clamp(trust, 0.0, 1.0);
}
