/* A model for renderer tests: a ball whose texture is a checkerboard, or a plain one. */
#ifndef RLF_TEST_MODEL_SAMPLE_H
#define RLF_TEST_MODEL_SAMPLE_H

#include "relief/model.h"

#include <math.h>
#include <string.h>

#define SAMPLE_SLICES 24
#define SAMPLE_STACKS 12
#define SAMPLE_TEXTURE 64

enum { SAMPLE_VERTICES = (SAMPLE_SLICES + 1) * (SAMPLE_STACKS + 1) };

static inline void sample_fill(rlf_model_vertex *vertices, int32_t *triangles, int32_t *out_count)
{
    int32_t count = 0;
    for (int i = 0; i <= SAMPLE_STACKS; i++) {
        for (int k = 0; k <= SAMPLE_SLICES; k++) {
            double polar = RLF_PI * i / SAMPLE_STACKS;
            double turn = 2.0 * RLF_PI * (k % SAMPLE_SLICES) / SAMPLE_SLICES;
            rlf_model_vertex *v = &vertices[i * (SAMPLE_SLICES + 1) + k];
            v->normal[0] = (float)(rlf_sin(polar) * rlf_cos(turn));
            v->normal[1] = (float)-rlf_cos(polar);
            v->normal[2] = (float)(rlf_sin(polar) * rlf_sin(turn));
            memcpy(v->position, v->normal, sizeof(v->position));
            v->uv[0] = 2.0f * (float)k / SAMPLE_SLICES;
            v->uv[1] = (float)i / SAMPLE_STACKS;
        }
    }
    for (int i = 0; i < SAMPLE_STACKS; i++) {
        for (int k = 0; k < SAMPLE_SLICES; k++) {
            int32_t a = i * (SAMPLE_SLICES + 1) + k;
            const int32_t quad[6] = {a, a + SAMPLE_SLICES + 2, a + 1,
                                     a, a + SAMPLE_SLICES + 1, a + SAMPLE_SLICES + 2};
            memcpy(triangles + count, quad, sizeof(quad));
            count += 6;
        }
    }
    *out_count = count / 3;
}

/* A ball of radius 1; `cells` squares of the checkerboard on a side of the texture, 0 = none. */
static inline rlf_model *sample_ball(int cells)
{
    static rlf_model_vertex vertices[SAMPLE_VERTICES];
    static int32_t triangles[6 * SAMPLE_SLICES * SAMPLE_STACKS];
    static uint8_t pixels[4 * SAMPLE_TEXTURE * SAMPLE_TEXTURE];
    const rlf_model_part part = {.triangle_count = 2 * SAMPLE_SLICES * SAMPLE_STACKS,
                                 .color = {1.0f, 0.8f, 0.6f},
                                 .texture = -1};
    rlf_image_rgba8 image = {pixels, SAMPLE_TEXTURE, SAMPLE_TEXTURE, 4 * SAMPLE_TEXTURE};
    rlf_model_def def = rlf_model_def_default();
    sample_fill(vertices, triangles, &def.triangle_count);
    for (int i = 0; cells > 0 && i < SAMPLE_TEXTURE * SAMPLE_TEXTURE; i++) {
        int x = i % SAMPLE_TEXTURE * cells / SAMPLE_TEXTURE;
        int y = i / SAMPLE_TEXTURE * cells / SAMPLE_TEXTURE;
        const uint8_t colors[2][4] = {{250, 200, 40, 255}, {30, 60, 160, 255}};
        memcpy(pixels + 4 * i, colors[(x + y) % 2], 4);
    }
    def.vertices = vertices;
    def.vertex_count = SAMPLE_VERTICES;
    def.triangles = triangles;
    def.images = &image;
    def.image_count = cells > 0 ? 1 : 0;
    def.parts = cells > 0 ? NULL : &part;
    def.part_count = cells > 0 ? 0 : 1;
    rlf_model *model = NULL;
    return rlf_model_create(&def, &model) == RLF_OK ? model : NULL;
}

/* The same of worn metal with waves in it: textures of normals, metal and roughness. */
static inline rlf_model *sample_worn_ball(void)
{
    static rlf_model_vertex vertices[SAMPLE_VERTICES];
    static int32_t triangles[6 * SAMPLE_SLICES * SAMPLE_STACKS];
    static uint8_t pixels[2][4 * SAMPLE_TEXTURE * SAMPLE_TEXTURE];
    const rlf_model_part part = {.triangle_count = 2 * SAMPLE_SLICES * SAMPLE_STACKS,
                                 .color = {1.0f, 0.8f, 0.6f},
                                 .texture = -1,
                                 .metallic = 1.0f,
                                 .surface_texture = 1,
                                 .normal_texture = 2};
    rlf_image_rgba8 images[2];
    rlf_model_def def = rlf_model_def_default();
    sample_fill(vertices, triangles, &def.triangle_count);
    for (int i = 0; i < SAMPLE_TEXTURE * SAMPLE_TEXTURE; i++) {
        const double x = 6.0 * RLF_PI * (i % SAMPLE_TEXTURE) / SAMPLE_TEXTURE;
        const double y = 6.0 * RLF_PI * (i / SAMPLE_TEXTURE) / SAMPLE_TEXTURE;
        pixels[0][4 * i + 1] = (uint8_t)(140.0 + 100.0 * rlf_sin(x));
        pixels[0][4 * i + 2] = (uint8_t)(128.0 + 120.0 * rlf_sin(y));
        pixels[1][4 * i] = (uint8_t)(127.5 + 60.0 * rlf_sin(x));
        pixels[1][4 * i + 1] = (uint8_t)(127.5 + 60.0 * rlf_cos(y));
        pixels[1][4 * i + 2] = 230;
    }
    for (int i = 0; i < 2; i++) {
        images[i] =
            (rlf_image_rgba8){pixels[i], SAMPLE_TEXTURE, SAMPLE_TEXTURE, 4 * SAMPLE_TEXTURE};
    }
    def.vertices = vertices;
    def.vertex_count = SAMPLE_VERTICES;
    def.triangles = triangles;
    def.images = images;
    def.image_count = 2;
    def.parts = &part;
    def.part_count = 1;
    rlf_model *model = NULL;
    return rlf_model_create(&def, &model) == RLF_OK ? model : NULL;
}

#endif
