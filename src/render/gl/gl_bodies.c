/* Bodies as meshes with a model matrix T R S each (A.3 as corrected), placed by A.5. */
#include "render/gl/gl_bodies.h"

#include "render/gl/gl_light.h"
#include "render/gl/gl_context.h"

#include "render/body_texture.h"

#include <stddef.h>

enum {
    HULL_BATCH = 1024, /* triangles per upload */
    UNIT_BACKDROP = 0,
    UNIT_REAL_DEPTH = 1,
    UNIT_TEXTURES = 2,
    UNIT_NEAR = 3,
    UNIT_FAR = 4,
    UNIT_COVER = 5,
    UNIT_SHADE = 6,
    UNIT_PROBES = 7,
    UNIT_SKIN = 8,
    UNIT_SURFACE = UNIT_SKIN + GL_MODELS_SURFACE,
    UNIT_NORMALS = UNIT_SKIN + GL_MODELS_NORMALS
};

/* Values of u_occlusion. */
enum { HIDDEN_BY_NOTHING = 0, HIDDEN_BY_DEPTH = 1, HIDDEN_BY_SOFT = 2 };

static const char body_vertex[] =
    "layout(location = 0) in vec4 a_position_shift;\n"
    "layout(location = 1) in vec3 a_normal;\n"
    "layout(location = 2) in vec2 a_uv;\n"
    "uniform mat4 u_picture_body;\n"
    "uniform mat3 u_camera_body;\n"
    "uniform float u_shift;\n"
    "out vec3 v_normal;\n"
    "out vec2 v_uv;\n"
    "void main()\n"
    "{\n"
    "    vec3 p = a_position_shift.xyz + vec3(0.0, a_position_shift.w * u_shift, 0.0);\n"
    "    gl_Position = clip_of((u_picture_body * vec4(p, 1.0)).xyz);\n"
    "    v_normal = u_camera_body * a_normal;\n"
    "    v_uv = a_uv;\n"
    "}\n";

/* 1 / gl_FragCoord.w is the clip w, and that is z in the picture's camera: the same quantity that
 * the registered depth holds, per pixel (4.2.2; errata 8). The body is mixed with the backdrop here
 * and not by blending, so that the nearest body alone decides, whatever the order of drawing. A
 * pixel that a triangle only touches may have its centre outside, hence the clamp of uv. */
