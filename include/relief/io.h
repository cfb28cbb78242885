/* Relief: files and devices (librelief_io). Every reader names the file and the cure when it fails.
 *
 * Writers that make one file write FILE.PID-N.part and rename it when it is whole, so nothing
 * half-written looks finished. Thread-safety: distinct objects and paths may be used from distinct
 * threads. SPDX-License-Identifier: MIT */
#ifndef RELIEF_IO_H
#define RELIEF_IO_H

#include "relief/backend.h"
#include "relief/map.h"
#include "relief/model.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- sources
 * -------------------------------------------------------------------------------------- */

/* Opens any SOURCE of the command line: "synthetic:...", or a folder in the TUM layout with
 * camera.json. `pool` is borrowed (NULL = one thread). */
RLF_API rlf_result rlf_open_source(const char *source, rlf_pool *pool, rlf_source **out);

/* Cameras that are plugged in now, of all back ends of this build: writes at most `capacity`,
 * returns how many there are. May take a second: drivers ask the bus. */
RLF_API int32_t rlf_source_list(rlf_source_entry *out, int32_t capacity);

/* A kind of source, for lists. Strings are constant for the program's life; NULL = none. */
typedef struct rlf_source_kind {
    const char *scheme;      /* of "scheme:place" */
    const char *extensions;  /* of its files, e.g. ".oni .mkv" */
    const char *keys;        /* its own keys of ?key=value */
    const char *summary;     /* one line */
    const char *unavailable; /* why it cannot be opened and what to do; NULL = it can be */
    const char *option;      /* the build was made without it: the option that brings it */
    const char *plugin;      /* the shared object that it came from; NULL = built in */
    bool is_live;            /* true: cameras; false: files */
} rlf_source_kind;

/* Copies into `out` the word of `list`, words with blanks between, that takes the fewest edits
 * (Levenshtein 1966) to make of `word`: what a message asks "did you mean" of. False, and `out` as
 * it was, when none is within a third of its letters; list NULL = no words. Thread-safety: safe. */
RLF_API bool rlf_word_nearest(const char *list, const char *word, char *out, size_t size);

/* Kinds of source that this build knows: built-in ones, those of plug-ins, then those that it was
 * made without. Writes at most `capacity`, returns how many there are. Thread-safety: safe. */
RLF_API int32_t rlf_source_kind_list(rlf_source_kind *out, int32_t capacity);

/* Loads a plug-in, a shared object that exports rlf_backend_entry (relief/backend.h), so that
 * rlf_open_source knows its scheme. It stays loaded; loading it again does nothing. Those in the
 * folders $RELIEF_PLUGIN_PATH (colons between), PREFIX/lib/relief/plugins and
 * ~/.local/lib/relief/plugins are loaded by themselves, with a warning for each that cannot be.
 * Thread-safety: safe. */
RLF_API rlf_result rlf_plugin_load(const char *path);

/* TUM RGB-D folder: depth.txt, rgb.txt (optional), camera.json; see docs/formats.md. Each depth
 * frame is paired with the colour frame nearest in time (at most 50 ms away, else none). */
RLF_API rlf_result rlf_folder_source_open(const char *path, rlf_source **out);

/* Reads camera.json, or a calibration of ROS (camera_info YAML), OpenCV (YAML), Open3D (pinhole
 * JSON) or mrcal (.cameramodel); docs/calibration.md. "DEPTH,COLOR" are two files. Colour absent:
 * has_color false. Counts a metre of the depth pictures go to *out_units_per_metre: 1000 where the
 * file does not say. */
RLF_API rlf_result rlf_rig_load(const char *path, rlf_rig *out, double *out_units_per_metre);

/* Kinds of calibration file. */
typedef enum rlf_rig_format {
    RLF_RIG_RELIEF = 0, /* camera.json */
    RLF_RIG_ROS = 1,    /* camera_info YAML; of a pair two files */
    RLF_RIG_OPENCV = 2, /* YAML of FileStorage */
    RLF_RIG_OPEN3D = 3, /* PinholeCameraIntrinsic; of a pair two files. Lens distortion is lost */
    RLF_RIG_MRCAL = 4   /* .cameramodel; of a pair two files */
} rlf_rig_format;

/* Writes a calibration. Of a pair in two files STEM_depth.EXT and STEM_color.EXT are written for
 * STEM.EXT. units_per_metre, the range (depth_max_m 0 = unknown), noise (all 0 = unknown) and
 * `note` (NULL = none) go into camera.json only. */
