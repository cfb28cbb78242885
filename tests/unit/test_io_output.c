/* Arrays, meshes, logs and folders that are written, and disks that are full. */
#define _POSIX_C_SOURCE 200809L

#include "io/file.h"
#include "io_support.h"
#include "relief/io.h"
#include "test.h"

#include <signal.h>
#include <sys/resource.h>

TEST_CASE(npy_has_an_aligned_header_and_the_data)
{
    const float values[2 * 3] = {0.0F, 1.5F, -2.0F, 3e-20F, 1e20F, 0.1F};
    const int64_t shape[2] = {2, 3};
    assert_int_equal(rlf_npy_write(test_path("a.npy"), RLF_NPY_F32, values, shape, 2), RLF_OK);
    size_t size;
    char *file = test_read(test_path("a.npy"), &size);
    assert_memory_equal(file, "\x93NUMPY\x01\x00", 8);
    size_t header = (size_t)(uint8_t)file[8] + 256 * (size_t)(uint8_t)file[9] + 10;
    assert_int_equal(header % 64, 0);
    assert_int_equal(file[header - 1], '\n');
    const char *dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3,), }";
    assert_memory_equal(file + 10, dict, strlen(dict));
    for (size_t i = 10 + strlen(dict); i < header - 1; i++) {
        assert_int_equal(file[i], ' ');
    }
    assert_int_equal(size, header + sizeof(values));
    assert_memory_equal(file + header, values, sizeof(values));
    free(file);
}

TEST_CASE(npy_types_and_ranks)
{
    const int32_t integers[4] = {1, -2, 3, 4};
    const int64_t line[1] = {4};
    const int64_t block[4] = {1, 2, 2, 1};
    size_t size;
    assert_int_equal(rlf_npy_write(test_path("i.npy"), RLF_NPY_I32, integers, line, 1), RLF_OK);
    char *file = test_read(test_path("i.npy"), &size);
    assert_non_null(strstr(file + 10, "'<i4'"));
    assert_non_null(strstr(file + 10, "(4,)"));
    assert_memory_equal(file + size - 16, integers, 16);
    free(file);
    assert_int_equal(rlf_npy_write(test_path("u.npy"), RLF_NPY_U8, "\1\2\3\4", block, 4), RLF_OK);
    file = test_read(test_path("u.npy"), &size);
    assert_non_null(strstr(file + 10, "'|u1'"));
    assert_non_null(strstr(file + 10, "(1, 2, 2, 1,)"));
    assert_memory_equal(file + size - 4, "\1\2\3\4", 4);
    free(file);
}

/* A 2 x 2 surface whose last point is missing. */
static rlf_surface small_surface(void)
{
    static const float depth[4] = {1, 2, 3, 0};
    static const float ray[4] = {0, 0.5F, -0.5F, 0};
    static const float normal[4] = {0, 0, 0, 0};
    static const float normal_z[4] = {-1, -1, -1, 0};
    rlf_surface s = {.width = 2,
                     .height = 2,
                     .depth = depth,
                     .ray_x = ray,
                     .ray_y = ray,
                     .normal_x = normal,
                     .normal_y = normal,
                     .normal_z = normal_z,
                     .valid_count = 3,
                     .foreground_count = 2,
                     .region_count = 5};
    return s;
}

TEST_CASE(ply_holds_valid_points_and_whole_triangles)
{
    rlf_surface surface = small_surface();
    const uint32_t indices[6] = {0, 1, 2, 1, 3, 2};
    assert_int_equal(rlf_ply_write(test_path("s.ply"), &surface, indices, 6), RLF_OK);
    size_t size;
    char *file = test_read(test_path("s.ply"), &size);
    assert_memory_equal(file, "ply\nformat binary_little_endian 1.0\n", 36);
    assert_non_null(strstr(file, "element vertex 3\n"));
    assert_non_null(strstr(file, "element face 1\nproperty list uchar int vertex_indices\n"));
    char *data = strstr(file, "end_header\n") + 11;
    assert_int_equal(size - (size_t)(data - file), 3 * 24 + 13);
    float vertices[3][6];
    memcpy(vertices, data, sizeof(vertices));
    const float expected[3][6] = {
        {0, 0, 1, 0, 0, -1}, {1, 1, 2, 0, 0, -1}, {-1.5F, -1.5F, 3, 0, 0, -1}};
    assert_memory_equal(vertices, expected, sizeof(expected));
    int32_t face[3];
    assert_int_equal(data[72], 3);
    memcpy(face, data + 73, sizeof(face));
    assert_true(face[0] == 0 && face[1] == 1 && face[2] == 2);
    free(file);
}