static const char body_fragment[] =
    "in vec3 v_normal;\n"
    "in vec2 v_uv;\n"
    "uniform sampler2D u_backdrop;\n"
    "uniform sampler2D u_real_depth;\n"
    "uniform sampler2DArray u_textures;\n"
    "uniform sampler2D u_near_z;\n"
    "uniform sampler2D u_far_z;\n"
    "uniform sampler2D u_cover;\n"
    "uniform vec3 u_noise;\n"
    "uniform int u_occlusion;\n"
    "uniform vec4 u_intrinsics;\n" /* fx fy cx cy */
    "uniform caster u_shaders[3];\n"
    "uniform int u_shader_count;\n"
    "uniform vec2 u_body_shares;\n" /* of ambient and diffuse light that others can take */
    "uniform vec3 u_color;\n"
    "uniform vec3 u_light;\n"
    "uniform mat3 u_picture_camera;\n"
    "uniform float u_layer;\n"
    "uniform float u_level;\n"
    "uniform sampler2D u_skin;\n"
    "uniform bool u_has_skin;\n"
    "uniform sampler2D u_surface;\n"
    "uniform sampler2D u_normals;\n"
    "uniform bool u_has_normals;\n"
    "out vec4 o_color;\n"
    /* where texture coordinates grow on the surface, as scene_model.c has it */
    "vec3 bent(vec3 n, vec3 p)\n"
    "{\n"
    "    vec3 a = dFdx(p), b = dFdy(p), g = cross(a, b);\n"
    "    vec3 by_a = cross(b, g), by_b = cross(g, a);\n"
    "    vec2 uv_a = dFdx(v_uv), uv_b = dFdy(v_uv);\n"
    "    vec3 across = by_a * uv_a.x + by_b * uv_b.x;\n"
    "    vec3 down = by_a * uv_a.y + by_b * uv_b.y;\n"
    "    float most = max(dot(across, across), dot(down, down));\n"
    "    vec3 m = 2.0 * texture(u_normals, v_uv).rgb - 1.0;\n"
    "    vec3 along = most > 0.0 ? (across * m.x - down * m.y) * inversesqrt(most) : vec3(0.0);\n"
    "    return normalize(n * m.z + along);\n"
    "}\n"
    "void main()\n"
    "{\n"
    "    vec3 normal = normalize(v_normal);\n"
    "    float z = 1.0 / gl_FragCoord.w;\n"
    "    vec2 ray = (gl_FragCoord.xy - 0.5 - u_intrinsics.zw) / u_intrinsics.xy;\n"
    "    vec2 left = vec2(1.0);\n"
    "    for (int i = 0; i < u_shader_count; i++) {\n"
    "        left *= 1.0 - u_body_shares * light_lost(u_shaders[i], ray, z);\n"
    "    }\n"
    "    left.x *= near_left(z * vec3(ray, 1.0), normal);\n"
    "    left.y *= 1.0 - u_body_shares.y * (1.0 - real_left(z * vec3(ray, 1.0)));\n"
    "    vec3 uv_layer = vec3(clamp(v_uv, 0.0, 1.0), u_layer);\n"
    "    vec3 pattern = u_has_skin ? texture(u_skin, v_uv).rgb\n"
    "                              : textureLod(u_textures, uv_layer, u_level).rgb;\n"
    "    vec3 seen = u_picture_camera * normal;\n"
    "    vec3 by_x = dFdx(normal), by_y = dFdy(normal);\n" /* as material_of in shade.c */
    "    float turn = min(0.25 * (dot(by_x, by_x) + dot(by_y, by_y)), 0.18);\n"
    "    material = u_material;\n"
    "    if (u_has_skin) {\n"
    "        material.y = turn > 1e-3 ? sqrt(sqrt(pow(material.y, 4.0) + turn)) : material.y;\n"
    "        material *= texture(u_surface, v_uv).bg;\n"
    "    }\n"
    "    if (u_has_normals) {\n"
    "        seen = bent(seen, z * vec3(ray, 1.0));\n"
    "    }\n"
    "    vec3 color = sent(u_color * pattern * pattern, seen,\n"
    "        -(u_picture_camera * u_light), -normalize(vec3(ray, 1.0)), left);\n"
    "    float shown = 1.0;\n"
    "    if (u_occlusion == 1) {\n"
    "        shown = share_in_front(u_real_depth, z);\n"
    "    } else if (u_occlusion == 2) {\n"
    "        shown = share_of_soft(u_near_z, u_far_z, u_cover, u_noise, z);\n"
    "    }\n"
    "    vec3 real = texelFetch(u_backdrop, ivec2(gl_FragCoord.xy), 0).rgb;\n"
    "    o_color = vec4(mix(real, color, shown), shown);\n"
    "}\n";

