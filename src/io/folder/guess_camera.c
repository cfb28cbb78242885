/* Cameras by the size of their depth pictures. One camera differs from the next of its kind by some
 * per cent, and several kinds share a size: it is a guess, and whoever takes it says so. */
#include "io/folder/layout.h"

#include "relief/image.h"

#include <string.h>

#define FARTHEST_MM 10000 /* in rooms half of the pixels are nearer */

typedef struct guess {
    int32_t width, height;
    double f, cx, cy; /* pixels */
    const char *name;
} guess;

/* Kinect v1: the sets recorded with it. Kinect v2: Fankhauser et al. 2015. RealSense: the D435's
 * field of view of 87 degrees, which its narrower pictures are cut from. Azure Kinect: its narrow
 * and its wide mode, the narrow one cut from the wide one at (192, 180). iPhone, iPad: the colour
 * camera's 1600 pixels of 1920. ARCore: 67 degrees, the colour camera's. */
static const guess guesses[] = {
    {640, 480, 525.0, 319.5, 239.5, "a Kinect v1 or an Xtion (a RealSense has about 385)"},
    {320, 240, 262.5, 159.5, 119.5, "a Kinect v1 or an Xtion at half its size"},
    {512, 424, 365.5, 255.5, 211.5, "a Kinect v2"},
    {1280, 720, 640.0, 639.5, 359.5, "a RealSense D400"},
    {848, 480, 424.0, 423.5, 239.5, "a RealSense D400"},
    {640, 360, 320.0, 319.5, 179.5, "a RealSense D400"},
    {480, 270, 240.0, 239.5, 134.5, "a RealSense D400"},
    {424, 240, 212.0, 211.5, 119.5, "a RealSense D400"},
    {640, 576, 504.0, 320.0, 332.0, "an Azure Kinect, narrow"},
    {320, 288, 252.0, 160.0, 166.0, "an Azure Kinect, narrow, binned"},
    {1024, 1024, 504.0, 512.0, 512.0, "an Azure Kinect, wide, without its distortion"},
    {512, 512, 252.0, 256.0, 256.0, "an Azure Kinect, wide, binned, without its distortion"},
    {256, 192, 213.0, 127.5, 95.5, "an iPhone or iPad"},
    {160, 120, 121.0, 79.5, 59.5, "ARCore"},
    {160, 90, 121.0, 79.5, 44.5, "ARCore"},
};

const char *io_guess_camera(int32_t width, int32_t height, rlf_camera *out)
{
    for (size_t i = 0; i < sizeof(guesses) / sizeof(guesses[0]); i++) {
        const guess *g = &guesses[i];
        if (g->width == width && g->height == height) {
            *out = (rlf_camera){
                .width = width, .height = height, .fx = g->f, .fy = g->f, .cx = g->cx, .cy = g->cy};
            return g->name;
        }
    }
    return NULL;
}

double io_guess_units(const uint16_t *depth, size_t count)
{
    size_t seen = 0, beyond = 0;
    for (size_t i = 0; i < count; i++) {
        seen += depth[i] != 0;
        beyond += depth[i] > FARTHEST_MM && depth[i] != UINT16_MAX;
    }
    return 2 * beyond > seen ? 5000.0 : 1000.0;
}
