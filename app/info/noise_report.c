/* `relief info SOURCE --noise`: reads the frames, prints the table, writes the JSON. */
#include "command.h"
#include "json_file.h"
#include "info/info.h"

#include <stdio.h>

static rlf_result read_frames(rlf_source *source, int64_t frames, info_noise *out)
{
    rlf_result result = RLF_OK;
    for (int64_t i = 0; i < frames && !command_interrupted;) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            info_noise_add(out, &frame);
            i++;
        } else if (result != RLF_NO_FRAME) {
            break;
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

static double middle_of(int32_t bin)
{
    return (bin + 0.5) * INFO_NOISE_BIN_M;
}

static bool is_empty(const info_noise *noise, int32_t bin)
{
    bool empty = true;
    for (int k = 0; k < NOISE_KIND_COUNT; k++) {
        empty = empty && info_noise_sigma(noise, (noise_kind)k, bin) < 0.0;
    }
    return empty;
}

static void print_table(const char *name, const rlf_rig *rig, const info_noise *noise)
{
    printf("%s: %lld %s, %.2f %% of the pixels missing\n", name,
           (long long)info_noise_frames(noise), command_frames(info_noise_frames(noise)),
           info_noise_missing(noise));
    printf(
        "standard deviation of depth in mm, along rows at steps of 1, 2, 4 pixels and from frame "
        "to frame\n%10s %8s %8s %8s %8s %8s %8s\n",
        "metres", "pixels %", "step 1", "step 2", "step 4", "in time", "assumed");
    for (int32_t b = 0; b < INFO_NOISE_BINS; b++) {
        if (is_empty(noise, b)) {
            continue;
        }
        printf("%4.1f - %3.1f %8.2f", b * INFO_NOISE_BIN_M, (b + 1) * INFO_NOISE_BIN_M,
               info_noise_share(noise, b));
        for (int k = 0; k < NOISE_KIND_COUNT; k++) {
            double sigma = info_noise_sigma(noise, (noise_kind)k, b);
            if (sigma < 0.0) {
                printf(" %8s", "-");
            } else {
                printf(" %8.2f", 1000.0 * sigma);
            }
        }
        printf(" %8.2f\n", 1000.0 * rlf_depth_noise_sigma(&rig->noise, middle_of(b)));
    }
}

static json_t *sigma_json(const info_noise *noise, noise_kind kind, int32_t bin)
{
    double sigma = info_noise_sigma(noise, kind, bin);
    return sigma < 0.0 ? json_null() : json_real(1000.0 * sigma);
}

static rlf_result write_json(const char *path, const rlf_rig *rig, const char *name,
                             const info_noise *noise)
{
    json_t *rows = json_array();
    for (int32_t b = 0; b < INFO_NOISE_BINS; b++) {
        if (!is_empty(noise, b)) {
            json_array_append_new(
                rows, json_pack("{s:f, s:f, s:o, s:o, s:o, s:o, s:f}", "distance_m", middle_of(b),
                                "pixels_percent", info_noise_share(noise, b), "step_1_mm",
                                sigma_json(noise, NOISE_STEP_1, b), "step_2_mm",
                                sigma_json(noise, NOISE_STEP_2, b), "step_4_mm",
                                sigma_json(noise, NOISE_STEP_4, b), "temporal_mm",
                                sigma_json(noise, NOISE_TEMPORAL, b), "assumed_mm",
                                1000.0 * rlf_depth_noise_sigma(&rig->noise, middle_of(b))));
        }
    }
    json_t *root = json_pack("{s:o, s:s, s:I, s:f, s:o}", "machine", machine_json(), "source", name,
                             "frames", (json_int_t)info_noise_frames(noise), "missing_percent",
                             info_noise_missing(noise), "noise", rows);
    return json_file_write(path, root);
}

rlf_result info_noise_run(rlf_source *source, const char *name, int64_t frames,
                          const char *json_path)
{
    const rlf_rig *rig = &rlf_source_get_info(source)->rig;
    info_noise *noise = info_noise_create(rig);
    rlf_result result = noise == NULL ? RLF_ERROR_MEMORY : read_frames(source, frames, noise);
    if (result == RLF_OK && info_noise_frames(noise) == 0) {
        result = command_interrupted ? RLF_NO_FRAME
                                     : rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", name);
    }
    if (result == RLF_OK) {
        print_table(name, rig, noise);
        result = json_path != NULL ? write_json(json_path, rig, name, noise) : RLF_OK;
    }
    info_noise_destroy(&noise);
    return result;
}
