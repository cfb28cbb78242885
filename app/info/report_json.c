/* `relief info --json`. */
#include "info/info.h"

#include "json_file.h"

static json_t *camera_json(const rlf_camera *c)
{
    static const char *const models[] = {"none", "plumb_bob", "rational_polynomial"};
    json_t *distortion = json_array();
    for (int i = 0; i < 8; i++) {
        json_array_append_new(distortion, json_file_number(c->distortion[i]));
    }
    return json_pack("{s:i, s:i, s:f, s:f, s:f, s:f, s:s, s:o}", "width", (int)c->width, "height",
                     (int)c->height, "fx", c->fx, "fy", c->fy, "cx", c->cx, "cy", c->cy,
                     "distortion_model", models[c->distortion_model], "distortion", distortion);
}

static json_t *drops_json(const survey *s)
{
    const rlf_source_status *t = &s->status;
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I}", "lost", (json_int_t)t->lost, "late",
                     (json_int_t)t->late, "doubled", (json_int_t)t->doubled, "unpaired",
                     (json_int_t)t->unpaired, "damaged", (json_int_t)t->damaged, "failed",
                     (json_int_t)s->failed);
}

static json_t *missing_json(const missing_counts *m)
{
    json_t *kinds = json_object();
    for (int k = 0; k < MISSING_KIND_COUNT; k++) {
        json_object_set_new(kinds, missing_name((missing_kind)k),
                            json_real(missing_percent(m, (missing_kind)k)));
    }
    return json_pack("{s:f, s:o}", "percent", missing_percent_all(m), "kinds", kinds);
}

static json_t *stillness_json(const stillness_result *r)
{
    json_t *bins = json_array();
    for (int32_t b = 0; b < INFO_BINS; b++) {
        const stillness_bin *bin = &r->bins[b];
        if (bin->pixels > 0) {
            json_array_append_new(bins, json_pack("{s:f, s:I, s:f, s:f}", "from_m", b * INFO_BIN_M,
                                                  "pixels", (json_int_t)bin->pixels, "median_m",
                                                  bin->median_m, "percent_90_m", bin->most_m));
        }
    }
    return json_pack("{s:i, s:f, s:o}", "frames", (int)r->frames, "still_percent", r->still_percent,
                     "bins", bins);
}

static json_t *fit_json(const rlf_source_info *info, const survey *s)
{
    const color_fit_result *r = &s->fit;
    if (!s->has_fit) {
        return json_null();
    }
    return json_pack("{s:b, s:b, s:b, s:I, s:f, s:f, s:f, s:f, s:f, s:o, s:o, s:o, s:o}",
                     "is_known", r->is_known, "is_off", color_fit_is_off(r), "says_aligned",
                     report_says_aligned(info, s), "edges", (json_int_t)r->edges, "x", r->x, "y",
                     r->y, "error_x", r->error_x, "error_y", r->error_y, "widening", r->widening,
                     "near_x", json_file_number(r->near_x), "near_y", json_file_number(r->near_y),
                     "far_x", json_file_number(r->far_x), "far_y", json_file_number(r->far_y));
}

rlf_result report_write_json(const rlf_source_info *info, const survey *s, const char *path)
{
    const rlf_rig *rig = &info->rig;
    json_t *root = json_pack(
        "{s:s, s:s, s:b, s:o, s:o, s:f, s:f, s:I, s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:b, s:b, "
        "s:o, "
        "s:o, s:o, s:o}",
        "source", info->name, "device", info->device, "is_live", info->is_live, "depth",
        camera_json(&rig->depth), "color", rig->has_color ? camera_json(&rig->color) : json_null(),
        "depth_min_m", rig->depth_min_m, "depth_max_m", rig->depth_max_m, "frame_count",
        (json_int_t)info->frame_count, "frames", (json_int_t)s->frames, "frames_per_second",
        info->frames_per_second, "duration_s", s->duration_s, "interval_s", s->interval_s,
        "interval_longest_s", s->interval_longest_s, "with_color", (json_int_t)s->with_color,
        "with_pose", (json_int_t)s->with_pose, "is_aligned", (s->flags & RLF_FRAME_ALIGNED) != 0,
        "is_unmirrored", (s->flags & RLF_FRAME_UNMIRRORED) != 0, "drops", drops_json(s), "missing",
        missing_json(&s->missing), "stillness", stillness_json(&s->stillness), "fit",
        fit_json(info, s));
    return json_file_write(path, root);
}