static rlf_pipeline_output sample_output(rlf_surface *surface, rlf_snapshot *snapshot)
{
    static rlf_body_state bodies[2] = {
        {.id = {1, 1}, .name = "a,b\"c", .T_world_body = {{1, 2, 3}, {0, 0, 0, 1}}},
        {.id = {2, 1}, .name = "ball", .velocity = {0.1, 0, 0}}};
    static rlf_contact contacts[3] = {
        {.body = {2, 1}, .other = RLF_CONTACT_BODY, .other_body = {1, 1}, .separation = -0.001},
        {.body = {2, 1}, .other = RLF_CONTACT_FOREGROUND, .impulse = 0.5, .surface_speed = 2},
        {.body = {9, 1}, .other = RLF_CONTACT_BACKGROUND, .normal = {0, -1, 0}}};
    static const rlf_hands hands = {.count = 2,
                                    .hand = {{.id = 3, .confidence = 0.4},
                                             {.id = 4,
                                              .side = RLF_HAND_RIGHT,
                                              .confidence = 0.9,
                                              .palm = {1, 2, 3},
                                              .velocity = {0, 0, 0.5},
                                              .gesture = RLF_GESTURE_PINCH,
                                              .holding = 2 | UINT64_C(1) << 32}}};
    *surface = small_surface();
    *snapshot =
        (rlf_snapshot){.bodies = bodies, .body_count = 2, .contacts = contacts, .contact_count = 3};
    rlf_pipeline_output output = {.frame_index = 7,
                                  .time_s = 1.0 / 3.0,
                                  .surface = surface,
                                  .T_world_camera = {{0, 0, 1}, {0, 0, 0, 1}},
                                  .hands = &hands,
                                  .snapshot = snapshot,
                                  .times = {1, 2.5, 3, 4}};
    return output;
}

TEST_CASE(logs_have_the_fixed_columns)
{
    rlf_surface surface;
    rlf_snapshot snapshot;
    rlf_pipeline_output output = sample_output(&surface, &snapshot);
    rlf_csv_log *log = NULL;
    assert_int_equal(rlf_csv_log_open(test_path("log/deep"), &log), RLF_OK);
    uint64_t before = rlf_alloc_count();
    assert_int_equal(rlf_csv_log_write(log, &output), RLF_OK);
    assert_int_equal(rlf_alloc_count(), before);
    assert_false(test_exists(test_path("log/deep/frames.csv")));
    assert_int_equal(rlf_csv_log_close(&log), RLF_OK);
    assert_null(log);
    const struct {
        const char *name, *text;
    } files[4] = {
        {"log/deep/frames.csv", "frame,time_s,valid,missing,foreground,regions,capture_ms,"
                                "surface_ms,physics_ms,render_ms\n"
                                "7,0.333333333,3,1,2,5,1,2.5,3,4\n"},
        {"log/deep/bodies.csv", "frame,time_s,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n"
                                "7,0.333333333,\"a,b\"\"c\",1,2,3,0,0,0,1,0,0,0,0,0,0\n"
                                "7,0.333333333,ball,0,0,0,0,0,0,0,0.1,0,0,0,0,0\n"},
        {"log/deep/contacts.csv",
         "frame,time_s,body,other,px,py,pz,nx,ny,nz,separation,impulse,surface_speed\n"
         "7,0.333333333,ball,\"a,b\"\"c\",0,0,0,0,0,0,-0.001,0,0\n"
         "7,0.333333333,ball,foreground,0,0,0,0,0,0,0,0.5,2\n"
         "7,0.333333333,removed,background,0,0,0,0,-1,0,0,0,0\n"},
        {"log/deep/hands.csv", "frame,time_s,hand,side,px,py,pz,vx,vy,vz,gesture,pinch_m,holding,"
                               "confidence\n"
                               "7,0.333333333,4,right,1,2,4,0,0,0.5,pinch,0,ball,0.9\n"},
    };
    for (int i = 0; i < 4; i++) {
        size_t size;
        char *text = test_read(test_path(files[i].name), &size);
        assert_string_equal(text, files[i].text);
        free(text);
    }
}

