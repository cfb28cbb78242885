/* Writers of one array each: float32 planes, vectors, labels, masks and pictures. */
#include "export_arrays.h"

#include <string.h>

static rlf_result write_plane(const char *path, rlf_npy_type type, const void *data, int32_t width,
                              int32_t height)
{
    const int64_t shape[2] = {height, width};
    return rlf_npy_write(path, type, data, shape, 2);
}

static rlf_result write_vectors(const export_frame *f, const char *path, const float *const xyz[3],
                                const int64_t shape[2])
{
    int64_t count = shape[0] * shape[1];
    for (int64_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            f->scratch[3 * i + c] = xyz[c][i];
        }
    }
    const int64_t shape3[3] = {shape[0], shape[1], 3};
    return rlf_npy_write(path, RLF_NPY_F32, f->scratch, shape3, 3);
}

/* ---- from the surface
 * ---------------------------------------------------------------------------- */

static const rlf_surface *surface_of(const export_frame *f)
{
    return f->output->surface;
}

static rlf_result surface_f32(const export_frame *f, const char *path, const float *plane)
{
    const rlf_surface *s = surface_of(f);
    return write_plane(path, RLF_NPY_F32, plane, s->width, s->height);
}

static rlf_result surface_vectors(const export_frame *f, const char *path, const float *x,
                                  const float *y, const float *z)
{
    const rlf_surface *s = surface_of(f);
    const float *const xyz[3] = {x, y, z};
    const int64_t shape[2] = {s->height, s->width};
    return write_vectors(f, path, xyz, shape);
}

static rlf_result write_depth(const export_frame *f, const char *path)
{
    return surface_f32(f, path, surface_of(f)->depth);
}

static rlf_result write_points(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    int32_t count = s->width * s->height;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = rlf_surface_point(s, i);
        f->scratch[3 * i] = (float)p.x;
        f->scratch[3 * i + 1] = (float)p.y;
        f->scratch[3 * i + 2] = (float)p.z;
    }
    const int64_t shape[3] = {s->height, s->width, 3};
    return rlf_npy_write(path, RLF_NPY_F32, f->scratch, shape, 3);
}

static rlf_result write_normals(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return surface_vectors(f, path, s->normal_x, s->normal_y, s->normal_z);
}

static rlf_result write_labels(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return write_plane(path, RLF_NPY_I32, s->label, s->width, s->height);
}

static rlf_result write_foreground(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return write_plane(path, RLF_NPY_U8, s->foreground, s->width, s->height);
}

static rlf_result write_velocity(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return surface_vectors(f, path, s->velocity_x, s->velocity_y, s->velocity_z);
}

static rlf_result write_thickness(const export_frame *f, const char *path)
{
    return surface_f32(f, path, surface_of(f)->thickness);
}

static rlf_result write_reason(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return write_plane(path, RLF_NPY_U8, s->reason, s->width, s->height);
}

static rlf_result write_background_depth(const export_frame *f, const char *path)
{
    return surface_f32(f, path, surface_of(f)->background_depth);
}

static rlf_result write_background_thickness(const export_frame *f, const char *path)
{
    return surface_f32(f, path, surface_of(f)->background_thickness);
}

static rlf_result write_background_normals(const export_frame *f, const char *path)
{
    const rlf_surface *s = surface_of(f);
    return surface_vectors(f, path, s->background_normal_x, s->background_normal_y,
                           s->background_normal_z);
}

/* ---- pictures
 * ------------------------------------------------------------------------------------ */

static rlf_result write_rgb(const export_frame *f, const char *path, const rlf_image_rgba8 *image)
{
    uint8_t *out = f->scratch_u8;
    for (int32_t y = 0; y < image->height; y++) {
        const uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = 0; x < image->width; x++, out += 3) {
            memcpy(out, row + 4 * x, 3);
        }
    }
    const int64_t shape[3] = {image->height, image->width, 3};
    return rlf_npy_write(path, RLF_NPY_U8, f->scratch_u8, shape, 3);
}

static rlf_result write_color(const export_frame *f, const char *path)
{
    const rlf_image_rgba8 *color = &f->output->frame.color;
    if (color->data == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "color: this frame has no colour picture; leave it out");
    }
    return write_rgb(f, path, color);
}

static rlf_result write_composite(const export_frame *f, const char *path)
{
    return write_rgb(f, path, &f->output->render.image);
}

static rlf_result write_matte(const export_frame *f, const char *path)
{
    const rlf_plane_u8 *matte = &f->output->render.matte;
    for (int32_t y = 0; y < matte->height; y++) {
        memcpy(f->scratch_u8 + (size_t)y * (size_t)matte->width, rlf_u8_row(matte, y),
               (size_t)matte->width);
    }
    return write_plane(path, RLF_NPY_U8, f->scratch_u8, matte->width, matte->height);
}

