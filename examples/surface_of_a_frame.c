/* Bring your own depth camera: a custom source gives depth images, Relief gives the surface.
 *
 * The "camera" here makes up a wall 2 m away, turned by 30 degrees about the vertical axis, with a
 * hole in it. A real one would fill `depth` from its driver. */
#include "relief/reconstruct.h"
#include "relief/source.h"

#include <stdio.h>

#define WIDTH 320
#define HEIGHT 240

typedef struct my_camera {
    uint16_t depth[WIDTH * HEIGHT]; /* tenths of a millimetre, 0 = missing */
    uint64_t frames;
} my_camera;

static const double sin_30 = 0.5, cos_30 = 0.86602540378443865;

static rlf_result my_next(void *self, rlf_frame *out_frame)
{
    my_camera *camera = self;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            /* The wall is n.p = -2 cos 30 with n = (-sin 30, 0, -cos 30): solve for z. */
            double ray_x = (x - 159.5) / 280.0;
            double z = 2.0 * cos_30 / (cos_30 + sin_30 * ray_x);
            bool is_hole = x >= 40 && x < 60 && y >= 40 && y < 60;
            camera->depth[y * WIDTH + x] = (uint16_t)(is_hole ? 0.0 : z * 10000.0 + 0.5);
        }
    }
    out_frame->sequence = camera->frames;
    out_frame->time_ns = (int64_t)camera->frames * 33333333;
    out_frame->depth_u16 = camera->depth;
    out_frame->depth_stride = WIDTH * (ptrdiff_t)sizeof(uint16_t);
    out_frame->depth_units_per_metre = 10000.0;
    camera->frames++;
    return RLF_OK;
}

static rlf_source_info describe(void)
{
    rlf_source_info info = {.name = "my camera", .frame_count = -1, .frames_per_second = 30};
    info.rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = 280.0, .fy = 280.0, .cx = 159.5, .cy = 119.5};
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 5.0;
    info.rig.noise.c0 = 0.001; /* 1 mm everywhere */
    return info;
}

/* Looks at the surface; true when it is the wall that was put in. */
static bool inspect(const rlf_surface *surface)
{
    int32_t missing = 0;
    for (int32_t i = 0; i < surface->width * surface->height; i++) {
        missing += surface->depth[i] == 0.0f;
    }
    int32_t i = HEIGHT / 2 * WIDTH + WIDTH / 2;
    rlf_vec3 p = rlf_surface_point(surface, i);
    rlf_vec3 n = rlf_vec3_make(surface->normal_x[i], surface->normal_y[i], surface->normal_z[i]);
    printf("%d x %d pixels, %d without depth\n", surface->width, surface->height, missing);
    printf("middle pixel: point (%.3f, %.3f, %.3f) m, normal (%.3f, %.3f, %.3f)\n", p.x, p.y, p.z,
           n.x, n.y, n.z);
    double cosine = rlf_dot(n, rlf_vec3_make(-sin_30, 0, -cos_30));
    printf("angle to the true normal: %.2f degrees\n",
           rlf_acos(rlf_clamp(cosine, -1, 1)) * 180.0 / RLF_PI);
    return cosine > 0.999 && p.z > 1.99 && p.z < 2.01;
}

int main(void)
{
    static my_camera camera;
    const rlf_source_methods methods = {.next = my_next};
    rlf_source_info info = describe();
    rlf_source *source = NULL;
    rlf_reconstruct *stage = NULL;
    rlf_frame frame;
    const rlf_surface *surface = NULL;

    rlf_result result = rlf_source_create_custom(&methods, &info, &camera, &source);
    if (result == RLF_OK) {
        rlf_reconstruct_def def =
            rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rlf_source_get_info(source)->rig);
        result = rlf_reconstruct_create(&def, &stage);
    }
    for (int i = 0; i < 10 && result == RLF_OK; i++) {
        result = rlf_source_next(source, &frame);
        if (result == RLF_OK) {
            result = rlf_reconstruct_process(stage, &frame, &surface);
        }
    }
    bool is_right = result == RLF_OK && inspect(surface);
    if (result != RLF_OK) {
        fprintf(stderr, "%s\n", rlf_error_text());
    }
    rlf_reconstruct_destroy(&stage);
    rlf_source_destroy(&source);
    return is_right ? 0 : 1;
}
