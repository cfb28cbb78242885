/* Lines for the user. */
#define _POSIX_C_SOURCE 200809L
#include "fuse/report.h"

#include "command.h"

#include <stdio.h>
#include <unistd.h>

#define TERMINAL_NS INT64_C(500000000)
#define FILE_NS INT64_C(10000000000)

void fuse_progress_show(fuse_progress *p, const fuse_tally *t, const fuser *f, int64_t frame_count)
{
    const bool is_terminal = isatty(STDERR_FILENO) != 0;
    const int64_t now = rlf_clock_ns();
    if (p->last_ns == 0 && !is_terminal) {
        p->last_ns = now; /* a short fusion in a log tells nothing but its end */
    }
    if (p->last_ns != 0 && now - p->last_ns < (is_terminal ? TERMINAL_NS : FILE_NS)) {
        return;
    }
    p->last_ns = now;
    p->is_shown = is_terminal;
    const double mb = (double)rlf_map_get_status(f->map).bytes * 1e-6;
    char of[32] = "";
    if (frame_count >= 0) {
        (void)snprintf(of, sizeof(of), " of %lld", (long long)frame_count);
    }
    fprintf(stderr, "%sfusing: frame %lld%s, map %.0f MB%s", is_terminal ? "\r" : "",
            (long long)t->seen, of, mb, is_terminal ? " " : "\n");
}

void fuse_progress_end(fuse_progress *p)
{
    if (p->is_shown) {
        fprintf(stderr, "\n");
    }
    p->is_shown = false;
}

static void print_times(const fuse_tally *t)
{
    const double per_frame = 1.0 / (double)t->seen;
    const double all = t->source_ms + t->surface_ms + t->track_ms + t->map_ms;
    printf("a frame: %.1f ms: source %.1f, surface %.1f, tracking %.1f, map %.1f\n",
           all * per_frame, t->source_ms * per_frame, t->surface_ms * per_frame,
           t->track_ms * per_frame, t->map_ms * per_frame);
}

void fuse_report_print(const fuse_tally *t, const fuser *f, const trajectory *way)
{
    const rlf_map_status s = rlf_map_get_status(f->map);
    const int64_t lost = t->is_tracked ? f->pose.lost_count - t->without_depth : 0;
    const double error = t->is_tracked && t->without_pose == 0 ? trajectory_error(way) : -1.0;
    printf("%lld of %lld %s fused", (long long)t->fused, (long long)t->seen,
           command_frames(t->seen));
    if (t->without_depth > 0) {
        printf("; %lld without depth", (long long)t->without_depth);
    }
    if (lost > 0) {
        printf("; the camera was lost in %lld: move it more slowly, and show it what it saw before",
               (long long)lost);
    }
    if (!t->is_tracked && t->without_pose > 0) {
        printf("; %lld without a pose that can be used", (long long)t->without_pose);
    }
    printf("\nmap: %d blocks of %g mm voxels, %.0f MB%s\n", (int)s.block_count, 1000.0 * s.voxel_m,
           (double)s.bytes * 1e-6,
           s.is_full ? "; it is full, and what is far was forgotten: use a larger --memory or "
                       "--voxel"
                     : "");
    print_times(t);
    if (error >= 0.0) {
        printf("trajectory: %.1f mm RMS from the source's own\n", 1000.0 * error);
    }
}

void fuse_report_mesh(const rlf_map_mesh *mesh, int32_t min_weight, const char *path)
{
    printf("%zu vertices, %zu triangles in %s (--min-weight %d)\n", mesh->vertex_count,
           mesh->triangle_count, path, (int)min_weight);
}
