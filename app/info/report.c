/* The text of `relief info`. */
#include "info/info.h"

#include "command.h"

#include <math.h>
#include <stdio.h>

static const char *distortion_name(rlf_distortion_model model)
{
    static const char *const names[] = {"none", "plumb_bob", "rational_polynomial"};
    return names[model];
}

static void print_camera(const char *name, const rlf_camera *c)
{
    printf("%-7s %d x %d  fx %.3f fy %.3f cx %.3f cy %.3f  distortion %s\n", name, (int)c->width,
           (int)c->height, c->fx, c->fy, c->cx, c->cy, distortion_name(c->distortion_model));
}

static void print_calibration(const rlf_source_info *info)
{
    const rlf_rig *rig = &info->rig;
    print_camera("depth", &rig->depth);
    if (rig->has_color) {
        const rlf_vec3 at =
            rlf_rotate(rlf_quat_conjugate(rig->T_color_depth.q), rig->T_color_depth.p);
        print_camera("color", &rig->color);
        printf("        color camera at (%.4f, %.4f, %.4f) m from the depth camera\n",
               command_tidy(-at.x, 4), command_tidy(-at.y, 4), command_tidy(-at.z, 4));
    } else {
        printf("color   none\n");
    }
    printf("range   %.2f to %.2f m\n", rig->depth_min_m, rig->depth_max_m);
    printf("noise   taken to be sigma %.1f mm at 1 m, %.1f mm at 3 m\n",
           1000 * rlf_depth_noise_sigma(&rig->noise, 1),
           1000 * rlf_depth_noise_sigma(&rig->noise, 3));
}

static void print_frames(const rlf_source_info *info, const survey *s)
{
    if (info->frame_count >= 0) {
        printf("frames  %lld", (long long)info->frame_count);
    } else {
        printf("frames  no end");
    }
    printf(info->frames_per_second > 0 ? " at %.2f per second" : "", info->frames_per_second);
    printf(", %lld read, %.2f s", (long long)s->frames, s->duration_s);
    printf(s->with_color < s->frames && info->rig.has_color ? ", %lld with colour" : "",
           (long long)s->with_color);
    printf("\n");
    if (s->interval_s > 0.0) {
        printf("times   median %.1f ms from frame to frame, longest %.1f ms", 1000 * s->interval_s,
               1000 * s->interval_longest_s);
        printf(s->with_color > 0 ? ", colour %.1f ms from depth\n" : "\n", 1000 * s->color_gap_s);
    }
    const rlf_source_status *t = &s->status;
    printf("drops   lost %llu, late %llu, doubled %llu, unpaired %llu, damaged %llu\n",
           (unsigned long long)t->lost, (unsigned long long)t->late, (unsigned long long)t->doubled,
           (unsigned long long)t->unpaired, (unsigned long long)t->damaged);
    if (s->failed > 0) {
        printf("        %lld frames could not be read: %s\n", (long long)s->failed, s->first_error);
    }
    if ((s->flags & (RLF_FRAME_ALIGNED | RLF_FRAME_UNMIRRORED)) != 0 || s->with_confidence > 0) {
        printf("planes %s%s%s\n",
               (s->flags & RLF_FRAME_ALIGNED) != 0 ? " aligned by the device or the file" : "",
               (s->flags & RLF_FRAME_UNMIRRORED) != 0 ? " turned back from mirrored" : "",
               s->with_confidence > 0 ? " with confidence" : "");
    }
    if (s->with_pose > 0) {
        printf("poses   in %lld of %lld frames\n", (long long)s->with_pose, (long long)s->frames);
    } else {
        printf("poses   none\n");
    }
}

static void print_missing(const survey *s)
{
    printf("missing %.2f %% of the pixels", missing_percent_all(&s->missing));
    const char *separator = ":";
    for (int k = 0; k < MISSING_KIND_COUNT; k++) {
        if (s->missing.kinds[k] > 0) {
            printf("%s %s %.2f", separator, missing_name((missing_kind)k),
                   missing_percent(&s->missing, (missing_kind)k));
            separator = ",";
        }
    }
    printf("\n");
}