RLF_API rlf_result rlf_rig_save(const char *path, rlf_rig_format format, const rlf_rig *rig,
                                double units_per_metre, const char *note);

/* ---- recordings
 * ------------------------------------------------------------------------------------- */

/* How depth is packed in an MCAP file: RVL (Wilson 2017) is faster, PNG is read by more programs.
 */
typedef enum rlf_depth_codec { RLF_DEPTH_RVL = 0, RLF_DEPTH_PNG = 1 } rlf_depth_codec;

/* How the chunks of an MCAP file are packed. */
typedef enum rlf_compression {
    RLF_COMPRESSION_ZSTD = 0,
    RLF_COMPRESSION_LZ4 = 1,
    RLF_COMPRESSION_NONE = 2
} rlf_compression;

/* How a recording is written. From rlf_recording_def_default. */
typedef struct rlf_recording_def {
    uint32_t cookie;             /* from rlf_recording_def_default */
    rlf_depth_codec depth_codec; /* of MCAP files; folders have PNG. Both are lossless */
    rlf_compression compression; /* of the chunks of an MCAP file */
    int32_t jpeg_quality;        /* of colour, 1..100, default 90; 0 = PNG, lossless */
    double chunk_s; /* seconds between two writes of an MCAP file, > 0, default 1: what is lost at
                       most when the power goes */
} rlf_recording_def;

/* How far a recording is. */
typedef struct rlf_recording_status {
    uint64_t frames; /* added; once it is closed those that can be read back: a full disk keeps
                        fewer */
    uint64_t bytes;  /* written so far; about, until it is closed */
} rlf_recording_status;

/* A recording that is being written. */
typedef struct rlf_recording rlf_recording;

/* The defaults that the fields name. */
RLF_API rlf_recording_def rlf_recording_def_default(void);
/* Begins a recording of a source: an MCAP file with ROS 2 messages, or, when the path ends with /
 * or is a folder, a folder in the TUM layout, or, when it is "ros2:/NAME", the topics of a camera,
 * which other programs read at once (docs/ros2.md). What is there of the same name is replaced. The
 * file can be read at any time, whatever becomes of the program. docs/formats.md has the topics. */
RLF_API rlf_result rlf_recording_open(const char *path, const rlf_source_info *info,
                                      const rlf_recording_def *def, rlf_recording **out);
/* Writes a frame of that source. After a failure, as a full disk, close it: what was written is
 * kept. Thread-safety: one thread at a time. */
RLF_API rlf_result rlf_recording_add(rlf_recording *recording, const rlf_frame *frame);
/* Poses of the bodies, as frames of /tf; folders keep none. After the first frame. */
RLF_API rlf_result rlf_recording_add_bodies(rlf_recording *recording, int64_t time_ns,
                                            const rlf_snapshot *snapshot);
/* How far it is. Thread-safety: as add. */
RLF_API rlf_recording_status rlf_recording_get_status(const rlf_recording *recording);
/* Finishes the file; the pointer is nulled even when it fails. NULL and a NULL recording are
 * allowed, and `out` may be NULL. */
RLF_API rlf_result rlf_recording_close(rlf_recording **recording, rlf_recording_status *out);

/* ---- ROS 2
 * ------------------------------------------------------------------------------------------ */

/* What a run makes, published for other programs and machines; docs/ros2.md has the topics. */
typedef struct rlf_ros2_publisher rlf_ros2_publisher;

/* Counts since it was opened. */
typedef struct rlf_ros2_status {
    uint64_t frames;   /* that went out */
    uint64_t dropped;  /* that came while two earlier ones were still going out */
    uint64_t messages; /* sent, of what a run makes */
    uint64_t unsent;   /* messages that a reader was too slow for */
} rlf_ros2_status;

/* Opens the topics below a name and starts a thread: `address` is "ros2:/relief", with
 * ?profile=local|lan|FILE and ?domain=N as the source ros2: has them. RLF_ERROR_INVALID for an
 * address that is none, RLF_ERROR_DEVICE without a network, RLF_ERROR_UNSUPPORTED where the build
 * has no ROS 2. Destroy with rlf_ros2_publisher_close. */
RLF_API rlf_result rlf_ros2_publisher_open(const char *address, const rlf_source_info *info,
                                           rlf_ros2_publisher **out);
