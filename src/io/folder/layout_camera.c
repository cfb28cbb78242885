/* The camera of a folder without camera.json: intrinsic.json of Open3D, else what the data set is
 * known to have used. */
#include "io/folder/folder.h"
#include "io/json.h"
#include "relief/image.h"

#include <math.h>
#include <string.h>

/* ---- cameras by the size of their depth pictures ----------------------------------------- */

#define FARTHEST_MM 10000 /* in rooms half of the pixels are nearer */

typedef struct guessed_camera {
    int32_t width, height;
    double f, cx, cy; /* pixels */
    const char *name;
} guessed_camera;

/* Kinect v1: the sets recorded with it. Kinect v2: Fankhauser et al. 2015. RealSense: the D435's
 * field of view of 87 degrees, which its narrower pictures are cut from. Azure Kinect: its narrow
 * and its wide mode, the narrow one cut from the wide one at (192, 180). iPhone, iPad: the colour
 * camera's 1600 pixels of 1920. ARCore: 67 degrees, the colour camera's. */
static const guessed_camera guesses[] = {
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
        const guessed_camera *g = &guesses[i];
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

/* fx fy cx cy at 640 x 480, distortion k1 k2 p1 p2 k3. */
typedef struct known_camera {
    const char *name; /* part of the folder's path; NULL = any of the layout */
    io_layout_kind kind;
    double fx, fy, cx, cy;
    double distortion[5];
    const char *note;
} known_camera;

/* The colour cameras of Sturm et al., IROS 2012, as their page gives them; ICL-NUIM's (Handa et
 * al., ICRA 2014) has fy = -480 with y up, which is 480 with y down; 7-Scenes' page says 585. */
static const known_camera known[] = {
    {"freiburg1",
     IO_LAYOUT_TUM,
     517.306408,
     516.469215,
     318.643040,
     255.313989,
     {0.262383, -0.953104, -0.005358, 0.002628, 1.163314},
     "TUM RGB-D freiburg1's"},
    {"freiburg2",
     IO_LAYOUT_TUM,
     520.908620,
     521.007327,
     325.141442,
     249.701764,
     {0.231222, -0.784899, -0.003257, -0.000105, 0.917205},
     "TUM RGB-D freiburg2's"},
    {"freiburg3", IO_LAYOUT_TUM, 535.4, 539.2, 320.1, 247.6, {0}, "TUM RGB-D freiburg3's"},
    {NULL, IO_LAYOUT_ICL, 481.20, 480.00, 319.50, 239.50, {0}, "ICL-NUIM's"},
    {NULL, IO_LAYOUT_SCENES7, 585.0, 585.0, 320.0, 240.0, {0}, "7-Scenes'"},
    {NULL, IO_LAYOUT_REDWOOD, 525.0, 525.0, 319.5, 239.5, {0}, "a PrimeSense camera's"},
    {NULL, IO_LAYOUT_TUM, 525.0, 525.0, 319.5, 239.5, {0}, "a PrimeSense camera's"},
};
#define KNOWN_COUNT ((int)(sizeof(known) / sizeof(known[0])))

/* TUM's layout is used by many: of a clip of the user's own nothing is known. */
static const known_camera *find_known(const char *folder, const io_layout *layout)
{
    for (int i = 0; i < KNOWN_COUNT; i++) {
        const bool is_named = known[i].name != NULL && strstr(folder, known[i].name) != NULL;
        const bool is_any = known[i].name == NULL && layout->units_per_metre > 0.0;
        if (known[i].kind == layout->kind && (is_named || is_any)) {
            return &known[i];
        }
    }
    return NULL;
}

static rlf_camera camera_of(const known_camera *k, int32_t width, int32_t height)
{
    rlf_camera camera = {
        .width = 640, .height = 480, .fx = k->fx, .fy = k->fy, .cx = k->cx, .cy = k->cy};
    memcpy(camera.distortion, k->distortion, sizeof(k->distortion));
    camera.distortion_model =
        k->distortion[0] != 0.0 ? RLF_DISTORTION_PLUMB_BOB : RLF_DISTORTION_NONE;
    return rlf_camera_resize(&camera, width, height);
}

static rlf_result use_known(const char *folder, const io_layout *layout, int32_t width,
                            int32_t height, rlf_camera *out)
{
    const known_camera *k = find_known(folder, layout);
    /* A picture of another shape was cut: nobody knows where. */
    const bool is_whole = (int64_t)width * 480 == (int64_t)height * 640;
    const char *guess = NULL;
    if (k != NULL && is_whole) {
        *out = camera_of(k, width, height);
    } else {
        guess = io_guess_camera(width, height, out);
    }
    if ((k == NULL || !is_whole) && guess == NULL) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s/camera.json: is missing, and no camera is known for pictures of %d x "
                        "%d: write the intrinsics there, docs/formats.md shows how, or give "
                        "SOURCE?camera=FILE",
                        folder, (int)width, (int)height);
    }
    rlf_log(RLF_LOG_WARNING,
            "%s: has no camera.json: the intrinsics are %s %s: fx %.1f fy %.1f cx %.1f cy %.1f; if "
            "the camera is another one, give SOURCE?camera=FILE or write camera.json there",
            folder, guess != NULL ? "a guess by the pictures' size, those of" : "taken to be",
            guess != NULL ? guess : k->note, out->fx, out->fy, out->cx, out->cy);
    return RLF_OK;
}

