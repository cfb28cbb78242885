/* .oni recordings of OpenNI and OpenNI2, read without their libraries. */
#include "io/formats/oni.h"
#include "io/picture/picture.h"
#include "io/source/backends.h"
#include "io/clip/clip.h"
#include "io/live/driver.h"

#include <string.h>

#define PIXEL_FORMAT_100_UM 101

/* What one byte can stand for at most: packed depth, and JPEG (as its reader takes it). */
#define DEPTH_PIXELS_PER_BYTE 30
#define JPEG_PIXELS_PER_BYTE (64 * 8 * 4)
#define RGB_FORMAT 1

#define DEPTH_MAX_M 10.0 /* of the cameras that OpenNI has */

typedef struct oni {
    io_file file;
    oni_index index;
    rlf_rig rig;
    double units_per_metre;
    bool depth_flips, color_flips, is_aligned;
    io_buffer buffer; /* of the packed picture */
} oni;

static rlf_result fail_picture(const oni *o, const oni_node *node, int32_t index, const char *what)
{
    return rlf_fail(RLF_ERROR_FORMAT, "%s: the %s picture at byte %lld is damaged", o->file.path,
                    what, (long long)node->pictures.items[index].position);
}

/* No picture needs more than three bytes a pixel and a table, however badly it packs. */
static rlf_result read_packed(oni *o, const oni_node *node, int32_t index, io_bytes *out)
{
    const io_shot *p = &node->pictures.items[index];
    const int64_t limit = (int64_t)node->width * node->height * 4 + (1 << 18);
    if ((int64_t)p->size > limit) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: the picture at byte %lld says that it has %u bytes",
                        o->file.path, (long long)p->position, (unsigned)p->size);
    }
    return io_file_read_bytes(&o->file, p->position, p->size, &o->buffer, out);
}

/* Turns pixels of `size` bytes, at most 4, from left to right. */
static void flip_rows(void *data, int32_t width, int32_t height, size_t size)
{
    for (int32_t y = 0; y < height; y++) {
        uint8_t *a = (uint8_t *)data + (size_t)y * (size_t)width * size;
        uint8_t *b = a + (size_t)(width - 1) * size;
        for (; a < b; a += size, b -= size) {
            uint8_t swap[4];
            memcpy(swap, a, size);
            memcpy(a, b, size);
            memcpy(b, swap, size);
        }
    }
}

static rlf_result read_depth(void *self, int32_t index, void *out)
{
    oni *o = self;
    const oni_node *node = &o->index.depth;
    const size_t count = (size_t)node->width * (size_t)node->height;
    io_bytes packed;
    rlf_result result = read_packed(o, node, index, &packed);
    if (result != RLF_OK) {
        return result;
    }
    bool is_good = packed.size == 2 * count;
    if (node->codec != ONI_CODEC_NONE) {
        is_good = oni_depth_decode(packed.data, packed.size, node->codec == ONI_CODEC_16Z_TABLE,
                                   out, count);
    } else if (is_good) {
        memcpy(out, packed.data, packed.size);
    }
    if (!is_good) {
        return fail_picture(o, node, index, "depth");
    }
    if (o->depth_flips) {
        flip_rows(out, node->width, node->height, 2);
    }
    return RLF_OK;
}

