/* `relief info SOURCE`. */
#include "command.h"
#include "relief/io.h"

#include <getopt.h>
#include <stdio.h>

static const char *distortion_name(rlf_distortion_model model)
{
    static const char *const names[] = {"none", "plumb_bob", "rational_polynomial"};
    return names[model];
}

static void print_camera(const char *name, const rlf_camera *c)
{
    printf("%-6s %d x %d  fx %.3f fy %.3f cx %.3f cy %.3f  distortion %s\n", name, (int)c->width,
           (int)c->height, c->fx, c->fy, c->cx, c->cy, distortion_name(c->distortion_model));
}

static void print_info(const rlf_source_info *info)
{
    const rlf_rig *rig = &info->rig;
    printf("source %s\n", info->name);
    print_camera("depth", &rig->depth);
    if (rig->has_color) {
        print_camera("color", &rig->color);
        printf("       color camera at (%.4f, %.4f, %.4f) m from the depth camera\n",
               -rlf_rotate(rlf_quat_conjugate(rig->T_color_depth.q), rig->T_color_depth.p).x,
               -rlf_rotate(rlf_quat_conjugate(rig->T_color_depth.q), rig->T_color_depth.p).y,
               -rlf_rotate(rlf_quat_conjugate(rig->T_color_depth.q), rig->T_color_depth.p).z);
    } else {
        printf("color  none\n");
    }
    printf("range  %.2f to %.2f m\n", rig->depth_min_m, rig->depth_max_m);
    printf("noise  sigma %.1f mm at 1 m, %.1f mm at 3 m\n",
           1000 * rlf_depth_noise_sigma(&rig->noise, 1),
           1000 * rlf_depth_noise_sigma(&rig->noise, 3));
    if (info->frame_count >= 0) {
        printf("frames %lld", (long long)info->frame_count);
    } else {
        printf("frames unknown");
    }
    printf(info->frames_per_second > 0 ? " at %.2f per second\n" : "\n", info->frames_per_second);
}

int info_main(int argc, char **argv)
{
    static const struct option options[] = {{"help", no_argument, NULL, 'h'}, {0}};
    int option;
    while ((option = getopt_long(argc, argv, "h", options, NULL)) != -1) {
        if (option != 'h') {
            return EXIT_USAGE;
        }
        printf("usage: relief info SOURCE\n\n"
               "Tells what a source is: cameras, range, noise, number of frames.\n\n"
               "examples:\n  relief info synthetic:room\n  relief info path/to/clip\n");
        return EXIT_DONE;
    }
    if (argc - optind != 1) {
        return command_usage("info", "needs one SOURCE");
    }
    rlf_source *source = NULL;
    if (rlf_open_source(argv[optind], NULL, &source) != RLF_OK) {
        return command_failed();
    }
    print_info(rlf_source_get_info(source));
    rlf_source_destroy(&source);
    return EXIT_DONE;
}
