/* One line of pixels across a depth edge: where does the near side end? */
#include "environment/edge_matte.h"

#include "environment/depth_edge.h"

enum {
    CLUSTER = 2,    /* pixels: steps this close are one edge, with mixed pixels between */
    WINDOW = 4,     /* pixels beyond the doubtful ones that tell a side's colour */
    REACH_MAX = 24, /* pixels */
    LANES = 16,     /* pixels worked on at once */
    LANES_MAX = 64  /* at least 2 (REACH_MAX + WINDOW), in whole LANES */
};

#define COLOR_VARIANCE 36.0f /* per channel, of noise and texture at least; sRGB steps squared */
#define MOST_EVIDENCE 1.0f   /* of one pixel, nats: its neighbours say much the same */
#define SURE 80.0f           /* contrast, in variances, from which colours have their full say */
#define MOST_COST 0.9f       /* of a pixel farther from the depth's edge, nats */
#define STRANGE 50.0f        /* squared distance from both sides, in variances, that halves it */

/* An edge in coordinates along its line: pixel u = 0 is the first of the far side. */
typedef struct edge {
    int32_t far_pixel;           /* of u = 0 */
    int32_t direction;           /* +1: the far side has the larger indices */
    int32_t near_band, far_band; /* pixels in doubt */
    int32_t near_end, far_end;   /* pixels up to the next edge, at most band + WINDOW */
    float near_z, far_z;
} edge;

/* Mean colours of both sides, and how well they can be told apart. */
typedef struct sides {
    float near_mean[3], far_mean[3];
    float square;   /* of their difference */
    float variance; /* of a pixel along the difference, with the floor */
    float weight;   /* of what they say; 0 = alike */
} sides;

RLF_KERNEL_PART float depth_at(const edge_matte_line *line, int32_t i)
{
    float z = line->z[i * line->step];
    return z > 0.0f ? z : EDGE_MATTE_FAR;
}

static float step_at(const edge_matte_line *line, int32_t i)
{
    float a = depth_at(line, i);
    float b = depth_at(line, i + 1);
    if (!depth_steps(a, b)) {
        return 0.0f;
    }
    float difference = 1.0f / a - 1.0f / b;
    return difference < 0.0f ? -difference : difference;
}

/* True when no step within CLUSTER is larger than that at i (or as large and before it). */
static bool is_main_step(const edge_matte_line *line, int32_t i, float step)
{
    for (int32_t k = i - CLUSTER; k <= i + CLUSTER; k++) {
        if (k >= 0 && k + 1 < line->count && k != i) {
            float other = step_at(line, k);
            if (other > step || (k < i && other >= step)) {
                return false;
            }
        }
    }
    return true;
}

/* Pixels from `i` on in the given direction before depth jumps again; the cluster's own steps do
 * not count. */
static int32_t clear_run(const edge_matte_line *line, int32_t i, int32_t direction, int32_t most)
{
    int32_t run = 1;
    while (run < most) {
        int32_t next = i + direction * run;
        if (next < 0 || next >= line->count) {
            break;
        }
        int32_t lower = direction > 0 ? next - 1 : next;
        if (run > CLUSTER && depth_steps(depth_at(line, lower), depth_at(line, lower + 1))) {
            break;
        }
        run++;
    }
    return run;
}

static int32_t clamp_index(const edge_matte_line *line, int32_t i)
{
    return i < 0 ? 0 : (i >= line->count ? line->count - 1 : i);
}