/* "  5.1", or ">200" where that is all that is known. */
static void write_noise(double noise_m, char out[16])
{
    if (noise_m < STILLNESS_MOST_M) {
        snprintf(out, 16, "%5.1f", 1000 * noise_m);
    } else {
        snprintf(out, 16, " >%.0f", 1000 * STILLNESS_MOST_M);
    }
}

static void print_stillness(const stillness_result *r, const rlf_rig *rig)
{
    if (r->frames < STILLNESS_FRAMES_MIN) {
        printf("still   too few frames to tell the noise over time: %d are needed\n",
               STILLNESS_FRAMES_MIN);
        return;
    }
    printf("still   noise over time of %d frames, %.0f %% of the pixels are still%s\n",
           (int)r->frames, r->still_percent,
           r->still_percent < 50.0 ? ": the camera or the scene moves, so it is a guess" : "");
    for (int32_t b = 0; b < INFO_BINS; b++) {
        const stillness_bin *bin = &r->bins[b];
        if (bin->pixels < 100) {
            continue;
        }
        char end[16], median[16], most[16];
        write_noise(bin->median_m, median);
        write_noise(bin->most_m, most);
        snprintf(end, sizeof(end), b + 1 < INFO_BINS ? "%.1f" : "   ", (b + 1) * INFO_BIN_M);
        printf("        %.1f-%s m  median %s mm, 90 %% below %s mm, taken to be %5.1f mm\n",
               b * INFO_BIN_M, end, median, most,
               1000 * rlf_depth_noise_sigma(&rig->noise, (b + 0.5) * INFO_BIN_M));
    }
}

bool report_says_aligned(const rlf_source_info *info, const survey *s)
{
    const rlf_pose *T = &info->rig.T_color_depth;
    const bool is_identity =
        T->p.x == 0.0 && T->p.y == 0.0 && T->p.z == 0.0 && fabs(T->q.w) > 1.0 - 1e-12;
    return is_identity || (s->flags & RLF_FRAME_ALIGNED) != 0;
}

static void print_direction(const color_fit_result *r)
{
    printf("%.1f %s, %.1f %s", fabs(r->x), r->x >= 0 ? "right" : "left", fabs(r->y),
           r->y >= 0 ? "down" : "up");
}

static void print_fit(const rlf_source_info *info, const survey *s)
{
    const color_fit_result *r = &s->fit;
    if (!s->has_fit) {
        return;
    }
    const double error = color_fit_error(r);
    if (!r->is_known) {
        printf("fit     colour on depth cannot be told: %lld edge points, whose offsets differ by "
               "+- %.1f px\n",
               (long long)r->edges, error);
        return;
    }
    if (color_fit_is_off(r)) {
        printf("fit     colour is %.1f px off%s (", color_fit_length(r),
               r->is_far_only ? " where things are far" : "");
        print_direction(r);
        printf(", +- %.1f)%s\n", error,
               report_says_aligned(info, s)
                   ? ": it is not aligned with depth though the source says so"
                   : ": check the transform and the colour camera of the calibration");
    } else {
        printf("fit     colour fits depth to %.1f px%s (", color_fit_length(r),
               r->is_far_only ? " where things are far" : "");
        print_direction(r);
        printf(", +- %.1f)\n", error);
    }
    printf("        %lld edge points of %d frames; depth's are %.1f px %s than colour's\n",
           (long long)r->edges, (int)r->frames, fabs(r->widening),
           r->widening >= 0.0 ? "wider" : "narrower");
    if (color_fit_is_parallax_wrong(r)) {
        printf("        near things are off by (%.1f, %.1f), far ones by (%.1f, %.1f) px: the "
               "transform from depth to colour is wrong or missing\n",
               r->near_x, r->near_y, r->far_x, r->far_y);
    }
}

void report_print(const rlf_source_info *info, const survey *s)
{
    printf("source  %s\n", info->name);
    printf("device  %s%s\n", info->device[0] != '\0' ? info->device : "not told",
           info->is_live ? ", live" : "");
    print_calibration(info);
    print_frames(info, s);
    print_missing(s);
    print_stillness(&s->stillness, &info->rig);
    print_fit(info, s);
}
