/* PNG from memory through libpng. Its errors come back by longjmp, so everything that must survive
 * one lives in a struct outside the function that calls setjmp. */
#include "io/picture/picture.h"
#include "io/little.h"

#include <png.h>
#include <string.h>

/* Deflate cannot shrink more than 1032 times (Deutsch and Gailly, RFC 1951: 258 bytes per two
 * bits), and a pixel of one bit makes that times eight. */
#define PNG_PIXELS_PER_BYTE (1032 * 8)

typedef struct reader {
    const io_bytes *file;
    io_picture *picture;
    size_t position;
    png_structp png;
    png_infop info;
    int u16_channels;  /* wanted: 1 grey, 3 colour; 0 = 8-bit RGBA */
    bool owns_data;    /* picture->data was allocated here */
    rlf_result result; /* set before a longjmp of our own */
    char problem[128]; /* libpng's words */
} reader;

static void on_error(png_structp png, png_const_charp message)
{
    reader *r = png_get_error_ptr(png);
    snprintf(r->problem, sizeof(r->problem), "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message; /* they concern chunks that are not used, like colour profiles */
}

static void read_bytes(png_structp png, png_bytep out, size_t size)
{
    reader *r = png_get_io_ptr(png);
    if (size > r->file->size - r->position) {
        png_error(png, "the file ends too early");
    }
    memcpy(out, r->file->data + r->position, size);
    r->position += size;
}

/* Leaves the decoder with an error line that is already set. */
static void leave(reader *r, rlf_result result)
{
    r->result = result;
    png_longjmp(r->png, 1);
}

static void check_is_u16(reader *r)
{
    int depth = png_get_bit_depth(r->png, r->info);
    int type = png_get_color_type(r->png, r->info);
    bool is_grey = r->u16_channels == 1;
    if (type != (is_grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB) || depth != 16) {
        const char *kind = type == PNG_COLOR_TYPE_GRAY         ? "grey"
                           : type == PNG_COLOR_TYPE_GRAY_ALPHA ? "grey with alpha"
                           : type == PNG_COLOR_TYPE_PALETTE    ? "palette"
                                                               : "colour";
        const char *need = is_grey ? "depth must be a 16-bit grey PNG of the sensor's counts"
                                   : "normals must be a 16-bit colour PNG";
        leave(r, rlf_fail(RLF_ERROR_FORMAT, "%s: is a %d-bit %s PNG: %s", r->file->name, depth,
                          kind, need));
    }
}

/* Any kind to 8-bit RGBA. */
static void set_rgba(reader *r)
{
    int type = png_get_color_type(r->png, r->info);
    bool has_alpha =
        (type & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(r->png, r->info, PNG_INFO_tRNS) != 0;
    png_set_expand(r->png);
    png_set_scale_16(r->png);
    png_set_gray_to_rgb(r->png);
    if (has_alpha && r->picture->is_opaque) {
        png_set_strip_alpha(r->png);
    }
    if (!has_alpha || r->picture->is_opaque) {
        png_set_filler(r->png, 0xFF, PNG_FILLER_AFTER);
    }
}

static void decode(reader *r)
{
    png_set_user_limits(r->png, RLF_IMAGE_SIZE_MAX, RLF_IMAGE_SIZE_MAX);
    png_set_chunk_malloc_max(r->png, 8 << 20);
    png_set_read_fn(r->png, r, read_bytes);
    png_read_info(r->png, r->info);
    if (r->u16_channels > 0) {
        check_is_u16(r);
        if (!IO_IS_BIG_ENDIAN) { /* as PNG is */
            png_set_swap(r->png);
        }
    } else {
        set_rgba(r);
    }
    size_t pixel_size = r->u16_channels > 0 ? 2 * (size_t)r->u16_channels : 4;
    r->owns_data = r->picture->data == NULL;
    rlf_result result =
        io_picture_prepare(r->file, r->picture, png_get_image_width(r->png, r->info),
                           png_get_image_height(r->png, r->info), PNG_PIXELS_PER_BYTE, pixel_size);
    if (result != RLF_OK) {
        leave(r, result);
    }
    int passes = png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    size_t row_size = (size_t)r->picture->width * pixel_size;
    if (png_get_rowbytes(r->png, r->info) != row_size) {
        png_error(r->png, "unexpected pixel format");
    }
    for (int pass = 0; pass < passes; pass++) {
        for (int32_t y = 0; y < r->picture->height; y++) {
            png_read_row(r->png, (uint8_t *)r->picture->data + (size_t)y * row_size, NULL);
        }
    }
    png_read_end(r->png, NULL); /* sees that the last chunk is there */
}

/* Alone in its function, so that no local variable is live across the jump. */
static bool decode_or_jump(reader *r)
{
    if (setjmp(png_jmpbuf(r->png)) != 0) {
        return false;
    }
    decode(r);
    return true;
}

bool io_png_is(const io_bytes *file)
{
    return file->size >= 8 && png_sig_cmp(file->data, 0, 8) == 0;
}

bool io_png_is_u16(const io_bytes *file)
{
    /* Behind the signature and the head of IHDR: width, height, depth, kind of colour. */
    return io_png_is(file) && file->size >= 26 && file->data[24] == 16 &&
           file->data[25] == PNG_COLOR_TYPE_GRAY;
}

static rlf_result check_signature(const io_bytes *file)
{
    if (file->size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is empty (0 bytes): copy or record it again",
                        file->name);
    }
    if (!io_png_is(file)) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is not a PNG file: convert it to PNG", file->name);
    }
    return RLF_OK;
}

static rlf_result run(reader *r)
{
    rlf_result result = check_signature(r->file);
    if (result != RLF_OK) {
        return result;
    }
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, on_error, on_warning);
    r->info = r->png != NULL ? png_create_info_struct(r->png) : NULL;
    if (r->info == NULL) {
        png_destroy_read_struct(&r->png, NULL, NULL);
        return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while reading it", r->file->name);
    }
    bool is_whole = decode_or_jump(r);
    png_destroy_read_struct(&r->png, &r->info, NULL);
    if (is_whole) {
        return RLF_OK;
    }
    if (r->owns_data) {
        rlf_free(r->picture->data);
        r->picture->data = NULL;
    }
    if (r->result != RLF_OK) {
        return r->result;
    }
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the PNG is damaged or cut short (%s): copy or record it again",
                    r->file->name, r->problem);
}

rlf_result io_png_decode_u16(const io_bytes *file, io_picture *picture)
{
    reader r = {.file = file, .picture = picture, .u16_channels = 1};
    return run(&r);
}

rlf_result io_png_decode_rgb_u16(const io_bytes *file, io_picture *picture)
{
    reader r = {.file = file, .picture = picture, .u16_channels = 3};
    return run(&r);
}

rlf_result io_png_decode_rgba(const io_bytes *file, io_picture *picture)
{
    reader r = {.file = file, .picture = picture};
    return run(&r);
}
