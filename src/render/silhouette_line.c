/* One line of pixels across a depth edge: where does the near side end? */
#include "silhouette.h"

enum {
    CLUSTER = 2,   /* pixels: steps this close are one edge, with mixed pixels between */
    WINDOW = 6,    /* pixels beyond the doubtful ones that tell a side's colour */
    REACH_MAX = 24 /* pixels */
};

#define COLOR_VARIANCE 36.0f /* per channel, of noise and texture at least; sRGB steps squared */
#define MOST_EVIDENCE 1.0f   /* of one pixel, nats: its neighbours say much the same */
#define SURE 40.0f           /* contrast, in variances, from which colours have their full say */
#define CLEAR 6.0f           /* contrast, in variances, from which mixtures can be told */

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
    float middle[3], difference[3]; /* (near + far) / 2, near - far */
    float square;                   /* of the difference */
    float variance;                 /* of a pixel along the difference, with the floor */
} sides;

static float depth_at(const silhouette_line *line, int32_t i)
{
    float z = line->z[i * line->step];
    return z > 0.0f ? z : SILHOUETTE_FAR;
}

static float step_at(const silhouette_line *line, int32_t i)
{
    float a = depth_at(line, i);
    float b = depth_at(line, i + 1);
    if (!silhouette_jumps(a, b)) {
        return 0.0f;
    }
    float difference = 1.0f / a - 1.0f / b;
    return difference < 0.0f ? -difference : difference;
}

/* True when no step within CLUSTER is larger than that at i (or as large and before it). */
static bool is_main_step(const silhouette_line *line, int32_t i, float step)
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
static int32_t clear_run(const silhouette_line *line, int32_t i, int32_t direction, int32_t most)
{
    int32_t run = 1;
    while (run < most) {
        int32_t next = i + direction * run;
        if (next < 0 || next >= line->count) {
            break;
        }
        int32_t lower = direction > 0 ? next - 1 : next;
        if (run > CLUSTER && silhouette_jumps(depth_at(line, lower), depth_at(line, lower + 1))) {
            break;
        }
        run++;
    }
    return run;
}

static int32_t clamp_index(const silhouette_line *line, int32_t i)
{
    return i < 0 ? 0 : (i >= line->count ? line->count - 1 : i);
}

static edge edge_at(const silhouette_line *line, int32_t i, int32_t reach)
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
static bool owns_edge(const silhouette_line *line, const edge *e)
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

/* Sum of the colours of a pixel and of its neighbours in the lines beside. */
static void add_colors(const silhouette_line *line, const edge *e, int32_t u, float sum[3])
{
    ptrdiff_t offset = line->color_offset[e->far_pixel + e->direction * u];
    const uint8_t *own = line->color + offset;
    const uint8_t *first = line->beside[0] + offset;
    const uint8_t *second = line->beside[1] + offset;
    for (int k = 0; k < 3; k++) {
        sum[k] += (float)(own[k] + first[k] + second[k]);
    }
}

