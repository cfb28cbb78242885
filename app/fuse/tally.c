/* Counts, and the words for what went wrong. */
#include "fuse/tally.h"

/* Voxels with less weight are noise: 32 is two near frames, or as many far ones. A short clip
 * cannot have so much of what is far away: there a quarter of its frames must have seen it. */
#define MIN_WEIGHT_MOST 32
#define MIN_WEIGHT_SHARE 4

static void count_pixels(fuse_tally *t, const rlf_surface *s)
{
    for (int32_t i = 0; i < s->width * s->height; i++) {
        t->near_pixels += s->reason[i] == RLF_REASON_TOO_NEAR;
        t->far_pixels += s->reason[i] == RLF_REASON_TOO_FAR;
        t->lost_pixels += s->reason[i] != RLF_REASON_TOO_NEAR && s->reason[i] != RLF_REASON_TOO_FAR;
    }
    t->whole_pixels += s->valid_count;
}

void fuse_tally_add(fuse_tally *t, const fuser *f)
{
    t->surface_ms += f->surface_ms + f->color_ms;
    t->map_ms += f->integrate_ms;
    t->track_ms += f->pose.predict_ms + f->pose.align_ms;
    t->without_depth += f->surface->valid_count == 0;
    if (t->whole_pixels == 0) {
        count_pixels(t, f->surface);
    }
}

static double percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * (double)part / (double)whole : 0.0;
}

/* No pixel of any frame had depth. */
static rlf_result fail_depth(const fuse_tally *t, const rlf_rig *rig)
{
    const int64_t all = t->near_pixels + t->far_pixels + t->lost_pixels;
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: no depth from %g to %g m in %lld frames: %.0f %% of the pixels are "
                    "nearer, %.0f %% farther, %.0f %% have none; are units_per_metre, depth_min_m "
                    "and depth_max_m of the camera right?",
                    t->source, rig->depth_min_m, rig->depth_max_m, (long long)t->seen,
                    percent(t->near_pixels, all), percent(t->far_pixels, all),
                    percent(t->lost_pixels, all));
}

rlf_result fuse_tally_check(const fuse_tally *t, const fuser *f)
{
    if (t->seen == 0) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", t->source);
    }
    if (t->without_pose == t->seen && !t->is_tracked) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: none of %lld frames has a pose that can be used; --poses source needs "
                        "a groundtruth.txt, or leave it out",
                        t->source, (long long)t->seen);
    }
    if (t->whole_pixels == 0) {
        return fail_depth(t, f->rig);
    }
    if (t->fused == 0) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: the camera's place was found in none of %lld frames: too few pixels "
                        "have depth",
                        t->source, (long long)t->seen);
    }
    if (rlf_map_get_status(f->map).block_count == 0) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: no surface in %lld frames: the depth is too sparse, or seen too "
                        "aslant",
                        t->source, (long long)t->fused);
    }
    return RLF_OK;
}

int32_t fuse_tally_min_weight(const fuse_tally *t)
{
    const int64_t share = t->fused / MIN_WEIGHT_SHARE;
    return share > MIN_WEIGHT_MOST ? MIN_WEIGHT_MOST : (share > 1 ? (int32_t)share : 1);
}

/* The greatest weight that leaves a triangle; 0 = none does. */
static int32_t most_weight(const rlf_map *map, int32_t below)
{
    int32_t low = 0, high = below;
    while (high - low > 1) {
        const int32_t middle = (low + high) / 2;
        rlf_map_mesh mesh;
        const bool is_made = rlf_map_mesh_create(map, middle, &mesh) == RLF_OK;
        const bool has_some = is_made && mesh.triangle_count > 0;
        low = has_some ? middle : low;
        high = has_some ? high : middle;
        if (is_made) {
            rlf_map_mesh_destroy(&mesh);
        }
    }
    return low;
}

rlf_result fuse_tally_check_mesh(const fuse_tally *t, const fuser *f, int32_t min_weight,
                                 const rlf_map_mesh *mesh)
{
    if (mesh->triangle_count > 0) {
        return RLF_OK;
    }
    const int32_t most = most_weight(f->map, min_weight);
    return most > 0 ? rlf_fail(RLF_ERROR_INVALID,
                               "%s: nothing in %lld frames was seen often enough for --min-weight "
                               "%d: with %d or less there is a mesh",
                               t->source, (long long)t->fused, (int)min_weight, (int)most)
                    : rlf_fail(RLF_ERROR_INVALID,
                               "%s: no mesh in %lld frames: what has depth is smaller than the "
                               "voxels of %g mm (--voxel)",
                               t->source, (long long)t->fused,
                               1000.0 * rlf_map_get_status(f->map).voxel_m);
}
