/* Milliseconds of the surface stage on frames that no room shows, beside those of a still wall in
 * the same run: the cost must stay bounded whatever a camera sends. One thread. */
#include "hostile.h"

#include <stdio.h>

#define WIDTH 512
#define HEIGHT 424
#define FRAMES 60
#define WARM_UP 12 /* the background is made in these */

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Fills median and worst milliseconds of a frame; false when there is no memory. */
static bool measure(const rlf_rig *rig, hostile_pattern pattern, double out_ms[2])
{
    static uint16_t depth[WIDTH * HEIGHT];
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, rig);
    rlf_reconstruct *stage = NULL;
    if (rlf_reconstruct_create(&def, &stage) != RLF_OK) {
        return false;
    }
    double times[FRAMES];
    int32_t count = 0;
    for (int32_t t = 0; t < WARM_UP + FRAMES; t++) {
        hostile_draw(rig, pattern, t, depth);
        rlf_frame frame = hostile_frame(rig, depth, t);
        const rlf_surface *surface;
        int64_t start = rlf_clock_ns();
        rlf_result result = rlf_reconstruct_process(stage, &frame, &surface);
        if (result == RLF_OK && t >= WARM_UP) {
            times[count++] = (double)(rlf_clock_ns() - start) * 1e-6;
        }
    }
    rlf_reconstruct_destroy(&stage);
    qsort(times, (size_t)count, sizeof(*times), compare);
    out_ms[0] = count > 0 ? times[count / 2] : 0.0;
    out_ms[1] = count > 0 ? times[count - 1] : 0.0;
    return count == FRAMES;
}

int main(void)
{
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    double wall = 0.0;
    printf("%-28s %10s %10s %10s\n", "surface stage, 512x424", "median ms", "worst ms", "to wall");
    for (int pattern = 0; pattern < HOSTILE_PATTERN_COUNT; pattern++) {
        double ms[2];
        if (!measure(&rig, (hostile_pattern)pattern, ms)) {
            fprintf(stderr, "bench_hostile: out of memory\n");
            return 1;
        }
        wall = pattern == HOSTILE_WALL ? ms[0] : wall;
        printf("%-28s %10.2f %10.2f %10.2f\n", hostile_name((hostile_pattern)pattern), ms[0], ms[1],
               ms[0] / wall);
    }
    return 0;
}