TEST_CASE(numbers_have_a_decimal_point)
{
    char text[IO_NUMBER_SIZE];
    io_number_format(-1.0 / 3.0, text);
    assert_string_equal(text, "-0.333333333");
    io_number_format(1e300, text);
    assert_string_equal(text, "1e+300");
    double x;
    assert_true(io_number_parse("-1.5e3", &x) && x == -1500);
    assert_true(io_number_parse(".5", &x) && x == 0.5);
    const char *const wrong[] = {"", "nan", "inf", "0x10", "1,5", "1.5.2", "1e999", "1 ", "."};
    for (size_t i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
        assert_false(io_number_parse(wrong[i], &x));
    }
}

/* Writes about 100 kB of one kind to `path`. */
static rlf_result write_kind(int kind, const char *path)
{
    static uint8_t pixels[160 * 160 * 4];
    uint32_t noise = 1; /* so that nothing can be compressed below the limits used here */
    for (size_t i = 0; i < sizeof(pixels); i++) {
        noise = noise * 1664525u + 1013904223u;
        pixels[i] = (uint8_t)(noise >> 24);
    }
    rlf_image_rgba8 image = {pixels, 160, 160, 640};
    const int64_t shape[1] = {sizeof(pixels)};
    if (kind == 0) {
        return rlf_npy_write(path, RLF_NPY_U8, pixels, shape, 1);
    }
    if (kind == 1) {
        return rlf_png_write_rgba(path, &image);
    }
    rlf_video *video = NULL;
    rlf_result result = rlf_video_open(path, 160, 160, 30, &video);
    for (int i = 0; i < 3 && result == RLF_OK; i++) {
        result = rlf_video_write(video, &image);
    }
    rlf_result closed = rlf_video_close(&video);
    assert_null(video);
    return result != RLF_OK ? result : closed;
}

static const char *const kind_names[] = {"f.npy", "f.png", "f.y4m",
#ifdef RLF_HAVE_LIBAV
                                         "f.mp4"
#endif
};
#define KINDS ((int)(sizeof(kind_names) / sizeof(kind_names[0])))

/* Whether something that was being written is left in the folder. */
static bool has_part(void)
{
    DIR *folder = opendir(test_folder);
    assert_non_null(folder);
    bool is_found = false;
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        is_found = is_found || strstr(entry->d_name, ".part") != NULL;
    }
    closedir(folder);
    return is_found;
}

/* A limit on file sizes fails in the middle of a file like a disk that fills. */
TEST_CASE(full_disk_leaves_the_old_file_alone)
{
    struct rlimit old;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_IGN);
    for (int kind = 0; kind < KINDS; kind++) {
        test_write_text(kind_names[kind], "old");
        struct rlimit small = {.rlim_cur = 5000, .rlim_max = old.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        rlf_result result = write_kind(kind, test_path(kind_names[kind]));
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        test_expect_error(result, RLF_ERROR_IO, kind_names[kind], "File too large", "");
        assert_false(has_part());
        size_t size;
        char *text = test_read(test_path(kind_names[kind]), &size);
        assert_string_equal(text, "old");
        free(text);
        assert_int_equal(write_kind(kind, test_path(kind_names[kind])), RLF_OK);
        assert_false(has_part());
    }
}

TEST_CASE(full_device_is_reported)
{
    if (!test_exists("/dev/full")) {
        print_message("SKIPPED: no /dev/full\n");
        skip();
    }
    test_expect_error(write_kind(0, "/dev/full"), RLF_ERROR_IO, "/dev/full", "No space left",
                      "free some space");
    test_expect_error(write_kind(1, "/dev/full"), RLF_ERROR_IO, "/dev/full", "No space left",
                      "free some space");
    assert_true(test_exists("/dev/full"));
}

