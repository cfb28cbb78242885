/* Models from files: what is read, and what is wrong with a file in one line. */
#define _POSIX_C_SOURCE 200809L

#include "test.h"

#include <math.h>
#include <unistd.h>

#include "relief/io.h"
#include "io/picture/picture.h"
#include "io/scene/reader.h"
#include "io/scene/pattern.h"
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

static rlf_model *load(const model_options *options)
{
    rlf_model *model = NULL;
    model_write(&text, options);
    test_write("box.gltf", text.text, text.length);
    if (rlf_model_load(test_path("box.gltf"), &model) != RLF_OK) {
        fail_msg("%s", rlf_error_text());
    }
    return model;
}

static void fail_load(const char *name, rlf_result code, const char *piece)
{
    rlf_model *model = NULL;
    test_expect_error(rlf_model_load(test_path(name), &model), code, name, piece, NULL);
    assert_null(model);
}

static bool is_near(double a, double b)
{
    return a - b < 1e-9 && b - a < 1e-9;
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

/* y up becomes y down, by half a turn about x. */
TEST_CASE(gltf_stands_upright)
{
    rlf_model *model = load(&model_plain);
    assert_int_equal(model->triangle_count, 12);
    assert_int_equal(model->part_count, 1);
    assert_int_equal(model->parts[0].texture, -1);
    assert_true(model->box.min.x == -0.5 && model->box.max.x == 0.5);
    assert_true(model->box.min.y == -1.0 && model->box.max.y == 1.0);
    assert_true(model->box.min.z == -3.0 && model->box.max.z == 0.0);
    double volume = 0.0;
    for (int32_t i = 0; i < 3 * model->triangle_count; i += 3) {
        rlf_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            const rlf_model_vertex *v = &model->vertices[model->triangles[i + k]];
            p[k] = rlf_vec3_make((double)v->position[0], (double)v->position[1],
                                 (double)v->position[2]);
            rlf_vec3 n =
                rlf_vec3_make((double)v->normal[0], (double)v->normal[1], (double)v->normal[2]);
            rlf_vec3 middle = rlf_vec3_make(0, 0, -1.5);
            assert_true(rlf_dot(n, n) > 0.999 && rlf_dot(n, n) < 1.001);
            assert_true(rlf_dot(n, rlf_sub(p[k], middle)) > 0.0);
        }
        volume += rlf_dot(p[0], rlf_cross(p[1], p[2])) / 6.0;
    }
    assert_true(volume > 5.999 && volume < 6.001);
    rlf_model_destroy(&model);
    assert_null(model);
    assert_int_equal(warning_count, 0);
}

/* A mirrored node turns triangles round; scale and place are taken. */
TEST_CASE(nodes_place_meshes)
{
    model_options o = model_plain;
    o.node = ",\"scale\":[-2,1,1],\"translation\":[10,0,0]";
    rlf_model *model = load(&o);
    assert_true(model->box.min.x == 9.0 && model->box.max.x == 11.0);
    rlf_vec3 middle = rlf_vec3_make(10, 0, -1.5);
    for (int32_t i = 0; i < 3 * model->triangle_count; i += 3) {
        rlf_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            const float *v = model->vertices[model->triangles[i + k]].position;
            p[k] = rlf_sub(rlf_vec3_make((double)v[0], (double)v[1], (double)v[2]), middle);
        }
        assert_true(rlf_dot(p[0], rlf_cross(p[1], p[2])) > 0.0);
    }
    rlf_model_destroy(&model);
}

TEST_CASE(texture_and_color_are_read)
{
    write_paint(100, 20); /* becomes 128 x 16 */
    rlf_model *model = load(&model_textured);
    assert_int_equal(warning_count, 0);
    assert_int_equal(model->texture_count, 1);
    const rlf_model_texture *t = &model->textures[0];
    assert_int_equal(t->width, 128);
    assert_int_equal(t->height, 16);
    assert_int_equal(t->level_count, 8);
    assert_int_equal(t->texels[1], 200);
    assert_true(t->texels[4 * 127] > 245 && t->texels[0] < 8);
    int32_t w, h;
    size_t last = rlf_model_texture_level(t, 7, &w, &h);
    assert_true(w == 1 && h == 1 && t->texels[last + 1] == 200);
    const rlf_model_part *part = &model->parts[0];
    assert_int_equal(part->texture, 0);
    assert_true(part->color[0] == 1.0f && part->color[2] == 0.0f);
    assert_true(part->color[1] > 0.734f && part->color[1] < 0.736f); /* sRGB of 0.5 */
    rlf_model_destroy(&model);
}