static void create_program_uniforms(gl_bodies *bodies)
{
    GLuint p = bodies->program;
    bodies->uniforms.picture_body = glGetUniformLocation(p, "u_picture_body");
    bodies->uniforms.camera_body = glGetUniformLocation(p, "u_camera_body");
    bodies->uniforms.picture_camera = glGetUniformLocation(p, "u_picture_camera");
    bodies->uniforms.shift = glGetUniformLocation(p, "u_shift");
    bodies->uniforms.color = glGetUniformLocation(p, "u_color");
    bodies->uniforms.light = glGetUniformLocation(p, "u_light");
    bodies->uniforms.layer = glGetUniformLocation(p, "u_layer");
    bodies->uniforms.level = glGetUniformLocation(p, "u_level");
    bodies->uniforms.has_skin = glGetUniformLocation(p, "u_has_skin");
    bodies->uniforms.has_normals = glGetUniformLocation(p, "u_has_normals");
    bodies->uniforms.occlusion = glGetUniformLocation(p, "u_occlusion");
    bodies->uniforms.noise = glGetUniformLocation(p, "u_noise");
    bodies->uniforms.intrinsics = glGetUniformLocation(p, "u_intrinsics");
    bodies->uniforms.shader_count = glGetUniformLocation(p, "u_shader_count");
    for (int i = 0; i < CASTER_BODIES; i++) {
        const char name[] = {'u', '_', 's', 'h', 'a', 'd', 'e', 'r', 's', '[', (char)('0' + i),
                             ']', 0};
        bodies->uniforms.shaders[i] = gl_caster_find_uniforms(p, name);
    }
    bodies->uniforms.probe = gl_probe_find_uniforms(p);
    bodies->uniforms.shade = gl_shade_find_uniforms(p);
    bodies->uniforms.near_by = gl_obscurance_find_uniforms(p);
    bodies->view_uniforms = gl_view_find_uniforms(p);
    glUseProgram(p);
    glUniform1i(glGetUniformLocation(p, "u_backdrop"), UNIT_BACKDROP);
    glUniform1i(glGetUniformLocation(p, "u_real_depth"), UNIT_REAL_DEPTH);
    glUniform1i(glGetUniformLocation(p, "u_textures"), UNIT_TEXTURES);
    glUniform1i(glGetUniformLocation(p, "u_near_z"), UNIT_NEAR);
    glUniform1i(glGetUniformLocation(p, "u_far_z"), UNIT_FAR);
    glUniform1i(glGetUniformLocation(p, "u_cover"), UNIT_COVER);
    glUniform1i(glGetUniformLocation(p, "u_shade_maps"), UNIT_SHADE);
    glUniform1i(glGetUniformLocation(p, "u_skin"), UNIT_SKIN);
    glUniform1i(glGetUniformLocation(p, "u_surface"), UNIT_SURFACE);
    glUniform1i(glGetUniformLocation(p, "u_normals"), UNIT_NORMALS);
    glUniform1i(glGetUniformLocation(p, "u_probe_maps"), UNIT_PROBES);
    glUniform2f(glGetUniformLocation(p, "u_body_shares"), (GLfloat)BODY_AMBIENT_SHARE,
                (GLfloat)BODY_DIRECT_SHARE);
    glUseProgram(0);
}

/* Tells the bound vertex array how a shape_vertex lies in the bound array buffer. */
static void describe_vertices(void)
{
    const GLsizei stride = (GLsizei)sizeof(shape_vertex);
    const uintptr_t normal = offsetof(shape_vertex, normal);
    const uintptr_t uv = offsetof(shape_vertex, uv);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, stride, NULL);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride, (const void *)normal);
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, stride, (const void *)uv);
    for (GLuint i = 0; i < 3; i++) {
        glEnableVertexAttribArray(i);
    }
}

static rlf_result create_meshes(gl_bodies *bodies)
{
    shape_mesh_set *set = rlf_alloc(sizeof *set);
    bodies->hull_vertices = rlf_alloc_array(3 * (size_t)HULL_BATCH, sizeof(shape_vertex));
    if (set == NULL || bodies->hull_vertices == NULL) {
        rlf_free(set);
        return RLF_ERROR_MEMORY;
    }
    shape_mesh_set_build(set);
    for (int i = 0; i < SHAPE_MESH_UNIT_COUNT; i++) {
        bodies->range[i] = set->range[i];
    }
    glGenVertexArrays(1, &bodies->vertex_array);
    glGenBuffers(1, &bodies->vertex_buffer);
    glGenBuffers(1, &bodies->index_buffer);
    glBindVertexArray(bodies->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, bodies->vertex_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)sizeof(shape_vertex) * set->vertex_count,
                 set->vertices, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, bodies->index_buffer);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)sizeof(uint16_t) * set->index_count,
                 set->indices, GL_STATIC_DRAW);
    describe_vertices();
    rlf_free(set);

    glGenVertexArrays(1, &bodies->hull_array);
    glGenBuffers(1, &bodies->hull_buffer);
    glBindVertexArray(bodies->hull_array);
    glBindBuffer(GL_ARRAY_BUFFER, bodies->hull_buffer);
    describe_vertices();
    glBindVertexArray(0);
    return RLF_OK;
}