/* Mean and summed variance of the colours of pixels [begin, end), in this line and those beside. */
static void add_side(const silhouette_line *line, const edge *e, int32_t begin, int32_t end,
                     float mean[3], float *variance)
{
    float sum[3] = {0, 0, 0};
    float squares = 0.0f;
    float count = (float)(end - begin);
    for (int32_t u = begin; u < end; u++) {
        float here[3] = {0, 0, 0};
        add_colors(line, e, u, here);
        for (int k = 0; k < 3; k++) {
            float c = here[k] * (1.0f / 3.0f);
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

static sides sides_of(const silhouette_line *line, const edge *e)
{
    float near_mean[3];
    float far_mean[3];
    sides s = {.variance = COLOR_VARIANCE};
    int32_t near_from = e->near_band < e->near_end ? e->near_band : e->near_end - 1;
    int32_t far_from = e->far_band < e->far_end ? e->far_band : e->far_end - 1;
    add_side(line, e, -e->near_end, -near_from, near_mean, &s.variance);
    add_side(line, e, far_from, e->far_end, far_mean, &s.variance);
    for (int k = 0; k < 3; k++) {
        s.middle[k] = 0.5f * (near_mean[k] + far_mean[k]);
        s.difference[k] = near_mean[k] - far_mean[k];
        s.square += s.difference[k] * s.difference[k];
    }
    return s;
}

/* (c - middle) . difference: half the square for the near side's colour, minus that for the far
 * side's. */
static float nearness(const sides *s, const float c[3])
{
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) {
        sum += (c[k] - s->middle[k]) * s->difference[k];
    }
    return sum;
}

/* Of the pixel itself, and of the mean with its neighbours beside. */
static float own_nearness(const silhouette_line *line, const edge *e, const sides *s, int32_t u)
{
    const uint8_t *c = line->color + line->color_offset[e->far_pixel + e->direction * u];
    const float own[3] = {(float)c[0], (float)c[1], (float)c[2]};
    return nearness(s, own);
}

static float mean_nearness(const silhouette_line *line, const edge *e, const sides *s, int32_t u)
{
    float c[3] = {0, 0, 0};
    add_colors(line, e, u, c);
    for (int k = 0; k < 3; k++) {
        c[k] *= 1.0f / 3.0f;
    }
    return nearness(s, c);
}

/* The split that explains the colours best: pixels u < split are near. Two normal distributions of
 * the same variance, clipped; the depth's own edge is uncertain by `doubt` pixels. */
static int32_t find_split(const edge *e, const float near_sum[], float doubt)
{
    float best = -1e30f;
    int32_t split = 0;
    for (int32_t k = -e->near_band; k <= e->far_band; k++) {
        float score = near_sum[k + e->near_band] - (float)(k * k) / (2.0f * doubt * doubt);
        if (score > best) {
            best = score;
            split = k;
        }
    }
    return split;
}

static float clamp01(float x)
{
    return x < 0.0f ? 0.0f : (x > 1.0f ? 1.0f : x);
}

static void write_pixel(const silhouette_line *line, const edge *e, int32_t u, int32_t split,
                        float cover)
{
    ptrdiff_t i = (e->far_pixel + e->direction * u) * line->step;
    int32_t distance = u < split ? split - 1 - u : u - split;
    if (distance >= line->distance[i]) {
        return;
    }
    float z = line->z[i] > 0.0f ? line->z[i] : SILHOUETTE_FAR;
    if (line->exact != NULL && line->exact[i] != 0 &&
        !(e->near_z < z && silhouette_jumps(e->near_z, z))) {
        return; /* a model that nothing stands before */
    }
    line->near_z[i] = u < 0 && z < e->near_z ? z : e->near_z;
    line->far_z[i] = u >= 0 && z > e->far_z ? z : e->far_z;
    line->cover[i] = (uint8_t)(255.0f * cover + 0.5f);
    line->distance[i] = (uint8_t)distance;
}

/* The nearer of the pixels i and i + 1 has the depth of a model, whose edge is known. */
static bool is_exact(const silhouette_line *line, int32_t i)
{
    int32_t nearer = depth_at(line, i) < depth_at(line, i + 1) ? i : i + 1;
    return line->exact != NULL && line->exact[nearer * line->step] != 0;
}

void silhouette_settle(const silhouette_line *line, int32_t i, const silhouette_tile *tile,
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
    float mixture[2 * REACH_MAX];
    float near_sum[2 * REACH_MAX + 1];
    sides s = {.square = 0.0f, .variance = 1.0f};
    if (line->color != NULL) {
        s = sides_of(line, &e);
    }
    /* Sides that can hardly be told apart have little to say. */
    float contrast = s.square / (SURE * s.variance);
    float scale = (contrast < 1.0f ? contrast : 1.0f) / s.variance;
    near_sum[0] = 0.0f;
    for (int32_t u = -e.near_band; u < e.far_band; u++) {
        float evidence = s.square > 0.0f ? scale * mean_nearness(line, &e, &s, u) : 0.0f;
        evidence = evidence > MOST_EVIDENCE ? MOST_EVIDENCE : evidence;
        evidence = evidence < -MOST_EVIDENCE ? -MOST_EVIDENCE : evidence;
        mixture[u + e.near_band] =
            s.square > 0.0f ? clamp01(0.5f + own_nearness(line, &e, &s, u) / s.square) : 0.5f;
        near_sum[u + e.near_band + 1] = near_sum[u + e.near_band] + evidence;
    }
    int32_t split = find_split(&e, near_sum, (float)reach / 3.5f);
    bool is_clear = s.square > CLEAR * s.variance;
    for (int32_t u = -e.near_band; u < e.far_band; u++) {
        float cover = u < split ? 1.0f : 0.0f;
        if (u >= split - 2 && u < split + 2 && is_clear) {
            cover = mixture[u + e.near_band];
        } else if (u == split - 1 || u == split) {
            cover = u < split ? 0.75f : 0.25f;
        }
        write_pixel(line, &e, u, split, cover);
    }
}