TEST_CASE(metal_roughness_and_normals_are_read)
{
    write_paint(16, 16);
    model_options o = model_textured;
    o.material =
        "{\"normalTexture\":{\"index\":0},\"pbrMetallicRoughness\":{\"metallicFactor\":0.5,"
        "\"metallicRoughnessTexture\":{\"index\":0}}}";
    rlf_model *model = load(&o);
    const rlf_model_part *part = &model->parts[0];
    assert_int_equal(model->texture_count, 1);
    assert_true(part->texture == -1 && part->surface_texture == 1 && part->normal_texture == 1);
    assert_true(part->metallic == 0.5f && part->gloss == 0.0f);
    assert_true(model->vertices[2].uv[0] == 1.0f);
    rlf_model_destroy(&model);
    remove(test_path("paint.png")); /* a surface that cannot be had is taken for paint */
    model = load(&o);
    part = &model->parts[0];
    assert_true(part->surface_texture == 0 && part->metallic == 0.0f && part->gloss == 0.5f);
    rlf_model_destroy(&model);
}

TEST_CASE(two_sided_faces_are_there_twice)
{
    model_options o = model_plain;
    o.material = "{\"doubleSided\":true}";
    rlf_model *model = load(&o);
    assert_int_equal(model->triangle_count, 24);
    rlf_model_destroy(&model);
}