static rlf_result read_color(void *self, int32_t index, const rlf_image_rgba8 *out)
{
    oni *o = self;
    const oni_node *node = &o->index.color;
    io_bytes packed;
    rlf_result result = read_packed(o, node, index, &packed);
    if (result != RLF_OK) {
        return result;
    }
    if (node->codec == ONI_CODEC_JPEG) {
        io_picture picture = {
            .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
        result = io_jpeg_decode_rgba(&packed, &picture);
    } else if (packed.size == (size_t)node->width * (size_t)node->height * 3) {
        for (size_t i = 0; i < packed.size / 3; i++) {
            memcpy(out->data + 4 * i, packed.data + 3 * i, 3);
            out->data[4 * i + 3] = 255;
        }
    } else {
        result = fail_picture(o, node, index, "colour");
    }
    if (result == RLF_OK && o->color_flips) {
        flip_rows(out->data, out->width, out->height, 4);
    }
    return result;
}

static void oni_destroy(void *self)
{
    oni *o = self;
    io_file_close(&o->file);
    oni_index_free(&o->index);
    io_buffer_free(&o->buffer);
    rlf_free(o);
}

/* Whether the size is one, and the node's largest picture can hold so many pixels: a small file
 * does not make us reserve a gigabyte. */
static bool has_size(const oni_node *node, int64_t pixels_per_byte)
{
    int64_t largest = 0;
    for (int32_t i = 0; i < node->pictures.count; i++) {
        const io_shot *p = &node->pictures.items[i];
        largest = p->size > largest ? p->size : largest;
    }
    return node->width >= 1 && node->width <= RLF_IMAGE_SIZE_MAX && node->height >= 1 &&
           node->height <= RLF_IMAGE_SIZE_MAX &&
           (int64_t)node->width * node->height <= largest * pixels_per_byte;
}

static rlf_result check_depth(const oni *o)
{
    const oni_node *d = &o->index.depth;
    if (!d->is_there || d->pictures.count == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: holds no depth pictures", o->file.path);
    }
    if (!has_size(d, d->codec == ONI_CODEC_NONE ? 1 : DEPTH_PIXELS_PER_BYTE)) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: says that its depth pictures are %d x %d, which cannot be",
                        o->file.path, (int)d->width, (int)d->height);
    }
    if (d->codec != ONI_CODEC_NONE && d->codec != ONI_CODEC_16Z &&
        d->codec != ONI_CODEC_16Z_TABLE) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: its depth is packed with \"%.4s\", which is not read", o->file.path,
                        (const char *)&d->codec);
    }
    return RLF_OK;
}

/* Colour that cannot be read is left out: depth alone is of use. */
static void check_color(oni *o)
{
    oni_node *c = &o->index.color;
    const bool is_rgb = c->codec == ONI_CODEC_NONE && (c->rgb_format <= RGB_FORMAT);
    if (!c->is_there || c->pictures.count == 0) {
        c->pictures.count = 0;
    } else if (!has_size(c, is_rgb ? 1 : JPEG_PIXELS_PER_BYTE) ||
               (!is_rgb && c->codec != ONI_CODEC_JPEG)) {
        rlf_log(RLF_LOG_WARNING,
                "%s: its colour pictures (%d x %d, \"%.4s\", format %d) are not read: there is no "
                "colour",
                o->file.path, (int)c->width, (int)c->height, (const char *)&c->codec,
                (int)c->rgb_format);
        c->pictures.count = 0;
    }
}

static rlf_result read_keys(oni *o, const rlf_address *address)
{
    int color = 1, mirror = 0, aligned = o->index.depth.is_registered ? 1 : 0;
    rlf_result result = io_switch_get(address, "color", &color);
    result = result == RLF_OK ? io_switch_get(address, "aligned", &aligned) : result;
    result = result == RLF_OK ? io_switch_get(address, "mirror", &mirror) : result;
    const bool is_told = rlf_address_get(address, "mirror") != NULL;
    o->is_aligned = aligned == 1;
    o->depth_flips = is_told ? mirror == 1 : o->index.depth.is_mirrored;
    o->color_flips = is_told ? mirror == 1 : o->index.color.is_mirrored;
    o->index.color.pictures.count = color == 1 ? o->index.color.pictures.count : 0;
    return result;
}