static edge edge_at(const edge_matte_line *line, int32_t i, int32_t reach)
{
    bool is_far_up = depth_at(line, i) < depth_at(line, i + 1);
    edge e = {.far_pixel = is_far_up ? i + 1 : i, .direction = is_far_up ? 1 : -1};
    int32_t near_pixel = e.far_pixel - e.direction;
    e.near_end = clear_run(line, near_pixel, -e.direction, reach + WINDOW);
    e.far_end = clear_run(line, e.far_pixel, e.direction, reach + WINDOW);
    e.near_band = e.near_end / 2 < reach ? e.near_end / 2 : reach;
    e.far_band = e.far_end / 2 < reach ? e.far_end / 2 : reach;
    /* Beside the edge itself pixels may be mixed. */
    int32_t inside = e.near_end > CLUSTER ? CLUSTER : e.near_end - 1;
    int32_t outside = e.far_end > CLUSTER ? CLUSTER : e.far_end - 1;
    e.near_z = depth_at(line, clamp_index(line, near_pixel - e.direction * inside));
    e.far_z = depth_at(line, clamp_index(line, e.far_pixel + e.direction * outside));
    return e;
}

/* True when the edge runs more across this line than along it. At equal slopes a row has it. */
static bool owns_edge(const edge_matte_line *line, const edge *e)
{
    float middle = 2.0f / (1.0f / e->near_z + 1.0f / e->far_z);
    int32_t along = 0;
    int32_t across = 0;
    int32_t first = line->above < 2 ? -line->above : -2;
    int32_t last = line->below < 2 ? line->below : 2;
    for (int32_t k = -2; k <= 2; k++) {
        const int32_t lane = k < first ? first : (k > last ? last : k);
        ptrdiff_t shift = lane * line->across;
        int32_t ends[2] = {clamp_index(line, e->far_pixel - 3 * e->direction),
                           clamp_index(line, e->far_pixel + 2 * e->direction)};
        float before = line->z[ends[0] * line->step + shift];
        float after = line->z[ends[1] * line->step + shift];
        along += (before > 0.0f && before < middle) - (after > 0.0f && after < middle);
        int32_t i = clamp_index(line, e->far_pixel + k * e->direction);
        float up = line->z[i * line->step + first * line->across];
        float down = line->z[i * line->step + last * line->across];
        across += (up > 0.0f && up < middle) - (down > 0.0f && down < middle);
    }
    along = along < 0 ? -along : along;
    across = across < 0 ? -across : across;
    return line->is_column ? along > across : along >= across;
}

/* Colours of pixels -near_end <= u < far_end, each the mean of its own and of its neighbours' in
 * the lines beside: index u + near_end. */
typedef struct line_colors {
    float channel[3][LANES_MAX];
} line_colors;

RLF_KERNEL_PART void read_colors(const edge_matte_line *line, const edge *e, line_colors *out)
{
    const int32_t count = e->near_end + e->far_end;
    int32_t sum[3][LANES_MAX];
    if (!line->is_column) {
        for (int32_t u = -e->near_end; u < e->far_end; u += LANES) {
            RLF_KERNEL_SOON(line->ahead + line->color_offset[e->far_pixel + e->direction * u]);
        }
    }
    for (int32_t i = 0; i < count; i++) {
        const ptrdiff_t offset =
            line->color_offset[e->far_pixel + e->direction * (i - e->near_end)];
        const uint8_t *own = line->color + offset;
        const uint8_t *first = line->beside[0] + offset;
        const uint8_t *second = line->beside[1] + offset;
        for (int k = 0; k < 3; k++) {
            sum[k][i] = own[k] + first[k] + second[k];
        }
    }
    for (int32_t i = count; i % LANES != 0; i++) {
        sum[0][i] = sum[1][i] = sum[2][i] = 0;
    }
    for (int32_t at = 0; at < count; at += LANES) {
        for (int k = 0; k < 3; k++) {
            RLF_KERNEL_WHOLE
            for (int32_t i = 0; i < LANES; i++) {
                out->channel[k][at + i] = (float)sum[k][at + i] * (1.0f / 3.0f);
            }
        }
    }
}

/* Mean and summed variance of the colours of pixels [begin, end). */
RLF_KERNEL_PART void add_side(const line_colors *colors, const edge *e, int32_t begin, int32_t end,
                              float mean[3], float *variance)
{
    float sum[3] = {0, 0, 0};
    float squares = 0.0f;
    float count = (float)(end - begin);
    for (int32_t i = begin + e->near_end; i < end + e->near_end; i++) {
        for (int k = 0; k < 3; k++) {
            float c = colors->channel[k][i];
            sum[k] += c;
            squares += c * c;
        }
    }
    for (int k = 0; k < 3; k++) {
        mean[k] = sum[k] / count;
        squares -= mean[k] * sum[k];
    }
    *variance += squares > 0.0f ? 0.5f * squares / (3.0f * count) : 0.0f;
}