/* Copies of one frame what somebody reads, and waits for nobody. A frame of that source.
 * Thread-safety: one thread at a time. */
RLF_API void rlf_ros2_publisher_add(rlf_ros2_publisher *publisher,
                                    const rlf_pipeline_output *frame);
/* How much went out. Thread-safety: safe. */
RLF_API rlf_ros2_status rlf_ros2_publisher_get_status(rlf_ros2_publisher *publisher);
/* Sends what waits, ends the thread and nulls the pointer. NULL and a NULL publisher are allowed.
 */
RLF_API void rlf_ros2_publisher_close(rlf_ros2_publisher **publisher);

/* ---- several cameras
 * --------------------------------------------------------------------------------------- */

/* One of the cameras that see the same room. */
typedef struct rlf_placed_camera {
    char source[1024];       /* for rlf_open_source */
    rlf_pose T_world_camera; /* depth camera in the world of them all */
} rlf_placed_camera;

/* Reads a file that lists cameras (docs/several-cameras.md): 1 to RLF_WORLD_CAMERAS_MAX of them,
 * for which `out` has room, and *out_count. Sources that are files lie beside the list. */
RLF_API rlf_result rlf_cameras_load(const char *path, rlf_placed_camera *out, int32_t *out_count);

/* ---- scenes
 * ----------------------------------------------------------------------------------------- */

/* Reads scene.json (see docs/formats.md); unknown keys, wrong types and values that the world would
 * refuse are errors that name them. Destroy with rlf_scene_destroy. */
RLF_API rlf_result rlf_scene_load(const char *path, rlf_scene *out);
/* Writes a copy of a scene file in which the `known` objects, found by name, have the poses given
 * here in place of theirs or of their points; those without a pose stay as they are. Both paths may
 * be the same. */
RLF_API rlf_result rlf_scene_save_known(const char *scene_path, const rlf_known_def *known,
                                        int32_t count, const char *out_path);

/* ---- models
 * ----------------------------------------------------------------------------------------- */

/* Reads a model from .gltf, .glb (glTF 2.0) or .obj, with the files that it names: geometry, base
 * colours and base colour textures (PNG, JPEG), factors of metalness and roughness. A texture that
 * cannot be had is left out with one warning. glTF, which is y up, is turned half round x, so that
 * it stands upright here and faces the camera; OBJ is taken as it is. Destroy with
 * rlf_model_destroy. Thread-safety: safe, one at a time. */
RLF_API rlf_result rlf_model_load(const char *path, rlf_model **out);

/* The convex hull of a point cloud (metres) as a solid about its centre of mass, which goes to
 * *out_centre; NULL is allowed. At most `vertex_limit` (>= 4) vertices are kept, those that stand
 * out most. RLF_ERROR_INVALID: fewer than 4 points, or all in a plane. Needs libqhull:
 * RLF_ERROR_UNSUPPORTED without. rlf_free it. Thread-safety: safe. */
RLF_API rlf_result rlf_hull_create(const rlf_vec3 *points, int32_t point_count,
                                   int32_t vertex_limit, rlf_hull **out, rlf_vec3 *out_centre);

/* ---- pictures
 * --------------------------------------------------------------------------------------- */

/* Reads 16-bit grey PNG into a new array (rlf_free it). 8-bit, colour or palette is an error. */
RLF_API rlf_result rlf_png_read_u16(const char *path, uint16_t **out, int32_t *out_width,
                                    int32_t *out_height);
/* Reads 16-bit colour PNG, three numbers a pixel, into a new array (rlf_free it). */
RLF_API rlf_result rlf_png_read_rgb_u16(const char *path, uint16_t **out, int32_t *out_width,
                                        int32_t *out_height);
/* Reads a PNG (any kind) or JPEG as RGBA into a new image (rlf_free its data). */
RLF_API rlf_result rlf_picture_read(const char *path, rlf_image_rgba8 *out);
/* Writes 8-bit colour with alpha. RLF_ERROR_IO names the file. */
RLF_API rlf_result rlf_png_write_rgba(const char *path, const rlf_image_rgba8 *image);
/* The same for colours that are premultiplied by alpha, as those of RLF_VIEW_BODIES; a PNG's are
 * not, so they are divided by it. An opaque picture stays as it is. RLF_ERROR_IO names the file. */
