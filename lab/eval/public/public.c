/* Rendered depth with true normals, as published with 3F2N (Fan et al. 2021) and D2NT (Feng et al.
 * 2023): a folder per frame with
 *   depth.bin   float32, little endian, 640 x 480, any unit; exactly 1 = nothing there
 *   normal.png  16-bit colour, n = 1 - 2 png / 65535
 *   params.txt  fx fy u0 v0 [scale], pixels counted from 1
 * The error is acos |n.n_gt|, as there: 0 to 90 degrees. */
#define _POSIX_C_SOURCE 200809L
#include "eval/measures/angles.h"
#include "eval/public/frame.h"
#include "eval/public/still.h"
#include "eval/sections.h"
#include "eval/table.h"
#include "relief/io.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define NOTHING 1.0f
#define PATH_SIZE 1024

static void free_frame(public_frame *f)
{
    rlf_free(f->depth);
    rlf_free(f->ray_x);
    rlf_free(f->ray_y);
    for (int k = 0; k < 3; k++) {
        rlf_free(f->found[k]);
    }
    rlf_free(f->truth);
    memset(f, 0, sizeof(*f));
}

static rlf_result read_depth(const char *path, float *out)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read; check the folder", path);
    }
    size_t got = fread(out, sizeof(float), PUBLIC_COUNT, file);
    bool is_longer = fgetc(file) != EOF;
    fclose(file);
    if (got != PUBLIC_COUNT || is_longer) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is not %d x %d float32 (%d bytes)", path,
                        PUBLIC_WIDTH, PUBLIC_HEIGHT, PUBLIC_COUNT * 4);
    }
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        bool is_nothing = !(out[i] < NOTHING) && !(out[i] > NOTHING);
        out[i] = is_nothing ? 0.0f : out[i];
    }
    return RLF_OK;
}

static rlf_result read_rays(const char *path, public_frame *f)
{
    double fx, fy, u0, v0;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return rlf_fail(RLF_ERROR_IO, "%s: cannot be read; check the folder", path);
    }
    int count = fscanf(file, "%lf %lf %lf %lf", &fx, &fy, &u0, &v0);
    fclose(file);
    if (count != 4 || !(fx > 0.0) || !(fy > 0.0)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: must hold the numbers fx fy u0 v0", path);
    }
    f->camera = (rlf_camera){.width = PUBLIC_WIDTH,
                             .height = PUBLIC_HEIGHT,
                             .fx = fx,
                             .fy = fy,
                             .cx = u0 - 1.0,
                             .cy = v0 - 1.0};
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        f->ray_x[i] = (float)((i % PUBLIC_WIDTH - (u0 - 1.0)) / fx);
        f->ray_y[i] = (float)((i / PUBLIC_WIDTH - (v0 - 1.0)) / fy);
    }
    return RLF_OK;
}

static rlf_result read_truth(const char *path, uint16_t **out)
{
    int32_t width, height;
    rlf_result result = rlf_png_read_rgb_u16(path, out, &width, &height);
    if (result == RLF_OK && (width != PUBLIC_WIDTH || height != PUBLIC_HEIGHT)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is %d x %d, not %d x %d", path, (int)width,
                        (int)height, PUBLIC_WIDTH, PUBLIC_HEIGHT);
    }
    return result;
}

static bool join(char path[PATH_SIZE], const char *folder, const char *name)
{
    int length = snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    return length > 0 && length < PATH_SIZE;
}

static rlf_result read_frame(const char *folder, public_frame *f)
{
    char path[PATH_SIZE];
    memset(f, 0, sizeof(*f));
    float **const planes[6] = {&f->depth,    &f->ray_x,    &f->ray_y,
                               &f->found[0], &f->found[1], &f->found[2]};
    for (int k = 0; k < 6; k++) {
        *planes[k] = rlf_alloc_array(PUBLIC_COUNT, sizeof(float));
        if (*planes[k] == NULL) {
            return RLF_ERROR_MEMORY;
        }
    }
    rlf_result result = join(path, folder, "depth.bin")
                            ? read_depth(path, f->depth)
                            : rlf_fail(RLF_ERROR_IO, "%s: the name is too long", folder);
    if (result == RLF_OK && join(path, folder, "params.txt")) {
        result = read_rays(path, f);
    }
    if (result == RLF_OK && join(path, folder, "normal.png")) {
        result = read_truth(path, &f->truth);
    }
    return result;
}

static void measure(public_frame *f, rlf_profile profile, eval_angles *angles)
{
    rlf_normal_method method =
        profile == RLF_PROFILE_LIVE ? RLF_NORMALS_INVERSE_DEPTH : RLF_NORMALS_THESIS;
    rlf_compute_normals(method, true, PUBLIC_WIDTH, PUBLIC_HEIGHT, f->ray_x, f->ray_y, f->depth,
                        NULL, f->found[0], f->found[1], f->found[2]);
    for (int32_t i = 0; i < PUBLIC_COUNT; i++) {
        if (!(f->depth[i] > 0.0f)) {
            continue;
        }
        rlf_vec3 found = {f->found[0][i], f->found[1][i], f->found[2][i]};
        if (!(rlf_length(found) > 0.5)) {
            angles->missing++;
            continue;
        }
        eval_add_angle(angles, public_error_deg(f, i, found));
    }
}

static rlf_result run_frame(eval_table *table, const char *folder, const char *name,
                            int profile_mask)
{
    public_frame frame;
    eval_angles *angles = rlf_alloc(sizeof(*angles));
    rlf_result result = read_frame(folder, &frame);
    result = angles != NULL ? result : RLF_ERROR_MEMORY;
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_OK; profile++) {
        if (!(profile_mask & (1 << profile))) {
            continue;
        }
        rlf_profile p = (rlf_profile)profile;
        memset(angles, 0, sizeof(*angles));
        measure(&frame, p, angles);
        eval_table_add(table, name, "normals_mean_deg", "clean depth: normals, mean, deg", p,
                       eval_mean_deg(angles));
        eval_table_add(table, name, "normals_median_deg", "clean depth: normals, median, deg", p,
                       eval_median_deg(angles));
        eval_table_add(table, name, "normals_over_30_percent",
                       "clean depth: normals > 30 deg off, %", p, eval_wrong_percent(angles));
        eval_table_add(table, name, "normals_missing_percent", "clean depth: normals missing, %", p,
                       eval_missing_percent(angles));
    }
    rlf_free(angles);
    if (result == RLF_OK) {
        result = public_still_run(table, &frame, name, profile_mask);
    }
    free_frame(&frame);
    return result;
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

rlf_result eval_public_run(eval_table *table, const char *folder, int profile_mask)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, is_visible, alphasort);
    if (count < 0) {
        return rlf_fail(RLF_ERROR_IO, "%s: is not a folder that can be read", folder);
    }
    rlf_result result = RLF_OK;
    int frames = 0;
    for (int i = 0; i < count; i++) {
        char path[PATH_SIZE];
        struct stat status;
        bool is_folder = join(path, folder, entries[i]->d_name) && stat(path, &status) == 0 &&
                         S_ISDIR(status.st_mode);
        if (result == RLF_OK && is_folder) {
            result = run_frame(table, path, entries[i]->d_name, profile_mask);
            frames++;
        }
        free(entries[i]);
    }
    free(entries);
    return result == RLF_OK && frames == 0
               ? rlf_fail(RLF_ERROR_IO,
                          "%s: holds no folders with depth.bin, normal.png and "
                          "params.txt",
                          folder)
               : result;
}