RLF_KERNEL_PART float square_distance(const float a[3], const float b[3])
{
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return sum;
}

RLF_KERNEL_PART sides sides_of(const line_colors *colors, const edge *e)
{
    sides s = {.variance = COLOR_VARIANCE};
    int32_t near_from = e->near_band < e->near_end ? e->near_band : e->near_end - 1;
    int32_t far_from = e->far_band < e->far_end ? e->far_band : e->far_end - 1;
    add_side(colors, e, -e->near_end, -near_from, s.near_mean, &s.variance);
    add_side(colors, e, far_from, e->far_end, s.far_mean, &s.variance);
    s.square = square_distance(s.near_mean, s.far_mean);
    /* Sides that can hardly be told apart have little to say. */
    float contrast = s.square / (SURE * s.variance);
    s.weight = contrast < 1.0f ? contrast : 1.0f;
    return s;
}

/* Nats for near rather than far, of each pixel and of its neighbours beside: two normal
 * distributions of the same variance, clipped. What looks like neither side says little. */
RLF_KERNEL_PART void find_evidence(const line_colors *colors, const sides sides_here, int32_t count,
                                   float *restrict out)
{
    const sides s = sides_here;
    for (int32_t at = 0; at < count; at += LANES) {
        const float *restrict red = colors->channel[0] + at;
        const float *restrict green = colors->channel[1] + at;
        const float *restrict blue = colors->channel[2] + at;
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < LANES; i++) {
            const float c[3] = {red[i], green[i], blue[i]};
            float from_near = square_distance(c, s.near_mean) / s.variance;
            float from_far = square_distance(c, s.far_mean) / s.variance;
            float strange = (from_near < from_far ? from_near : from_far) / STRANGE;
            float evidence = 0.5f * s.weight * (from_far - from_near);
            evidence = evidence < MOST_EVIDENCE ? evidence : MOST_EVIDENCE;
            evidence = evidence > -MOST_EVIDENCE ? evidence : -MOST_EVIDENCE;
            out[at + i] = evidence / (1.0f + strange * strange);
        }
    }
}

/* Nats that a split k pixels from the depth's own edge costs, which is uncertain by `doubt` pixels.
 * Far away, where now and then a sensor is wrong, less than the evidence of clear colours (Huber
 * 1964). */
RLF_KERNEL_PART float distance_cost(int32_t k, float doubt)
{
    float distance = (float)(k < 0 ? -k : k);
    float bend = MOST_COST * doubt * doubt;
    return distance < bend ? distance * distance / (2.0f * doubt * doubt)
                           : MOST_COST * (distance - 0.5f * bend);
}

/* The split that explains the colours best: pixels u < split are near. */
RLF_KERNEL_PART int32_t find_split(const edge *e, const float near_sum[], float doubt)
{
    float best = -1e30f;
    int32_t split = 0;
    for (int32_t k = -e->near_band; k <= e->far_band; k++) {
        float score = near_sum[k + e->near_band] - distance_cost(k, doubt);
        if (score > best) {
            best = score;
            split = k;
        }
    }
    return split;
}

/* Colour of pixel u, or of the last one before the next edge. */
RLF_KERNEL_PART const uint8_t *color_of(const edge_matte_line *line, const edge *e, int32_t u)
{
    u = u < -e->near_end ? -e->near_end : (u >= e->far_end ? e->far_end - 1 : u);
    return line->color + line->color_offset[e->far_pixel + e->direction * u];
}

/* Shares of the near side in the two pixels beside a split: only these are mixed, and as far as
 * colours do not tell how, each by a quarter of the other side. */