static rlf_result create_textures(gl_bodies *bodies)
{
    uint8_t *bytes = rlf_alloc(BODY_TEXTURE_BYTES);
    if (bytes == NULL) {
        return RLF_ERROR_MEMORY;
    }
    glGenTextures(1, &bodies->textures);
    glBindTexture(GL_TEXTURE_2D_ARRAY, bodies->textures);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, BODY_TEXTURE_LEVELS - 1);
    for (int32_t level = 0; level < BODY_TEXTURE_LEVELS; level++) {
        GLsizei size = BODY_TEXTURE_SIZE >> level;
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_RGBA8, size, size, BODY_TEXTURE_KINDS, 0,
                     GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    }
    for (int kind = 0; kind < BODY_TEXTURE_KINDS; kind++) {
        body_texture_fill((body_texture_kind)kind, bytes);
        for (int32_t level = 0; level < BODY_TEXTURE_LEVELS; level++) {
            GLsizei size = BODY_TEXTURE_SIZE >> level;
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, kind, size, size, 1, GL_RGBA,
                            GL_UNSIGNED_BYTE, bytes + body_texture_level_offset(level));
        }
    }
    rlf_free(bytes);
    return RLF_OK;
}

rlf_result gl_bodies_create(bool is_es, gl_bodies *out)
{
    *out = (gl_bodies){0};
    const gl_program_source source = {
        "body",
        {gl_view_glsl, body_vertex},
        {gl_caster_glsl,
         GL_OCCLUSION_GLSL GL_SOFT_OCCLUSION_GLSL GL_REAL_SHADE_GLSL GL_OBSCURANCE_GLSL,
         gl_probe_glsl, body_fragment}};
    out->program = gl_program_build(is_es, &source);
    if (out->program == 0) {
        return RLF_ERROR_DEVICE;
    }
    create_program_uniforms(out);
    rlf_result result = create_meshes(out);
    if (result == RLF_OK) {
        result = create_textures(out);
    }
    if (result == RLF_OK) {
        result = gl_models_create(UNIT_SKIN, &out->models);
    }
    if (result != RLF_OK) {
        gl_bodies_destroy(out);
    }
    return result;
}

void gl_bodies_destroy(gl_bodies *bodies)
{
    const GLuint buffers[3] = {bodies->vertex_buffer, bodies->index_buffer, bodies->hull_buffer};
    const GLuint arrays[2] = {bodies->vertex_array, bodies->hull_array};
    glDeleteProgram(bodies->program);
    glDeleteVertexArrays(2, arrays);
    glDeleteBuffers(3, buffers);
    glDeleteTextures(1, &bodies->textures);
    gl_models_destroy(&bodies->models);
    rlf_free(bodies->hull_vertices);
    *bodies = (gl_bodies){0};
}

static void set_rotation(GLint uniform, rlf_quat q)
{
    const rlf_mat3 rotation = rlf_quat_to_mat3(q);
    GLfloat columns[9];
    for (int i = 0; i < 9; i++) {
        columns[i] = (GLfloat)rotation.m[i % 3][i / 3];
    }
    glUniformMatrix3fv(uniform, 1, GL_FALSE, columns);
}

