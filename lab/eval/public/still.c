/* A published frame as a camera sees it that stands still: is what is curved sharper after a while?
 *
 * The frame is put at 1.5 m and given the noise of two kinds of sensor: time of flight, independent
 * in each pixel and frame, and structured light, alike in neighbours, half of it the same in every
 * frame, in steps. Beside the stage stands what anybody would write: the mean of the frames so far
 * and a plane through 5x5 pixels of inverse depth. Only pixels that the stage gives a normal count.
 */
#include "eval/public/still.h"

#include "eval/analytic.h"
#include "eval/public/frame.h"
#include "eval/table.h"

enum { MEASURED = 3, LAST = 60, PITCH = 4, REACH = 2 };

#define DISTANCE_M 1.5
#define STEPS_M 348.0     /* shift of the pattern at 1 m: 8 x 75 mm x 580 pixels, a Kinect v1 */
#define SHIFT_SIGMA 0.35  /* steps */
#define ONE_SURFACE 0.04f /* share of the depth, for the plain planes */

static const int32_t measured_frame[MEASURED] = {0, 10, LAST};

typedef struct still_sensor {
    rlf_depth_noise noise;
    bool has_steps;
    const char *key[MEASURED], *title[MEASURED], *plain_key[MEASURED], *plain_title[MEASURED];
    const char *missing_key, *missing_title;
} still_sensor;

#define STILL_KEYS(kind)                                                                           \
    .key = {"still_" kind "_0_deg", "still_" kind "_10_deg", "still_" kind "_60_deg"},             \
    .plain_key = {"still_" kind "_plain_0_deg", "still_" kind "_plain_10_deg",                     \
                  "still_" kind "_plain_60_deg"},                                                  \
    .missing_key = "still_" kind "_missing_percent"

#define STILL_TITLES(what)                                                                         \
    .title = {what ", frame 0: normals, mean, deg", what ", frame 10", what ", frame 60"},         \
    .plain_title = {"  mean of frames + 5x5 plane, frame 0", "  mean of frames + 5x5 plane, 10",   \
                    "  mean of frames + 5x5 plane, 60"},                                           \
    .missing_title = what ": without a normal, %"

static const still_sensor sensors[] = {
    {.noise = {0.0, 0.0, 0.0015}, STILL_KEYS("flight"), STILL_TITLES("still, time of flight")},
    {.noise = {0.0008, 0.0, 0.0012},
     .has_steps = true,
     STILL_KEYS("steps"),
     STILL_TITLES("still, structured light")},
};

typedef struct still_run {
    const public_frame *frame;
    const still_sensor *sensor;
    eval_random random;
    float *truth, *seen, *mean; /* planes, metres; 0 = nothing there */
    float *always, *now;        /* errors of structured light: in every frame, in this one */
} still_run;

static void close_run(still_run *run)
{
    float *const planes[5] = {run->truth, run->seen, run->mean, run->always, run->now};
    for (int k = 0; k < 5; k++) {
        rlf_free(planes[k]);
    }
}

/* Where the middle of its depths is DISTANCE_M away. */
static void place(still_run *run)
{
    const float *depth = run->frame->depth;
    double sum = 0.0, count = 0.0;
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        sum += depth[i];
        count += depth[i] > 0.0f ? 1.0 : 0.0;
    }
    float scale = (float)(count > 0.0 ? DISTANCE_M * count / sum : 1.0);
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        run->truth[i] = scale * depth[i];
        run->mean[i] = 0.0f;
    }
}

/* Standard normal numbers every PITCH pixels, interpolated; 1.5 makes up for what that averages. */
static void draw_smooth(eval_random *random, float *out)
{
    enum { COLUMNS = PUBLIC_WIDTH / PITCH + 1, ROWS = PUBLIC_HEIGHT / PITCH + 1 };
    static float knot[ROWS][COLUMNS];
    for (int y = 0; y < ROWS; y++) {
        for (int x = 0; x < COLUMNS; x++) {
            knot[y][x] = (float)eval_random_normal(random);
        }
    }
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        int32_t x = i % PUBLIC_WIDTH, y = i / PUBLIC_WIDTH;
        const float *top = &knot[y / PITCH][x / PITCH], *low = top + COLUMNS;
        float fx = (float)(x % PITCH) / PITCH, fy = (float)(y % PITCH) / PITCH;
        float above = top[0] + (top[1] - top[0]) * fx, below = low[0] + (low[1] - low[0]) * fx;
        out[i] = 1.5f * (above + (below - above) * fy);
    }
}

static double in_steps(double z, double error)
{
    double steps = (double)(int32_t)(STEPS_M / z + SHIFT_SIGMA * error + 0.5);
    return STEPS_M / rlf_max(steps, 1.0);
}

static void see(still_run *run)
{
    const rlf_depth_noise *noise = &run->sensor->noise;
    const double half = 0.70710678;
    if (run->sensor->has_steps) {
        draw_smooth(&run->random, run->now);
    }
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        double z = run->truth[i];
        if (!(z > 0.0)) {
            run->seen[i] = 0.0f;
        } else if (run->sensor->has_steps) {
            run->seen[i] = (float)in_steps(z, half * (run->always[i] + run->now[i]));
        } else {
            double sigma = rlf_depth_noise_sigma(noise, z);
            run->seen[i] = (float)(z + sigma * eval_random_normal(&run->random));
        }
    }
}

static void average(still_run *run, int32_t number)
{
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        run->mean[i] += (run->seen[i] - run->mean[i]) / (float)(number + 1);
    }
}

