/* Depth frames that no room shows: what a broken cable, a covered lens or a bad file sends. The
 * surface stage must survive them, say nothing false and cost no more than it may. */
#ifndef RLF_TEST_HOSTILE_H
#define RLF_TEST_HOSTILE_H

#include "analytic.h"

typedef enum hostile_pattern {
    HOSTILE_WALL = 0, /* a still, noisy wall: what the others are compared with */
    HOSTILE_MISSING,  /* nothing at all */
    HOSTILE_ONE_PIXEL,
    HOSTILE_SATURATED,     /* every value 65535 */
    HOSTILE_EXTREMES,      /* 0, 1 or 65535, at random */
    HOSTILE_DROPOUT_1,     /* the wall, 1 % of the pixels missing, at random */
    HOSTILE_DROPOUT_50,    /* half of them */
    HOSTILE_CHECKER_HOLES, /* every other pixel missing */
    HOSTILE_CHECKER_STEPS, /* every other pixel a metre nearer */
    HOSTILE_STRIPES,       /* every other row missing */
    HOSTILE_SNOW,          /* every pixel anywhere from 0.5 to 4.5 m */
    HOSTILE_BLOCKS,        /* squares of 8 pixels anywhere: a thousand objects that never stay */
    HOSTILE_FLICKER,       /* the wall jumps 2 m in each frame */
    HOSTILE_PATTERN_COUNT
} hostile_pattern;

static inline const char *hostile_name(hostile_pattern pattern)
{
    static const char *const names[] = {
        "still wall",       "all missing",     "one pixel valid",     "all 65535",
        "0, 1 or 65535",    "1 % missing",     "50 % missing",        "checkerboard of holes",
        "checkerboard 1 m", "every other row", "any depth per pixel", "any depth per 8x8 pixels",
        "wall jumps 2 m"};
    return names[pattern];
}

static inline double hostile_wall(const rlf_rig *rig, double z, analytic_random *r)
{
    return z + rlf_depth_noise_sigma(&rig->noise, z) * random_normal(r);
}

/* One pixel in metres; 65.535 stands for 65535. */
static inline double hostile_pixel(const rlf_rig *rig, hostile_pattern pattern, int32_t frame,
                                   const int32_t at[2], analytic_random *r)
{
    const double wall = 2.5;
    double u = random_uniform(r);
    bool odd = ((at[0] + at[1]) & 1) != 0;
    switch (pattern) {
    case HOSTILE_MISSING: return 0.0;
    case HOSTILE_ONE_PIXEL:
        return at[0] == rig->depth.width / 2 && at[1] == rig->depth.height / 2 ? 2.0 : 0.0;
    case HOSTILE_SATURATED: return 65.535;
    case HOSTILE_EXTREMES: return u < 0.4 ? 0.0 : (u < 0.7 ? 0.001 : 65.535);
    case HOSTILE_DROPOUT_1: return u < 0.01 ? 0.0 : hostile_wall(rig, wall, r);
    case HOSTILE_DROPOUT_50: return u < 0.5 ? 0.0 : hostile_wall(rig, wall, r);
    case HOSTILE_CHECKER_HOLES: return odd ? 0.0 : hostile_wall(rig, wall, r);
    case HOSTILE_CHECKER_STEPS: return hostile_wall(rig, odd ? wall - 1.0 : wall, r);
    case HOSTILE_STRIPES: return (at[1] & 1) != 0 ? 0.0 : hostile_wall(rig, wall, r);
    case HOSTILE_SNOW: return 0.5 + 4.0 * u;
    case HOSTILE_BLOCKS: {
        analytic_random block = {1u + (uint64_t)frame * 7919u + (uint64_t)(at[1] / 8) * 104729u +
                                 (uint64_t)(at[0] / 8) * 1299709u};
        random_uniform(&block);
        return 0.5 + 4.0 * random_uniform(&block);
    }
    case HOSTILE_FLICKER: return hostile_wall(rig, (frame & 1) != 0 ? 1.0 : 3.0, r);
    default: return hostile_wall(rig, wall, r);
    }
}

/* Millimetres, as most cameras send them. */
static inline void hostile_draw(const rlf_rig *rig, hostile_pattern pattern, int32_t frame,
                                uint16_t *depth)
{
    analytic_random r = {(uint64_t)frame * 1000003u + (uint64_t)pattern + 1u};
    for (int32_t y = 0; y < rig->depth.height; y++) {
        for (int32_t x = 0; x < rig->depth.width; x++) {
            const int32_t at[2] = {x, y};
            double z = hostile_pixel(rig, pattern, frame, at, &r);
            depth[(ptrdiff_t)y * rig->depth.width + x] = (uint16_t)(1000.0 * z + 0.5);
        }
    }
}

static inline rlf_frame hostile_frame(const rlf_rig *rig, const uint16_t *depth, int32_t number)
{
    rlf_frame frame = analytic_frame(rig, NULL, number);
    frame.depth_u16 = depth;
    frame.depth_units_per_metre = 1000.0;
    frame.depth_stride = (ptrdiff_t)sizeof(uint16_t) * rig->depth.width;
    return frame;
}

#endif