/* ---- truth, at the depth camera's full resolution
 * -------------------------------------------------- */

static rlf_result truth_plane(const export_frame *f, const char *path, rlf_npy_type type,
                              const void *plane)
{
    const rlf_camera *camera = &f->output->frame.rig->depth;
    return write_plane(path, type, plane, camera->width, camera->height);
}

static rlf_result truth_vectors(const export_frame *f, const char *path, const float *x,
                                const float *y, const float *z)
{
    const rlf_camera *camera = &f->output->frame.rig->depth;
    const float *const xyz[3] = {x, y, z};
    const int64_t shape[2] = {camera->height, camera->width};
    return write_vectors(f, path, xyz, shape);
}

static rlf_result write_true_depth(const export_frame *f, const char *path)
{
    return truth_plane(f, path, RLF_NPY_F32, f->truth->depth);
}

static rlf_result write_true_normals(const export_frame *f, const char *path)
{
    const rlf_truth *t = f->truth;
    return truth_vectors(f, path, t->normal_x, t->normal_y, t->normal_z);
}

static rlf_result write_true_labels(const export_frame *f, const char *path)
{
    return truth_plane(f, path, RLF_NPY_I32, f->truth->label);
}

static rlf_result write_true_foreground(const export_frame *f, const char *path)
{
    return truth_plane(f, path, RLF_NPY_U8, f->truth->foreground);
}

static rlf_result write_true_thickness(const export_frame *f, const char *path)
{
    return truth_plane(f, path, RLF_NPY_F32, f->truth->thickness);
}

static rlf_result write_true_velocity(const export_frame *f, const char *path)
{
    const rlf_truth *t = f->truth;
    return truth_vectors(f, path, t->velocity_x, t->velocity_y, t->velocity_z);
}

static rlf_result write_true_background(const export_frame *f, const char *path)
{
    return truth_plane(f, path, RLF_NPY_F32, f->truth->background_depth);
}

const export_kind export_kinds[] = {
    {"depth", EXPORT_NEEDS_SURFACE, "float32 (H,W) metres, 0 = missing", write_depth},
    {"points", EXPORT_NEEDS_SURFACE, "float32 (H,W,3) metres, camera frame", write_points},
    {"normals", EXPORT_NEEDS_SURFACE, "float32 (H,W,3) unit, 0 = missing", write_normals},
    {"labels", EXPORT_NEEDS_SURFACE, "int32 (H,W) region, 0 = none", write_labels},
    {"foreground", EXPORT_NEEDS_SURFACE, "uint8 (H,W) 1 = in front of the background",
     write_foreground},
    {"velocity", EXPORT_NEEDS_SURFACE, "float32 (H,W,3) m/s", write_velocity},
    {"thickness", EXPORT_NEEDS_SURFACE, "float32 (H,W) metres", write_thickness},
    {"reason", EXPORT_NEEDS_SURFACE, "uint8 (H,W) reason code", write_reason},
    {"background_depth", EXPORT_NEEDS_SURFACE, "float32 (H,W) metres, 0 = unknown",
     write_background_depth},
    {"background_normals", EXPORT_NEEDS_SURFACE, "float32 (H,W,3)", write_background_normals},
    {"background_thickness", EXPORT_NEEDS_SURFACE, "float32 (H,W) metres, 0 = unknown",
     write_background_thickness},
    {"color", EXPORT_NEEDS_SURFACE, "uint8 (H,W,3) the colour picture", write_color},
    {"composite", EXPORT_NEEDS_RENDER, "uint8 (H,W,3) with the bodies", write_composite},
    {"matte", EXPORT_NEEDS_RENDER, "uint8 (H,W) alpha of everything virtual", write_matte},
    {"true_depth", EXPORT_NEEDS_TRUTH, "float32 (H,W) without noise", write_true_depth},
    {"true_normals", EXPORT_NEEDS_TRUTH, "float32 (H,W,3)", write_true_normals},
    {"true_labels", EXPORT_NEEDS_TRUTH, "int32 (H,W) object id", write_true_labels},
    {"true_foreground", EXPORT_NEEDS_TRUTH, "uint8 (H,W)", write_true_foreground},
    {"true_thickness", EXPORT_NEEDS_TRUTH, "float32 (H,W) metres to the exit point",
     write_true_thickness},
    {"true_velocity", EXPORT_NEEDS_TRUTH, "float32 (H,W,3) m/s", write_true_velocity},
    {"true_background", EXPORT_NEEDS_TRUTH, "float32 (H,W) depth without the foreground",
     write_true_background},
};
const int export_kind_count = (int)(sizeof(export_kinds) / sizeof(export_kinds[0]));

const export_kind *export_kind_find(const char *name)
{
    for (int i = 0; i < export_kind_count; i++) {
        if (strcmp(export_kinds[i].name, name) == 0) {
            return &export_kinds[i];
        }
    }
    return NULL;
}