/* Open3D: width, height, intrinsic_matrix as nine numbers, column by column. */
static rlf_result parse_intrinsic(const io_bytes *file, rlf_camera *out)
{
    static const io_json_field matrix_field = {
        "intrinsic_matrix", "nine numbers: fx 0 0 0 fy 0 cx cy 1", -1e6, 1e6, true};
    static const io_json_field size_fields[2] = {
        {"width", "the picture's width in pixels", 1, RLF_IMAGE_SIZE_MAX, true},
        {"height", "the picture's height in pixels", 1, RLF_IMAGE_SIZE_MAX, true}};
    json_t *document = NULL;
    rlf_result result = io_json_parse(file, &document);
    if (result != RLF_OK) {
        return result;
    }
    const io_json_object top = io_json_top(file, document);
    double m[9] = {0};
    memset(out, 0, sizeof(*out));
    result = io_json_get_numbers(&top, &matrix_field, m, 9);
    result = result == RLF_OK ? io_json_get_integer(&top, &size_fields[0], &out->width) : result;
    result = result == RLF_OK ? io_json_get_integer(&top, &size_fields[1], &out->height) : result;
    json_decref(document);
    out->fx = m[0];
    out->fy = fabs(m[4]); /* negative where y is up: the rows are the same */
    out->cx = m[6];
    out->cy = m[7];
    return result == RLF_OK ? rlf_camera_check(out, file->name) : result;
}

/* RLF_NO_FRAME: there is no such file. */
static rlf_result read_intrinsic(const char *folder, const char *name, rlf_camera *out)
{
    char path[IO_PATH_MAX];
    io_buffer buffer = {0};
    io_bytes file;
    rlf_result result = io_path_join(folder, name, path);
    if (result == RLF_OK && io_file_read(path, IO_JSON_FILE_MAX, "-", &buffer, &file) != RLF_OK) {
        result = RLF_NO_FRAME;
    }
    result = result == RLF_OK ? parse_intrinsic(&file, out) : result;
    io_buffer_free(&buffer);
    return result;
}

rlf_result io_layout_camera(const char *folder, io_layout *layout, int32_t width, int32_t height,
                            rlf_camera *out)
{
    static const char *const names[] = {"intrinsic.json", "camera_intrinsic.json",
                                        "intrinsics.json", "../intrinsic.json"};
    for (int i = 0; i < 4; i++) {
        rlf_result result = read_intrinsic(folder, names[i], out);
        if (result < 0) {
            return result;
        }
        if (result == RLF_OK && (out->width != width || out->height != height)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s/%s: is for %d x %d pixels and the depth pictures have %d x %d: "
                            "write what belongs to them",
                            folder, names[i], (int)out->width, (int)out->height, (int)width,
                            (int)height);
        }
        if (result == RLF_OK) {
            return RLF_OK;
        }
    }
    return use_known(folder, layout, width, height, out);
}
