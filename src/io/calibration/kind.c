/* Kinds of files, by their first bytes and by their keys. */
#include "io/calibration/calibration.h"

#include <string.h>

#define LOOK_AT 4096 /* bytes from the beginning */

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

static bool holds(const io_bytes *text, const char *word)
{
    const size_t length = strlen(word);
    const size_t end = text->size < LOOK_AT ? text->size : LOOK_AT;
    for (size_t i = 0; i + length <= end; i++) {
        if (memcmp(text->data + i, word, length) == 0) {
            return true;
        }
    }
    return false;
}

/* What binary files begin with; NULL = nothing that is known. */
static const char *binary_kind(const io_bytes *file)
{
    static const struct {
        const char *magic;
        size_t size;
        const char *kind;
    } kinds[] = {{"\x89PNG", 4, "a PNG picture"},
                 {"\xFF\xD8\xFF", 3, "a JPEG picture"},
                 {"\x93NUMPY", 6, "an array of NumPy (.npy)"},
                 {"PK\x03\x04", 4, "a zip or an .npz archive"},
                 {"\x1F\x8B", 2, "packed with gzip: unpack it"},
                 {"\x28\xB5\x2F\xFD", 4, "packed with zstd: unpack it"},
                 {"\x89MCAP", 5, "an MCAP recording: give it as the SOURCE"},
                 {"#ROSBAG", 7, "a ROS bag: give it as the SOURCE"},
                 {"\x1A\x45\xDF\xA3", 4, "a Matroska recording: give it as the SOURCE"},
                 {"\x89HDF", 4, "an HDF5 or MATLAB file"},
                 {"MATLAB", 6, "a MATLAB file"},
                 {"\x80\x04", 2, "a Python pickle"},
                 {"%PDF", 4, "a PDF document"},
                 {"glTF", 4, "a glTF model"}};
    for (size_t i = 0; i < sizeof(kinds) / sizeof(kinds[0]); i++) {
        if (file->size >= kinds[i].size && memcmp(file->data, kinds[i].magic, kinds[i].size) == 0) {
            return kinds[i].kind;
        }
    }
    const size_t end = file->size < LOOK_AT ? file->size : LOOK_AT;
    return end > 0 && memchr(file->data, '\0', end) != NULL ? "a binary file" : NULL;
}

/* JSON begins with a bracket, and mrcal's files name a lens model. */
static bool is_json(const io_bytes *text)
{
    if (ends_with(text->name, ".json")) {
        return true;
    }
    if (ends_with(text->name, ".yaml") || ends_with(text->name, ".yml") ||
        ends_with(text->name, ".cameramodel")) {
        return false;
    }
    return (text->data[0] == '{' || text->data[0] == '[') && !holds(text, "lensmodel");
}

rlf_result io_calibration_kind_of(const io_bytes *file, io_calibration_kind *out)
{
    io_bytes text = io_bytes_unmarked(file);
    const char *binary = binary_kind(file);
    while (text.size > 0 && strchr(" \t\r\n", text.data[0]) != NULL && text.data[0] != '\0') {
        text.data++;
        text.size--;
    }
    if (text.size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is empty: write a calibration there, docs/formats.md shows how",
                        file->name);
    }
    if (binary != NULL) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: is no calibration: it looks like %s; see docs/calibration.md for what "
                        "is read",
                        file->name, binary);
    }
    *out = text.data[0] == '<' ? IO_CALIBRATION_XML
           : is_json(&text)    ? IO_CALIBRATION_JSON
                               : IO_CALIBRATION_TEXT;
    return RLF_OK;
}

rlf_result io_calibration_fail_unknown(const io_json_object *top)
{
    static const struct {
        const char *key, *kind;
    } kinds[] = {
        {"bodies", "a scene of Relief: give it with --scene"},
        {"known_objects", "a scene of Relief: give it with --scene"},
        {"asset", "a glTF model"},
        {"CalibrationInformation", "the factory's calibration of an Azure Kinect, which .mkv files "
                                   "hold and k4a: reads"},
        {"cameras", "a calibration of another program (a list of cameras)"},
        {"T_imu_cam", "IMU results"},
        {"rosbag2_bagfile_information", "the metadata of a ROS 2 recording: give its .mcap as the "
                                        "SOURCE"},
        {"parameters", "settings of a camera's driver"},
    };
    const char *first = json_object_iter_key(json_object_iter(top->value));
    const char *kind = "another kind of file";
    for (size_t i = 0; i < sizeof(kinds) / sizeof(kinds[0]); i++) {
        if (json_object_get(top->value, kinds[i].key) != NULL) {
            kind = kinds[i].kind;
            break;
        }
    }
    return rlf_fail(RLF_ERROR_INVALID,
                    "%s: is no calibration that is read: it looks like %s (its first key is %.40s) "
                    "and has neither depth, camera_matrix, intrinsic_matrix, lensmodel nor cam0; "
                    "see docs/calibration.md",
                    top->file, kind, first != NULL ? first : "missing");
}