/* Of the plane w = a + b x + c y of inverse depth through the pixels about one. */
static rlf_vec3 plain_normal(const still_run *run, int32_t i)
{
    const public_frame *f = run->frame;
    float z = run->mean[i];
    double n = 0, x = 0, y = 0, w = 0, xx = 0, xy = 0, yy = 0, xw = 0, yw = 0;
    for (int32_t dy = -REACH; dy <= REACH; dy++) {
        for (int32_t dx = -REACH; dx <= REACH; dx++) {
            int32_t k = i + dy * PUBLIC_WIDTH + dx;
            float apart = run->mean[k] - z;
            if (!(apart < ONE_SURFACE * z) || !(apart > -ONE_SURFACE * z)) {
                continue;
            }
            double u = f->ray_x[k] - f->ray_x[i], v = f->ray_y[k] - f->ray_y[i];
            double inverse = 1.0 / run->mean[k];
            n += 1.0, x += u, y += v, w += inverse, xx += u * u, xy += u * v, yy += v * v;
            xw += u * inverse, yw += v * inverse;
        }
    }
    xx -= x * x / n, xy -= x * y / n, yy -= y * y / n, xw -= x * w / n, yw -= y * w / n;
    double det = xx * yy - xy * xy;
    double b = (xw * yy - yw * xy) / det, c = (yw * xx - xw * xy) / det;
    double a = (w - b * x - c * y) / n - b * f->ray_x[i] - c * f->ray_y[i];
    return rlf_normalize(rlf_vec3_make(-b, -c, -a));
}

typedef struct still_error {
    double sum, plain_sum, count, missing;
} still_error;

static still_error measure(const still_run *run, const rlf_surface *s)
{
    still_error e = {0};
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        int32_t x = i % PUBLIC_WIDTH, y = i / PUBLIC_WIDTH;
        bool is_inside = x >= REACH && x < PUBLIC_WIDTH - REACH && y >= REACH &&
                         y < PUBLIC_HEIGHT - REACH && run->truth[i] > 0.0f;
        if (!is_inside) {
            continue;
        }
        rlf_vec3 n = {s->normal_x[i], s->normal_y[i], s->normal_z[i]};
        rlf_vec3 plain = plain_normal(run, i);
        if (!(rlf_length(n) > 0.5) || !(rlf_length(plain) > 0.5)) {
            e.missing += 1.0;
            continue;
        }
        e.sum += public_error_deg(run->frame, i, n);
        e.plain_sum += public_error_deg(run->frame, i, plain);
        e.count += 1.0;
    }
    return e;
}

static void report(eval_table *table, const still_sensor *sensor, const char *name, int k,
                   const still_error *e)
{
    eval_table_add(table, name, sensor->key[k], sensor->title[k], RLF_PROFILE_LIVE,
                   e->sum / e->count);
    eval_table_add(table, name, sensor->plain_key[k], sensor->plain_title[k], RLF_PROFILE_LIVE,
                   e->plain_sum / e->count);
    if (k == MEASURED - 1) {
        eval_table_add(table, name, sensor->missing_key, sensor->missing_title, RLF_PROFILE_LIVE,
                       100.0 * e->missing / (e->count + e->missing));
    }
}

static rlf_rig make_rig(const still_run *run)
{
    rlf_rig rig = {.depth = run->frame->camera,
                   .T_color_depth = rlf_pose_identity(),
                   .depth_min_m = 0.4,
                   .depth_max_m = 4.5,
                   .noise = run->sensor->noise};
    return rig;
}

static rlf_result watch(still_run *run, eval_table *table, const char *name)
{
    rlf_rig rig = make_rig(run);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    rlf_reconstruct *stage = NULL;
    rlf_result result = rlf_reconstruct_create(&def, &stage);
    draw_smooth(&run->random, run->always);
    for (int32_t n = 0, k = 0; n <= LAST && result == RLF_OK; n++) {
        see(run);
        average(run, n);
        const rlf_frame frame = {.sequence = (uint64_t)n,
                                 .time_ns = (int64_t)n * 33333333,
                                 .rig = &rig,
                                 .depth_f32 = run->seen,
                                 .depth_stride = (ptrdiff_t)sizeof(float) * PUBLIC_WIDTH};
        const rlf_surface *s = NULL;
        result = rlf_reconstruct_process(stage, &frame, &s);
        if (result == RLF_OK && n == measured_frame[k]) {
            still_error e = measure(run, s);
            report(table, run->sensor, name, k++, &e);
        }
    }
    rlf_reconstruct_destroy(&stage);
    return result;
}

static rlf_result run_sensor(eval_table *table, const public_frame *f, const char *name,
                             const still_sensor *sensor)
{
    still_run run = {.frame = f, .sensor = sensor, .random = eval_random_start(1)};
    float **const planes[5] = {&run.truth, &run.seen, &run.mean, &run.always, &run.now};
    rlf_result result = RLF_OK;
    for (int k = 0; k < 5; k++) {
        *planes[k] = rlf_alloc_array(PUBLIC_COUNT, sizeof(float));
        result = *planes[k] != NULL ? result : RLF_ERROR_MEMORY;
    }
    if (result == RLF_OK) {
        place(&run);
        result = watch(&run, table, name);
    }
    close_run(&run);
    return result;
}

rlf_result public_still_run(eval_table *table, const public_frame *f, const char *name,
                            int profile_mask)
{
    rlf_result result = RLF_OK;
    const int count = (int)(sizeof(sensors) / sizeof(sensors[0]));
    bool is_wanted = (profile_mask & (1 << RLF_PROFILE_LIVE)) != 0;
    for (int k = 0; k < count && is_wanted && result == RLF_OK; k++) {
        result = run_sensor(table, f, name, &sensors[k]);
    }
    return result;
}