/* Only the fields of view are in the file. Depth that was warped has the colour camera's lens. */
static void rig_of_file(oni *o)
{
    const oni_node *d = &o->index.depth;
    const oni_node *c = &o->index.color;
    rlf_rig *rig = &o->rig;
    *rig = rlf_rig_default();
    rig->depth_max_m = DEPTH_MAX_M;
    rig->has_color = c->pictures.count > 0;
    const bool is_told = io_camera_from_fov(d->width, d->height, d->fov_x, d->fov_y, &rig->depth);
    if (rig->has_color &&
        !io_camera_from_fov(c->width, c->height, c->fov_x, c->fov_y, &rig->color)) {
        (void)io_camera_from_fov(c->width, c->height, d->fov_x, d->fov_y, &rig->color);
    }
    if (rig->has_color && o->is_aligned) {
        rig->depth = rlf_camera_resize(&rig->color, d->width, d->height);
    } else if (rig->has_color) {
        rlf_log(RLF_LOG_WARNING,
                "%s: does not say that depth was aligned with colour, nor how the cameras stood: "
                "give ?aligned=1 if it was, or a calibration with ?camera=FILE",
                o->file.path);
    }
    if (!is_told) {
        rlf_log(RLF_LOG_WARNING,
                "%s: does not tell the field of view: 58 degrees are taken; give a calibration "
                "with ?camera=FILE",
                o->file.path);
    }
}

static rlf_result make_rig(oni *o, const rlf_address *address)
{
    bool is_found = false;
    double units = 0.0; /* the file knows its own */
    o->units_per_metre = o->index.depth.pixel_format == PIXEL_FORMAT_100_UM ? 10000.0 : 1000.0;
    rlf_result result = io_rig_beside(address, &o->rig, &units, &is_found);
    if (result != RLF_OK) {
        return result;
    }
    if (!is_found) {
        rig_of_file(o);
        return RLF_OK;
    }
    o->rig.has_color = o->rig.has_color && o->index.color.pictures.count > 0;
    const oni_node *depth = &o->index.depth, *color = &o->index.color;
    result = io_rig_check_size(o->file.path, "depth", depth->width, depth->height, &o->rig.depth);
    return result == RLF_OK && o->rig.has_color
               ? io_rig_check_size(o->file.path, "colour", color->width, color->height,
                                   &o->rig.color)
               : result;
}

static rlf_result open_clip(oni *o, rlf_opened *out)
{
    const bool flips = o->depth_flips || (o->rig.has_color && o->color_flips);
    const io_clip_def def = {
        .name = o->file.path,
        .device = "OpenNI recording",
        .rig = o->rig,
        .units_per_metre = o->units_per_metre,
        .depth = io_shots_times(&o->index.depth.pictures),
        .color = io_shots_times(&o->index.color.pictures),
        .flags = (flips ? (uint32_t)RLF_FRAME_UNMIRRORED : 0u) |
                 (o->is_aligned && o->rig.has_color ? (uint32_t)RLF_FRAME_ALIGNED : 0u),
        .read_depth = read_depth,
        .read_color = read_color,
        .destroy = oni_destroy,
        .self = o};
    return io_clip_open(&def, out);
}

static rlf_result open_all(oni *o, const rlf_address *address, rlf_opened *out)
{
    rlf_result result = io_file_open(&o->file, address->place, "check the name");
    result = result == RLF_OK ? oni_index_read(&o->file, &o->index) : result;
    result = result == RLF_OK ? check_depth(o) : result;
    if (result != RLF_OK) {
        return result;
    }
    if (o->index.is_cut) {
        rlf_log(RLF_LOG_WARNING,
                "%s: is cut short or damaged: the %d depth pictures before that place are read",
                o->file.path, (int)o->index.depth.pictures.count);
    }
    check_color(o);
    result = read_keys(o, address);
    result = result == RLF_OK ? make_rig(o, address) : result;
    return result == RLF_OK ? open_clip(o, out) : result;
}

static rlf_result oni_open(const rlf_address *address, rlf_opened *out)
{
    oni *o = rlf_alloc(sizeof(*o));
    return io_open_end(o != NULL ? open_all(o, address, out) : RLF_ERROR_MEMORY, o, oni_destroy);
}

const rlf_backend io_backend_oni = {
    .version = RLF_BACKEND_VERSION,
    .scheme = "oni",
    .extensions = ".oni",
    .keys = "aligned color mirror",
    .summary = "recordings of OpenNI and OpenNI2: PrimeSense, Xtion, Kinect v1",
    .open = oni_open,
};
