/* An organised .pcd as a source of one frame. */
#include "io/calibration/calibration.h"
#include "io/formats/pcd.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the camera that the cloud was made with --------------------------------------------- */

#define POINTS_MIN 16
#define RESIDUAL_MAX_PX 0.1

/* Sums of a line pixel = f slope + c. */
typedef struct line_fit {
    double n, s, p, ss, sp, pp;
} line_fit;

static void add(line_fit *l, double slope, double pixel)
{
    l->n += 1.0;
    l->s += slope;
    l->p += pixel;
    l->ss += slope * slope;
    l->sp += slope * pixel;
    l->pp += pixel * pixel;
}

static bool solve(const line_fit *l, double *out_f, double *out_c)
{
    const double spread = l->ss - l->s * l->s / l->n;
    const double common = l->sp - l->s * l->p / l->n;
    const double whole = l->pp - l->p * l->p / l->n;
    if (!(l->n >= POINTS_MIN) || !(spread > 0.0) || !(common > 0.0)) {
        return false;
    }
    *out_f = common / spread;
    *out_c = (l->p - *out_f * l->s) / l->n;
    const double rest = fmax(whole - *out_f * common, 0.0);
    return isfinite(*out_f) && isfinite(*out_c) && sqrt(rest / l->n) <= RESIDUAL_MAX_PX;
}

bool io_pcd_lens_fit(const io_pcd_header *header, const io_pcd_points *points, rlf_camera *out)
{
    line_fit u = {0}, v = {0};
    for (int32_t y = 0; y < header->height; y++) {
        for (int32_t x = 0; x < header->width; x++) {
            const size_t i = (size_t)y * (size_t)header->width + (size_t)x;
            const double z = points->z[i];
            if (z > 0.0 && isfinite(z) && isfinite(points->x[i]) && isfinite(points->y[i])) {
                add(&u, points->x[i] / z, x);
                add(&v, points->y[i] / z, y);
            }
        }
    }
    memset(out, 0, sizeof(*out));
    out->width = header->width;
    out->height = header->height;
    return solve(&u, &out->fx, &out->cx) && solve(&v, &out->fy, &out->cy);
}

#define FILE_MAX ((size_t)1 << 30)

typedef struct pcd {
    io_pcd_header header;
    io_pcd_points points;
    rlf_rig rig;
} pcd;

static rlf_result read_depth(void *self, int32_t index, void *out)
{
    (void)index;
    const pcd *p = self;
    memcpy(out, p->points.z, (size_t)p->header.width * (size_t)p->header.height * sizeof(float));
    return RLF_OK;
}

static rlf_result read_color(void *self, int32_t index, const rlf_image_rgba8 *out)
{
    (void)index;
    const pcd *p = self;
    memcpy(out->data, p->points.rgba, (size_t)p->header.width * (size_t)p->header.height * 4);
    return RLF_OK;
}

static void destroy(void *self)
{
    pcd *p = self;
    io_pcd_points_free(&p->points);
    rlf_free(p);
}

/* The user's calibration, else what the points tell, else a file beside. */
static rlf_result set_rig(const rlf_address *address, pcd *p)
{
    double units = 0.0; /* points are in metres */
    bool is_found = false;
    rlf_camera lens;
    p->rig = rlf_rig_default();
    if (address->rig == NULL && io_pcd_lens_fit(&p->header, &p->points, &lens)) {
        p->rig.depth = lens;
        is_found = true;
    } else {
        rlf_result result = io_rig_beside(address, &p->rig, &units, &is_found);
        if (result != RLF_OK) {
            return result;
        }
    }
    if (!is_found) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: its points do not lie on the rays of a pinhole camera, x right, y "
                        "down, z forward: give the calibration, ?camera=FILE",
                        address->source);
    }
    /* A point has its colour: one camera for both. */
    p->rig.has_color = p->points.rgba != NULL;
    p->rig.color = p->rig.depth;
    p->rig.T_color_depth = rlf_pose_identity();
    return io_rig_check_size(address->source, "depth", p->header.width, p->header.height,
                             &p->rig.depth);
}

static rlf_result read_file(const rlf_address *address, pcd *p)
{
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result =
        io_file_read(address->place, FILE_MAX, "give an organised .pcd file", &buffer, &file);
    result = result == RLF_OK ? io_pcd_header_parse(&file, &p->header) : result;
    result = result == RLF_OK ? io_pcd_points_read(&file, &p->header, &p->points) : result;
    io_buffer_free(&buffer);
    return result;
}

static rlf_result open_clip(const rlf_address *address, pcd *p, rlf_opened *out)
{
    static const int64_t time_ns = 0;
    const io_clip_def def = {.name = address->place,
                             .device = "organised point cloud (PCD)",
                             .rig = p->rig,
                             .depth = {&time_ns, sizeof(time_ns), 1},
                             .color = {&time_ns, sizeof(time_ns), p->points.rgba != NULL ? 1 : 0},
                             .flags = RLF_FRAME_ALIGNED,
                             .read_depth = read_depth,
                             .read_color = read_color,
                             .destroy = destroy,
                             .self = p};
    return io_clip_open(&def, out);
}

static rlf_result open_all(const rlf_address *address, pcd *p, rlf_opened *out)
{
    rlf_result result = read_file(address, p);
    result = result == RLF_OK ? set_rig(address, p) : result;
    return result == RLF_OK ? open_clip(address, p, out) : result;
}

static rlf_result pcd_open(const rlf_address *address, rlf_opened *out)
{
    pcd *p = rlf_alloc(sizeof(*p));
    return io_open_end(p != NULL ? open_all(address, p, out) : RLF_ERROR_MEMORY, p, destroy);
}

const rlf_backend io_backend_pcd = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "pcd",
    .extensions = ".pcd",
    .summary = "one frame: an organised point cloud of PCL",
    .open = pcd_open,
};