void gl_bodies_begin(const gl_bodies *bodies, const gl_bodies_pass *pass)
{
    glUseProgram(bodies->program);
    glUniform3f(bodies->uniforms.light, (GLfloat)pass->light_direction.x,
                (GLfloat)pass->light_direction.y, (GLfloat)pass->light_direction.z);
    int occlusion = pass->real_depth != NULL ? HIDDEN_BY_DEPTH : HIDDEN_BY_NOTHING;
    glUniform1i(bodies->uniforms.occlusion, pass->soft != NULL ? HIDDEN_BY_SOFT : occlusion);
    const rlf_camera *k = &pass->view->camera;
    glUniform4f(bodies->uniforms.intrinsics, (GLfloat)k->fx, (GLfloat)k->fy, (GLfloat)k->cx,
                (GLfloat)k->cy);
    gl_view_set_uniforms(&bodies->view_uniforms, pass->view);
    set_rotation(bodies->uniforms.picture_camera, pass->view->T_picture_camera.q);
    gl_texture_bind(&pass->probes->texture, UNIT_PROBES);
    gl_texture_bind(pass->backdrop, UNIT_BACKDROP);
    if (pass->real_depth != NULL) {
        gl_texture_bind(pass->real_depth, UNIT_REAL_DEPTH);
    }
    if (pass->soft != NULL) {
        const rlf_depth_noise *noise = pass->soft->noise;
        glUniform3f(bodies->uniforms.noise, (GLfloat)noise->c0, (GLfloat)noise->c1,
                    (GLfloat)noise->c2);
        gl_texture_bind(pass->soft->near_z, UNIT_NEAR);
        gl_texture_bind(pass->soft->far_z, UNIT_FAR);
        gl_texture_bind(pass->soft->cover, UNIT_COVER);
    }
    if (pass->shade != NULL) {
        gl_texture_bind(&pass->shade->texture, UNIT_SHADE);
    }
    glActiveTexture(GL_TEXTURE0 + UNIT_TEXTURES);
    glBindTexture(GL_TEXTURE_2D_ARRAY, bodies->textures);
}

/* Linear. */
static void set_color(const gl_bodies *bodies, const rlf_body_state *body, const float own[3])
{
    GLfloat color[3];
    for (int k = 0; k < 3; k++) {
        const float code = (float)rlf_clamp((double)body->color[k], 0.0, 1.0) * own[k];
        color[k] = code * code;
    }
    glUniform3fv(bodies->uniforms.color, 1, color);
}

/* Where a unit mesh, hull or model (whose `offset` is in the body's frame) is. */
static void set_place(const gl_bodies *bodies, const gl_view *view, const rlf_body_state *body,
                      rlf_vec3 scale, rlf_vec3 offset)
{
    rlf_pose T_camera_body = rlf_pose_mul(&view->T_camera_world, &body->T_world_body);
    rlf_pose T_picture_body = rlf_pose_mul(&view->T_picture_world, &body->T_world_body);
    T_picture_body.p = rlf_transform(&T_picture_body, offset);
    rlf_mat4 view_model = rlf_mat4_model(&T_picture_body, scale);
    gl_view_set_matrix(bodies->uniforms.picture_body, &view_model);
    set_rotation(bodies->uniforms.camera_body, T_camera_body.q);
}

/* Uniforms of a body that is drawn as its shape. */
static void set_shape(const gl_bodies *bodies, const gl_bodies_pass *pass,
                      const rlf_body_state *body)
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    const gl_view *view = pass->view;
    shape_mesh_scale scale = shape_mesh_scale_of(&body->shape);
    double focal = 0.5 * (view->camera.fx + view->camera.fy);
    double z = rlf_transform(&view->T_picture_world, body->T_world_body.p).z;
    set_place(bodies, view, body, scale.scale, rlf_vec3_make(0, 0, 0));
    set_color(bodies, body, white);
    gl_probes_set_material(&bodies->uniforms.probe, body_material_of(body->shape.type));
    glUniform1i(bodies->uniforms.has_skin, 0);
    glUniform1i(bodies->uniforms.has_normals, 0);
    glUniform1f(bodies->uniforms.shift, (GLfloat)(scale.half_height / scale.scale.y));
    glUniform1f(bodies->uniforms.layer, (GLfloat)body_texture_kind_of(body->shape.type));
    glUniform1f(bodies->uniforms.level, (GLfloat)body_texture_level_of(&body->shape, z, focal));
}