TEST_CASE(full_disk_fails_the_log)
{
    rlf_surface surface;
    rlf_snapshot snapshot;
    rlf_pipeline_output output = sample_output(&surface, &snapshot);
    rlf_csv_log *log = NULL;
    assert_int_equal(rlf_make_folder(test_path("full")), RLF_OK);
    test_write_text("full/frames.csv", "old");
    test_write_text("full/contacts.csv", "old");
    assert_int_equal(rlf_csv_log_open(test_path("full"), &log), RLF_OK);
    struct rlimit old;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_IGN);
    /* Enough for the first file and not for the last: all three stay as they were. */
    struct rlimit small = {.rlim_cur = 160, .rlim_max = old.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    rlf_csv_log_write(log, &output); /* buffered: closing is what must notice */
    rlf_result result = rlf_csv_log_close(&log);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
    test_expect_error(result, RLF_ERROR_IO, "contacts.csv", "File too large", "free some space");
    assert_null(log);
    for (int i = 0; i < 2; i++) {
        size_t size;
        char *text = test_read(test_path(i == 0 ? "full/frames.csv" : "full/contacts.csv"), &size);
        assert_string_equal(text, "old");
        free(text);
    }
    assert_false(test_exists(test_path("full/bodies.csv")));
}

TEST_CASE(unwritable_places_are_named)
{
    test_write_text("plain", "x");
    rlf_csv_log *log = NULL;
    for (int kind = 0; kind < KINDS; kind++) {
        char name[64];
        snprintf(name, sizeof(name), "plain/%s", kind_names[kind]);
        test_expect_error(write_kind(kind, test_path(name)), RLF_ERROR_IO, name,
                          "cannot be created", "choose a folder");
        snprintf(name, sizeof(name), "dir%d%s", kind, kind_names[kind] + 1);
        assert_int_equal(rlf_make_folder(test_path(name)), RLF_OK);
        test_expect_error(write_kind(kind, test_path(name)), RLF_ERROR_IO, name, "is a folder",
                          "name of a file");
    }
    test_expect_error(rlf_csv_log_open(test_path("plain/log"), &log), RLF_ERROR_IO, "plain",
                      "cannot be made", "choose a place");
    assert_null(log);
    rlf_video *video = NULL;
    test_expect_error(rlf_video_open(test_path("film.avi"), 8, 8, 30, &video), RLF_ERROR_INVALID,
                      "film.avi", "not a known kind", ".mp4 or .y4m");
    test_expect_error(rlf_video_open(test_path("f.y4m"), 8, 8, 0.0 / 1.0, &video),
                      RLF_ERROR_INVALID, "f.y4m", "0 frames per second", "use");
}

TEST_CASE(folders_are_made_with_their_parents)
{
    assert_int_equal(rlf_make_folder(test_path("p/q//r/")), RLF_OK);
    assert_true(test_exists(test_path("p/q/r")));
    assert_int_equal(rlf_make_folder(test_path("p/q/r")), RLF_OK);
    assert_int_equal(rlf_make_folder("/"), RLF_OK);
    assert_int_equal(rlf_make_folder("."), RLF_OK);
    test_write_text("p/file", "x");
    test_expect_error(rlf_make_folder(test_path("p/file")), RLF_ERROR_IO, "p/file",
                      "a file of that name", "choose a place");
    test_expect_error(rlf_make_folder(test_path("p/file/x")), RLF_ERROR_IO, "p/file", NULL,
                      "choose a place");
    test_expect_error(rlf_make_folder(""), RLF_ERROR_INVALID, "\"\"", "not a usable", "give");
}

/* A file is there whole or as it was; a check changes nothing. */
TEST_CASE(bytes_are_written_whole)
{
    assert_int_equal(rlf_file_check(test_path("bytes")), RLF_OK);
    assert_false(test_exists(test_path("bytes")));
    assert_false(has_part());
    assert_int_equal(rlf_file_write(test_path("bytes"), "old", 3), RLF_OK);
    assert_int_equal(rlf_file_check(test_path("bytes")), RLF_OK);
    size_t size;
    char *text = test_read(test_path("bytes"), &size);
    assert_int_equal(size, 3);
    assert_memory_equal(text, "old", 3);
    free(text);
    assert_int_equal(rlf_file_write(test_path("bytes"), "", 0), RLF_OK);
    test_expect_error(rlf_file_check(test_path("no/bytes")), RLF_ERROR_IO, "no/bytes",
                      "cannot be created", "choose a folder");
    test_expect_error(rlf_file_write(test_path("no/bytes"), "x", 1), RLF_ERROR_IO, "no/bytes",
                      "cannot be created", "choose a folder");
    assert_int_equal(rlf_file_check("/dev/null"), RLF_OK);
    assert_int_equal(rlf_file_write("/dev/null", "x", 1), RLF_OK);
}

TEST_GROUP(test_folder_make, test_folder_remove)