RLF_API rlf_result rlf_png_write_premultiplied(const char *path, const rlf_image_rgba8 *image);
/* Writes 8-bit grey. RLF_ERROR_IO names the file. */
RLF_API rlf_result rlf_png_write_u8(const char *path, const rlf_plane_u8 *plane);
/* Writes 16-bit grey, width * height values row by row. RLF_ERROR_IO names the file. */
RLF_API rlf_result rlf_png_write_u16(const char *path, const uint16_t *data, int32_t width,
                                     int32_t height);

/* ---- arrays and meshes
 * ------------------------------------------------------------------------------ */

/* What the numbers of an array are. */
typedef enum rlf_npy_type { RLF_NPY_F32 = 0, RLF_NPY_I32 = 1, RLF_NPY_U8 = 2 } rlf_npy_type;

/* Writes a NumPy 1.0 file, C order, little endian. rank 1..4. */
RLF_API rlf_result rlf_npy_write(const char *path, rlf_npy_type type, const void *data,
                                 const int64_t *shape, int32_t rank);
/* Binary PLY of the surface's points with normals, and its triangles when index_count > 0. */
RLF_API rlf_result rlf_ply_write(const char *path, const rlf_surface *surface,
                                 const uint32_t *indices, size_t index_count);
/* As above, the points of one region of the front sheet only. */
RLF_API rlf_result rlf_ply_write_region(const char *path, const rlf_surface *surface,
                                        const rlf_region *region, const uint32_t *indices,
                                        size_t index_count);

/* ---- maps of rooms
 * ------------------------------------------------------------------------------------------- */

/* Writes a map of a room as a file (docs/moving-camera.md has the layout). */
RLF_API rlf_result rlf_map_write_file(const rlf_map *map, const char *path);
/* Replaces what a map holds by a file's. What is wrong with the file is told; the map is then
 * empty. */
RLF_API rlf_result rlf_map_read_file(rlf_map *map, const char *path);
/* Whether a mesh can be written under that name: it ends with .ply, .obj or .glb. */
RLF_API rlf_result rlf_map_mesh_check_name(const char *path);
/* Writes a mesh with normals and colours, by its name: .ply (binary), .obj (colours after the
 * places, as most programs read them), .glb (glTF 2.0, turned half round x, so that y is up). */
RLF_API rlf_result rlf_map_mesh_write(const char *path, const rlf_map_mesh *mesh);

/* ---- video
 * ------------------------------------------------------------------------------------------ */

/* A video that is being written. One thread at a time. */
typedef struct rlf_video rlf_video;

/* Opens a video by its name: .mp4 (H.264, needs the libav packages), .y4m, "-" for Y4M on stdout.
 * Odd sizes are padded by one pixel. frames_per_second > 0. */
RLF_API rlf_result rlf_video_open(const char *path, int32_t width, int32_t height,
                                  double frames_per_second, rlf_video **out);
/* Appends a picture of the video's size. RLF_ERROR_INVALID for another size, RLF_ERROR_IO. */
RLF_API rlf_result rlf_video_write(rlf_video *video, const rlf_image_rgba8 *image);
/* Finishes the file; the pointer is nulled even when it fails. NULL is allowed. */
RLF_API rlf_result rlf_video_close(rlf_video **video);

/* ---- logs
 * ------------------------------------------------------------------------------------------- */

/* CSV files that are being written. One thread at a time. */
typedef struct rlf_csv_log rlf_csv_log;

/* Makes frames.csv, bodies.csv and contacts.csv in a folder (made if missing). */
RLF_API rlf_result rlf_csv_log_open(const char *folder, rlf_csv_log **out);
/* Appends a frame to all files. */
RLF_API rlf_result rlf_csv_log_write(rlf_csv_log *log, const rlf_pipeline_output *output);
/* Flushes and closes; reports a disk that filled. The pointer is nulled even when it fails. NULL is
 * allowed. */
RLF_API rlf_result rlf_csv_log_close(rlf_csv_log **log);

/* Makes a folder and its parents. RLF_OK when it is there already. */
RLF_API rlf_result rlf_make_folder(const char *path);

/* Writes `size` bytes as a whole file: RLF_ERROR_IO and nothing left behind when the disk is full
 * or the path cannot be written. A device or pipe is written directly. */
RLF_API rlf_result rlf_file_write(const char *path, const void *data, size_t size);
/* Tells before the work whether rlf_file_write could start: RLF_OK, or the error. Leaves the path
 * as it is. */
RLF_API rlf_result rlf_file_check(const char *path);

#ifdef __cplusplus
}
#endif
#endif