static void draw_model(const gl_bodies *bodies, const gl_bodies_pass *pass,
                       const rlf_body_state *body)
{
    const rlf_look *look = &body->look;
    const double s = look->scale;
    set_place(bodies, pass->view, body, rlf_vec3_make(s, s, s), look->offset);
    glUniform1i(bodies->uniforms.has_skin, 1);
    glUniform1f(bodies->uniforms.shift, 0.0f);
    const gl_model *item = gl_models_bind(bodies->models, look->model);
    for (int32_t i = 0; i < look->model->part_count; i++) {
        const rlf_model_part *part = &look->model->parts[i];
        set_color(bodies, body, part->color);
        gl_probes_set_material(&bodies->uniforms.probe,
                               (probe_material){part->metallic, 1.0f - part->gloss});
        glUniform1i(bodies->uniforms.has_normals, part->normal_texture > 0 ? 1 : 0);
        gl_models_draw_part(bodies->models, item, part);
    }
}

/* The bodies that may take light from this one. */
static void set_shaders(const gl_bodies *bodies, const gl_bodies_pass *pass, int32_t body_count,
                        int32_t index)
{
    int32_t chosen[CASTER_BODIES];
    int32_t count = 0;
    if (pass->casters != NULL) {
        count = caster_choose(pass->casters, body_count, index, chosen);
    }
    glUniform1i(bodies->uniforms.shader_count, count);
    for (int32_t i = 0; i < count; i++) {
        gl_caster_set_uniforms(&bodies->uniforms.shaders[i], &pass->casters[chosen[i]]);
    }
}

static void draw_batch(const gl_bodies *bodies, int32_t vertex_count)
{
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)sizeof(shape_vertex) * vertex_count,
                 bodies->hull_vertices, GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLES, 0, vertex_count);
}

/* A hull is its body's own and may be any size, so its triangles pass through a small buffer. */
static void draw_hull(const gl_bodies *bodies, const rlf_shape *shape)
{
    double radius = rlf_shape_radius(shape);
    int32_t count = 0;
    glBindVertexArray(bodies->hull_array);
    glBindBuffer(GL_ARRAY_BUFFER, bodies->hull_buffer);
    for (int32_t i = 0; i < shape->hull->triangle_count; i++) {
        if (shape_mesh_hull_triangle(shape->hull, i, radius, bodies->hull_vertices + count)) {
            count += 3;
        }
        if (count == 3 * HULL_BATCH) {
            draw_batch(bodies, count);
            count = 0;
        }
    }
    if (count > 0) {
        draw_batch(bodies, count);
    }
}

void gl_bodies_draw(const gl_bodies *bodies, const gl_bodies_pass *pass,
                    const rlf_snapshot *snapshot, int32_t index)
{
    const rlf_body_state *body = &snapshot->bodies[index];
    set_shaders(bodies, pass, snapshot->body_count, index);
    gl_probes_set(&bodies->uniforms.probe, pass->probes, index);
    gl_shade_set(&bodies->uniforms.shade, pass->shade, index);
    gl_obscurance_set(&bodies->uniforms.near_by, pass->near_by, index);
    if (body->look.model != NULL) {
        draw_model(bodies, pass, body);
        return;
    }
    set_shape(bodies, pass, body);
    if (body->shape.type == RLF_SHAPE_HULL) {
        draw_hull(bodies, &body->shape);
        return;
    }
    const shape_mesh_range *range = &bodies->range[body->shape.type];
    glBindVertexArray(bodies->vertex_array);
    glDrawElements(GL_TRIANGLES, range->index_count, GL_UNSIGNED_SHORT,
                   (const void *)(sizeof(uint16_t) * (uintptr_t)range->first_index));
}

void gl_bodies_end(void)
{
    glBindVertexArray(0);
    glUseProgram(0);
}
