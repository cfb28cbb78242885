/* `relief-lab measure SOURCE --noise`: reads the frames, prints the table, writes the JSON. */
#include "command.h"
#include "json_file.h"
#include "machine.h"
#include "measure/noise.h"

#include <stdio.h>

static rlf_result read_frames(rlf_source *source, int64_t frames, measure_noise *out)
{
    rlf_result result = RLF_OK;
    for (int64_t i = 0; (frames < 0 || i < frames) && !command_interrupted;) {
        rlf_frame frame;
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            measure_noise_add(out, &frame);
            i++;
        } else if (result != RLF_NO_FRAME) {
            break;
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

static double middle_of(int32_t bin)
{
    return (bin + 0.5) * MEASURE_NOISE_BIN_M;
}

static bool is_empty(const measure_noise *noise, int32_t bin)
{
    bool empty = true;
    for (int k = 0; k < NOISE_KIND_COUNT; k++) {
        empty = empty && measure_noise_sigma(noise, (noise_kind)k, bin) < 0.0;
    }
    return empty;
}

static void print_table(const char *name, const rlf_rig *rig, const measure_noise *noise)
{
    printf("%s: %lld %s, %.2f %% of the pixels missing\n", name,
           (long long)measure_noise_frames(noise), command_frames(measure_noise_frames(noise)),
           measure_noise_missing(noise));
    printf(
        "standard deviation of depth in mm, along rows at steps of 1, 2, 4 pixels and from frame "
        "to frame\n%10s %8s %8s %8s %8s %8s %8s\n",
        "metres", "pixels %", "step 1", "step 2", "step 4", "in time", "assumed");
    for (int32_t b = 0; b < MEASURE_NOISE_BINS; b++) {
        if (is_empty(noise, b)) {
            continue;
        }
        printf("%4.1f - %3.1f %8.2f", b * MEASURE_NOISE_BIN_M, (b + 1) * MEASURE_NOISE_BIN_M,
               measure_noise_share(noise, b));
        for (int k = 0; k < NOISE_KIND_COUNT; k++) {
            double sigma = measure_noise_sigma(noise, (noise_kind)k, b);
            if (sigma < 0.0) {
                printf(" %8s", "-");
            } else {
                printf(" %8.2f", 1000.0 * sigma);
            }
        }
        printf(" %8.2f\n", 1000.0 * rlf_depth_noise_sigma(&rig->noise, middle_of(b)));
    }
}

static json_t *sigma_json(const measure_noise *noise, noise_kind kind, int32_t bin)
{
    double sigma = measure_noise_sigma(noise, kind, bin);
    return sigma < 0.0 ? json_null() : json_real(1000.0 * sigma);
}

static rlf_result write_json(const char *path, const rlf_rig *rig, const char *name,
                             const measure_noise *noise)
{
    json_t *rows = json_array();
    for (int32_t b = 0; b < MEASURE_NOISE_BINS; b++) {
        if (!is_empty(noise, b)) {
            json_array_append_new(
                rows, json_pack("{s:f, s:f, s:o, s:o, s:o, s:o, s:f}", "distance_m", middle_of(b),
                                "pixels_percent", measure_noise_share(noise, b), "step_1_mm",
                                sigma_json(noise, NOISE_STEP_1, b), "step_2_mm",
                                sigma_json(noise, NOISE_STEP_2, b), "step_4_mm",
                                sigma_json(noise, NOISE_STEP_4, b), "temporal_mm",
                                sigma_json(noise, NOISE_TEMPORAL, b), "assumed_mm",
                                1000.0 * rlf_depth_noise_sigma(&rig->noise, middle_of(b))));
        }
    }
    json_t *root = json_pack("{s:o, s:s, s:I, s:f, s:o}", "machine", machine_json(), "source", name,
                             "frames", (json_int_t)measure_noise_frames(noise), "missing_percent",
                             measure_noise_missing(noise), "noise", rows);
    return json_file_write(path, root);
}

rlf_result measure_noise_run(const char *source_name, int64_t frames, const char *json_path)
{
    rlf_source *source = NULL;
    rlf_result result = rlf_open_source(source_name, NULL, &source);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_source_info *info = rlf_source_get_info(source);
    if (info->frame_count < 0 && frames < 0) {
        rlf_source_destroy(&source);
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no end; add --frames N", source_name);
    }
    measure_noise *noise = measure_noise_create(&info->rig);
    result = noise == NULL ? RLF_ERROR_MEMORY : read_frames(source, frames, noise);
    if (result == RLF_OK && measure_noise_frames(noise) == 0 && !command_interrupted) {
        result = rlf_fail(RLF_ERROR_INVALID, "%s: has no frames", source_name);
    }
    bool is_whole = result == RLF_OK && !command_interrupted;
    if (is_whole) {
        print_table(source_name, &info->rig, noise);
    }
    if (is_whole && json_path != NULL) {
        result = write_json(json_path, &info->rig, source_name, noise);
    }
    measure_noise_destroy(&noise);
    rlf_source_destroy(&source);
    return result;
}