TEST_CASE(obj_is_taken_as_it_is)
{
    write_paint(8, 8);
    test_write_text("flag.mtl", "newmtl cloth\nKd 1 0.5 0.25\nmap_Kd paint.png\n");
    test_write_text("flag.obj", "mtllib flag.mtl\nusemtl cloth\nv 0 0 0\nv 1 0 0\nv 1 2 0\n"
                                "v 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_load(test_path("flag.obj"), &model), RLF_OK);
    assert_int_equal(model->triangle_count, 2);
    assert_true(model->box.max.y == 2.0 && model->box.max.z == 0.0);
    assert_int_equal(model->parts[0].texture, 0);
    assert_true(model->parts[0].color[1] == 0.5f);
    for (int32_t i = 0; i < model->vertex_count; i++) {
        const rlf_model_vertex *v = &model->vertices[i];
        assert_true(v->normal[2] == 1.0f);
        assert_true(v->uv[1] == 1.0f - 0.5f * v->position[1]); /* rows go down */
    }
    rlf_model_destroy(&model);
}

TEST_CASE(missing_texture_is_one_warning)
{
    rlf_model *model = load(&model_textured);
    assert_int_equal(warning_count, 1);
    assert_non_null(strstr(warning, "box.gltf"));
    assert_non_null(strstr(warning, "paint.png"));
    assert_int_equal(model->parts[0].texture, -1);
    assert_int_equal(model->texture_count, 0);
    assert_true(model->parts[0].color[1] < 0.736f);
    rlf_model_destroy(&model);
}

TEST_CASE(huge_or_broken_texture_is_one_warning)
{
    write_paint(RLF_MODEL_IMAGE_MAX + 1, 1);
    rlf_model *model = load(&model_textured);
    assert_int_equal(warning_count, 1);
    assert_non_null(strstr(warning, "8193 x 1"));
    rlf_model_destroy(&model);
    test_write_text("paint.png", "no picture");
    model = load(&model_textured);
    assert_int_equal(warning_count, 2);
    assert_int_equal(model->texture_count, 0);
    rlf_model_destroy(&model);
}

TEST_CASE(bad_files_fail_in_one_line)
{
    fail_load("none.gltf", RLF_ERROR_IO, "check the name");
    test_write_text("model.fbx", "x");
    fail_load("model.fbx", RLF_ERROR_UNSUPPORTED, ".gltf, .glb or .obj");
    test_write_text("empty.glb", "");
    fail_load("empty.glb", RLF_ERROR_FORMAT, "is empty");
    model_options points = model_plain;
    points.mode = 0;
    model_write(&text, &points);
    test_write("points.gltf", text.text, text.length);
    fail_load("points.gltf", RLF_ERROR_INVALID, "no triangles");
    test_write_text("no.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    fail_load("no.obj", RLF_ERROR_FORMAT, "");
    test_write_text("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fail_load("nan.obj", RLF_ERROR_FORMAT, "vertex");
}

TEST_CASE(bad_numbers_name_the_vertex)
{
    model_options o = model_plain;
    o.first_x = NAN;
    model_write(&text, &o);
    test_write("nan.gltf", text.text, text.length);
    fail_load("nan.gltf", RLF_ERROR_FORMAT, "vertex");
    o.first_x = INFINITY;
    model_write(&text, &o);
    test_write("inf.gltf", text.text, text.length);
    fail_load("inf.gltf", RLF_ERROR_FORMAT, "vertex");
}

/* Cut anywhere it is an error or, where only blanks are missing, the model. */
TEST_CASE(truncated_gltf_fails)
{
    model_write(&text, &model_plain);
    size_t whole = text.length;
    for (size_t size = 1; size + 2 < whole; size += 41) {
        test_write("cut.gltf", text.text, size);
        fail_load("cut.gltf", RLF_ERROR_FORMAT, "export it again");
    }
}

/* A file made of a text that is there many times. */
static void write_repeated(const char *name, const char *head, const char *piece, int count,
                           const char *tail)
{
    FILE *file = fopen(test_path(name), "wb");
    assert_non_null(file);
    fputs(head, file);
    for (int i = 0; i < count; i++) {
        fprintf(file, piece, i + 1, i + 1);
    }
    fputs(tail, file);
    assert_int_equal(fclose(file), 0);
}

#define ASSET "{\"asset\":{\"version\":\"2.0\"},"
#define ROOT ASSET "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["

/* What would take all memory or the stack is refused before it is read: each in no time. */
TEST_CASE(bombs_are_refused)
{
    alarm(60);
    write_repeated("twice.gltf", ROOT, "{\"children\":[%d,%d]},", 40, "{}]}");
    fail_load("twice.gltf", RLF_ERROR_FORMAT, "more than one parent");
    write_repeated("chain.gltf", ROOT, "{\"children\":[%d]},", 20000, "{}]}");
    fail_load("chain.gltf", RLF_ERROR_FORMAT, "nested more than 256 deep");
    write_repeated("circle.gltf", ROOT, "{\"children\":[%d]},", 3, "{\"children\":[0]}]}");
    fail_load("circle.gltf", RLF_ERROR_FORMAT, "more than one parent");
    write_repeated("roots.gltf", ASSET "\"nodes\":[{}],\"scenes\":[{\"nodes\":[0", ",0", 9, "]}]}");
    fail_load("roots.gltf", RLF_ERROR_FORMAT, "in a scene more than once");
    write_repeated("deep.gltf", ASSET "\"x\":", "[", 200000, "");
    fail_load("deep.gltf", RLF_ERROR_FORMAT, "export it again");
    write_repeated("wide.gltf", ASSET "\"x\":[0", ",0", 2000000, "]}");
    fail_load("wide.gltf", RLF_ERROR_FORMAT, "too many values");
#define DATA                                                                                       \
    "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"buffers\":[{\"byteLength\":9,"        \
    "\"uri\":"                                                                                     \
    "\"data:;base64,AAAAAAAAAAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":9}],"
    write_repeated("meshes.gltf",
                   ASSET DATA "\"accessors\":[{\"bufferView\":0,\"componentType\":5121,\"count\":3,"
                              "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{}",
                   ",{\"attributes\":{\"POSITION\":0}}", 70000, "]}]}");
    fail_load("meshes.gltf", RLF_ERROR_FORMAT, "65536 meshes");
    write_repeated("count.gltf",
                   ASSET DATA "\"accessors\":[{\"bufferView\":0,\"componentType\":5121,\"count\":"
                              "1999999999,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{}",
                   ",{\"attributes\":{\"POSITION\":0}}", 1, "]}]}");
    fail_load("count.gltf", RLF_ERROR_FORMAT, "simplify it");
    write_repeated("materials.gltf", ASSET "\"materials\":[{}", ",{}", 2000, "]}");
    fail_load("materials.gltf", RLF_ERROR_FORMAT, "2001 materials");
    write_repeated("old.gltf", "{\"asset\":{\"version\":\"1.0\"},", "\"x\":1", 1, "}");
    fail_load("old.gltf", RLF_ERROR_FORMAT, "asset.version is 1.0");
    test_write_text("cut.glb", "glTF\2\0\0\0");
    fail_load("cut.glb", RLF_ERROR_FORMAT, "cut short");
    write_repeated("uses.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "usemtl m%d\nf 1 2 3\n", 60000, "");
    fail_load("uses.obj", RLF_ERROR_FORMAT, "more than 1024 materials");
    write_repeated("again.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "usemtl m\n", 70000, "");
    fail_load("again.obj", RLF_ERROR_FORMAT, "more than 65536 uses");
    write_repeated("round.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf", " 1 \\\n 2 3", 2000, "\n");
    fail_load("round.obj", RLF_ERROR_FORMAT, "more than 1024 corners");
    alarm(0);
}

TEST_CASE(missing_materials_are_named)
{
    test_write_text("odd.obj", "mtllib odd.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_load(test_path("odd.obj"), &model), RLF_OK);
    assert_int_equal(warning_count, 1);
    assert_non_null(strstr(warning, "odd.mtl"));
    rlf_model_destroy(&model);
}

/* An L is cut along its inner corner; a fan from its first corner would cover the notch. */
TEST_CASE(dented_faces_keep_their_area)
{
    test_write_text("l.obj", "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\n"
                             "f 3 4 5 6 7 1 2\n");
    rlf_model *model = NULL;
    assert_int_equal(rlf_model_load(test_path("l.obj"), &model), RLF_OK);
    assert_int_equal(model->triangle_count, 5);
    double area = 0.0;
    for (int32_t t = 0; t < model->triangle_count; t++) {
        const float *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = model->vertices[model->triangles[3 * t + k]].position;
        }
        area += 0.5 * fabs((double)(p[1][0] - p[0][0]) * (double)(p[2][1] - p[0][1]) -
                           (double)(p[2][0] - p[0][0]) * (double)(p[1][1] - p[0][1]));
    }
    assert_true(is_near(area, 3.0));
    rlf_model_destroy(&model);
}

/* The box without normals: each of its corners belongs to three flat faces. */
TEST_CASE(edges_stay_sharp)
{
    rlf_model *model = load(&model_plain);
    assert_int_equal(model->vertex_count, 24);
    for (int32_t i = 0; i < model->vertex_count; i++) {
        const float *n = model->vertices[i].normal;
        assert_true(fabsf(n[0]) == 1.0f || fabsf(n[1]) == 1.0f || fabsf(n[2]) == 1.0f);
    }
    rlf_model_destroy(&model);
}

TEST_CASE(pictures_have_a_budget)
{
    write_paint(100, 20);
    size_t size;
    char *data = test_read(test_path("paint.png"), &size);
    const io_bytes file = {"paint.png", (const uint8_t *)data, size};
    io_picture picture = {.pixels_max = 1999};
    test_expect_error(io_picture_decode(&file, &picture), RLF_ERROR_FORMAT, "paint.png",
                      "100 x 20, too large beside the others", "make them smaller");
    assert_null(picture.data);
    picture = (io_picture){.pixels_max = 2000};
    assert_int_equal(io_picture_decode(&file, &picture), RLF_OK);
    rlf_free(picture.data);
    free(data);
}

static int64_t allocations_left;

static void *short_alloc(void *context, size_t size)
{
    return allocations_left-- == 0 ? NULL : rlf_default_alloc(context, size);
}

/* Whichever allocation fails, the error is that memory is short, and nothing is left out. */
TEST_CASE(short_memory_is_the_error)
{
    write_paint(8, 8);
    model_write(&text, &model_textured);
    test_write("box.gltf", text.text, text.length);
    test_write_text("flag.mtl", "newmtl cloth\nKd 1 0.5 0.25\nmap_Kd paint.png\n");
    test_write_text("flag.obj", "mtllib flag.mtl\nusemtl cloth\nv 0 0 0\nv 1 0 0\nv 1 2 0\n"
                                "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    for (int i = 0; i < 2; i++) {
        const char *path = test_path(i == 0 ? "box.gltf" : "flag.obj");
        rlf_result result = RLF_ERROR_MEMORY;
        for (int64_t n = 0; result != RLF_OK; n++) {
            rlf_model *model = NULL;
            allocations_left = n;
            rlf_set_allocator(short_alloc, rlf_default_free, NULL);
            result = rlf_model_load(path, &model);
            rlf_set_allocator(NULL, NULL, NULL);
            if (allocations_left < 0) {
                assert_int_equal(result, RLF_ERROR_MEMORY);
                assert_null(model);
            }
            rlf_model_destroy(&model);
        }
    }
    assert_int_equal(warning_count, 0);
}

/* More triangles than are drawn, and a file that need not be read to know. */
TEST_CASE(too_many_triangles_fail)
{
    FILE *file = fopen(test_path("many.obj"), "wb");
    assert_non_null(file);
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\n", file);
    for (int i = 0; i <= RLF_MODEL_TRIANGLES_MAX; i++) {
        fputs("f 1 2 3\n", file);
    }
    fclose(file);
    fail_load("many.obj", RLF_ERROR_FORMAT, "more than 200000 triangles");
    assert_int_equal(truncate(test_path("many.obj"), 8L * 10000000), 0);
    fail_load("many.obj", RLF_ERROR_FORMAT, "");
}

/* The same file gives the same model, and another file another id. */
TEST_CASE(id_tells_models_apart)
{
    rlf_model *a = load(&model_plain);
    rlf_model *b = load(&model_plain);
    model_options o = model_plain;
    o.node = ",\"scale\":[2,1,1]";
    rlf_model *c = load(&o);
    assert_true(a->id == b->id && a->id != c->id);
    rlf_model_destroy(&a);
    rlf_model_destroy(&b);
    rlf_model_destroy(&c);
}

static rlf_result parse(const char *json, rlf_scene *scene)
{
    io_bytes file = {"scene.json", (const uint8_t *)json, strlen(json)};
    return io_scene_parse(&file, test_folder, scene);
}

/* Proportions kept, in the middle of the shape; read once for both. */
TEST_CASE(a_shape_wears_a_model)
{
    model_write(&text, &model_plain);
    test_write("box.gltf", text.text, text.length);
    rlf_scene scene;
    assert_int_equal(parse("{\"bodies\":[{\"size\":[1,1,1],\"model\":\"box.gltf\"},"
                           "{\"shape\":\"cylinder\",\"radius\":2,\"height\":1,\"color\":[1,0,0],"
                           "\"model\":\"box.gltf\"}]}",
                           &scene),
                     RLF_OK);
    assert_int_equal(scene.model_count, 1);
    const rlf_body_def *b = scene.bodies;
    assert_true(b[0].look.model == scene.models[0] && b[1].look.model == scene.models[0]);
    assert_true(is_near(b[0].look.scale, 1.0 / 3.0));
    assert_true(is_near(b[0].look.offset.z, 0.5));
    assert_true(is_near(b[1].look.scale, 0.5));
    assert_true(b[0].color[0] == 1.0f && b[0].color[2] == 1.0f);
    assert_true(b[1].color[0] == 1.0f && b[1].color[2] == 0.0f);
    rlf_scene_destroy(&scene);
}

TEST_CASE(scene_errors_name_the_body)
{
    rlf_scene scene;
    test_expect_error(parse("{\"bodies\":[{\"model\":\"none.glb\"}]}", &scene), RLF_ERROR_IO,
                      "scene.json", "bodies[0].model", NULL);
    test_expect_error(parse("{\"bodies\":[{\"shape\":\"hull\"}]}", &scene), RLF_ERROR_INVALID,
                      "scene.json", "bodies[0].model", NULL);
}

TEST_EACH(set_up, test_folder_remove)