RLF_KERNEL_PART void find_shares(const edge_matte_line *line, const edge *e, int32_t split,
                                 float share[2])
{
    share[0] = 0.75f;
    share[1] = 0.25f;
    if (line->color == NULL) {
        return;
    }
    const uint8_t *near_side[2] = {color_of(line, e, split - 2), color_of(line, e, split - 3)};
    const uint8_t *far_side[2] = {color_of(line, e, split + 1), color_of(line, e, split + 2)};
    const edge_matte_mixture m = edge_matte_mix(near_side, far_side);
    share[0] = edge_matte_share(&m, color_of(line, e, split - 1), share[0]);
    share[1] = edge_matte_share(&m, color_of(line, e, split), share[1]);
}

/* Share of the near side in pixel u. */
RLF_KERNEL_PART float cover_at(const float share[2], int32_t u, int32_t split)
{
    if (u < split - 1 || u > split) {
        return u < split ? 1.0f : 0.0f;
    }
    return share[u - split + 1];
}

RLF_KERNEL_PART void write_pixel(const edge_matte_line *line, const edge *e, int32_t u,
                                 int32_t split, float cover)
{
    ptrdiff_t i = (e->far_pixel + e->direction * u) * line->step;
    int32_t distance = u < split ? split - 1 - u : u - split;
    if (distance >= line->settled[i] >> 8) {
        return;
    }
    float z = line->z[i] > 0.0f ? line->z[i] : EDGE_MATTE_FAR;
    if (line->exact != NULL && line->exact[i] != 0 &&
        !(e->near_z < z && depth_steps(e->near_z, z))) {
        return; /* a model that nothing stands before */
    }
    line->near_z[i] = u < 0 && z < e->near_z ? z : e->near_z;
    line->far_z[i] = u >= 0 && z > e->far_z ? z : e->far_z;
    line->settled[i] = (uint16_t)(distance << 8 | (int32_t)(255.0f * cover + 0.5f));
}

/* The nearer of the pixels i and i + 1 has the depth of a model, whose edge is known. */
static bool is_exact(const edge_matte_line *line, int32_t i)
{
    int32_t nearer = depth_at(line, i) < depth_at(line, i + 1) ? i : i + 1;
    return line->exact != NULL && line->exact[nearer * line->step] != 0;
}

/* Splits the edge's pixels; `doubt`: pixels that the depth's own edge may be off. */
RLF_KERNEL static void settle_edge(const edge_matte_line *line, const edge *at, float doubt)
{
    const edge e = *at;
    sides s = {.variance = COLOR_VARIANCE};
    line_colors colors;
    float evidence[LANES_MAX];
    float near_sum[2 * REACH_MAX + 1] = {0.0f};
    if (line->color != NULL) {
        read_colors(line, &e, &colors);
        s = sides_of(&colors, &e);
    }
    if (s.weight > 0.0f) {
        find_evidence(&colors, s, e.near_end + e.far_end, evidence);
        for (int32_t u = -e.near_band; u < e.far_band; u++) {
            near_sum[u + e.near_band + 1] = near_sum[u + e.near_band] + evidence[u + e.near_end];
        }
    }
    const int32_t split = find_split(&e, near_sum, doubt);
    float share[2];
    find_shares(line, &e, split, share);
    for (int32_t u = -e.near_band; u < e.far_band; u++) {
        write_pixel(line, &e, u, split, cover_at(share, u, split));
    }
}

void edge_matte_settle(const edge_matte_line *line, int32_t i, const edge_matte_tile *tile,
                       int32_t reach)
{
    float step = step_at(line, i);
    if (!(step > 0.0f) || is_exact(line, i) || !is_main_step(line, i, step)) {
        return;
    }
    edge e = edge_at(line, i, reach < REACH_MAX ? reach : REACH_MAX);
    if (!(e.near_z < e.far_z) || tile->far_z < e.near_z || tile->near_z > e.far_z ||
        !owns_edge(line, &e)) {
        return;
    }
    settle_edge(line, &e, (float)reach / 4.5f);
}
