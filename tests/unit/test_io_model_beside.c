/* Which other files a model may name: those in its folder or below. */
#define _XOPEN_SOURCE 700

#include "test.h"

#include <sys/stat.h>
#include <unistd.h>

#include "relief/io.h"
#include "io_support.h"
#include "model_file.h"

static model_text text;
static char warning[1024];
static int warning_count;

static void keep_warning(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    if (level == RLF_LOG_WARNING) {
        warning_count++;
        snprintf(warning, sizeof(warning), "%s", line);
    }
}

static int set_up(void **state)
{
    warning_count = 0;
    rlf_set_log(keep_warning, NULL);
    return test_folder_make(state);
}

static void fail_load(const char *name, rlf_result code, const char *piece)
{
    rlf_model *model = NULL;
    test_expect_error(rlf_model_load(test_path(name), &model), code, name, piece, NULL);
    assert_null(model);
}

static void write_paint(int32_t width, int32_t height)
{
    uint8_t *pixels = calloc((size_t)width * (size_t)height, 4);
    for (int32_t i = 0; i < width * height; i++) {
        pixels[4 * i] = (uint8_t)(i % width * 255 / width);
        pixels[4 * i + 1] = 200;
        pixels[4 * i + 3] = 255;
    }
    rlf_image_rgba8 image = {pixels, width, height, 4 * (ptrdiff_t)width};
    assert_int_equal(rlf_png_write_rgba(test_path("paint.png"), &image), RLF_OK);
    free(pixels);
}

/* A triangle whose corners are in a file of that name. */
static void write_buffer_user(const char *name, const char *uri)
{
    char json[1024];
    snprintf(json, sizeof(json),
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
             "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
             "{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
             "\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
             "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
             uri);
    test_write_text(name, json);
}

static void make_folders(void)
{
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    assert_int_equal(mkdir(test_path("in"), 0755), 0);
    assert_int_equal(mkdir(test_path("in/deep"), 0755), 0);
    assert_int_equal(mkdir(test_path("inside"), 0755), 0); /* begins as the folder's name does */
    test_write("in/deep/corners.bin", corners, sizeof(corners));
    test_write("secret.bin", corners, sizeof(corners));
    test_write("inside/secret.bin", corners, sizeof(corners));
    assert_int_equal(symlink("../secret.bin", test_path("in/link.bin")), 0);
    assert_int_equal(symlink("..", test_path("in/up")), 0);
    assert_int_equal(symlink("deep/corners.bin", test_path("in/alias.bin")), 0);
}

/* Whoever made a model may not have files read that are elsewhere. */
TEST_CASE(buffers_are_read_from_the_folder_only)
{
    make_folders();
    char *whole = realpath(test_path("secret.bin"), NULL);
    assert_non_null(whole);
    const char *const outside[] = {"../secret.bin", "deep/../../secret.bin", "link.bin",
                                   "../inside/secret.bin", "up/secret.bin"};
    for (size_t i = 0; i < sizeof(outside) / sizeof(outside[0]); i++) {
        write_buffer_user("in/model.gltf", outside[i]);
        fail_load("in/model.gltf", RLF_ERROR_UNSUPPORTED, "outside of the model's folder");
    }
    /* These are no names of what is there; what they stand for is not read either. */
    char uri[600];
    snprintf(uri, sizeof(uri), "file://%s", whole);
    const char *const nothing[] = {"%2e%2e/secret.bin", "..%2fsecret.bin", "..\\\\secret.bin", uri,
                                   whole};
    for (size_t i = 0; i < sizeof(nothing) / sizeof(nothing[0]); i++) {
        rlf_model *model = NULL;
        write_buffer_user("in/model.gltf", nothing[i]);
        assert_int_not_equal(rlf_model_load(test_path("in/model.gltf"), &model), RLF_OK);
        assert_null(model);
    }
    const char *const inside[] = {"deep/corners.bin", "deep/../deep/corners.bin", "alias.bin"};
    for (size_t i = 0; i < sizeof(inside) / sizeof(inside[0]); i++) {
        rlf_model *model = NULL;
        write_buffer_user("in/model.gltf", inside[i]);
        if (rlf_model_load(test_path("in/model.gltf"), &model) != RLF_OK) {
            fail_msg("%s: %s", inside[i], rlf_error_text());
        }
        rlf_model_destroy(&model);
    }
    assert_int_equal(warning_count, 0);
    free(whole);
}

static void load_textured(const char *uri, int32_t textures)
{
    char images[600];
    model_options o = model_textured;
    rlf_model *model = NULL;
    snprintf(images, sizeof(images), "\"images\":[{\"uri\":\"%s\"}],\"textures\":[{\"source\":0}],",
             uri);
    o.images = images;
    model_write(&text, &o);
    test_write("in/model.gltf", text.text, text.length);
    warning_count = 0;
    assert_int_equal(rlf_model_load(test_path("in/model.gltf"), &model), RLF_OK);
    assert_int_equal(model->texture_count, textures);
    assert_int_equal(warning_count, 1 - textures);
    rlf_model_destroy(&model);
}

TEST_CASE(textures_are_read_from_the_folder_only)
{
    make_folders();
    write_paint(4, 4);
    char *whole = realpath(test_path("paint.png"), NULL);
    assert_non_null(whole);
    const char *const outside[] = {"../paint.png", "up/paint.png", whole};
    for (size_t i = 0; i < sizeof(outside) / sizeof(outside[0]); i++) {
        load_textured(outside[i], 0);
        assert_non_null(strstr(warning, "outside of the model's folder"));
    }
    assert_int_equal(rename(whole, test_path("in/deep/paint.png")), 0);
    free(whole);
    load_textured("deep/paint.png", 1);
}

/* The library of materials and its textures. */
TEST_CASE(materials_are_read_from_the_folder_only)
{
    make_folders();
    test_write_text("secret.mtl", "newmtl m\nKd 0.25 0.5 0.75\n");
    char *whole = realpath(test_path("secret.mtl"), NULL);
    assert_non_null(whole);
    const char *const outside[] = {"../secret.mtl", "up/secret.mtl", "deep/../../secret.mtl",
                                   whole};
    for (size_t i = 0; i < sizeof(outside) / sizeof(outside[0]); i++) {
        char obj[600];
        rlf_model *model = NULL;
        snprintf(obj, sizeof(obj), "mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
                 outside[i]);
        test_write_text("in/model.obj", obj);
        if (outside[i] != whole) {
            fail_load("in/model.obj", RLF_ERROR_UNSUPPORTED, "outside of the model's folder");
        } else if (rlf_model_load(test_path("in/model.obj"), &model) == RLF_OK) {
            assert_true(model->parts[0].color[2] != 0.75f); /* looked for below, not there */
        }
        rlf_model_destroy(&model);
    }
    assert_int_equal(rename(whole, test_path("in/deep/secret.mtl")), 0);
    free(whole);
    rlf_model *model = NULL;
    test_write_text("in/model.obj", "mtllib deep/secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                    "usemtl m\nf 1 2 3\n");
    assert_int_equal(rlf_model_load(test_path("in/model.obj"), &model), RLF_OK);
    assert_true(model->parts[0].color[2] > 0.7f);
    rlf_model_destroy(&model);
}

TEST_EACH(set_up, test_folder_remove)
