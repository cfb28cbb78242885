/* Light by place, in shaders: the formulas of soft/gloss.c. */
#include "render/gl/gl_light.h"

const char gl_probe_glsl[] =
    "uniform vec3 u_around[9];\n"
    "uniform vec3 u_rough[9];\n"
    "uniform vec3 u_direct;\n"
    "uniform sampler2D u_probe_maps;\n"
    "uniform int u_probe_row;\n"
    "uniform vec2 u_material;\n" /* metallic, roughness */
    "vec2 material;\n"           /* the pixel's: set it first */
    "const int probe_row = 18;\n"
    "vec3 harmonics(vec3 t[9], vec3 d)\n"
    "{\n"
    "    return max(vec3(0.0), t[0] + t[1] * d.x + t[2] * d.y + t[3] * d.z + t[4] * d.x * d.y\n"
    "        + t[5] * d.y * d.z + t[6] * d.z * d.x + t[7] * d.z * d.z\n"
    "        + t[8] * (d.x * d.x - d.y * d.y));\n"
    "}\n"
    "vec3 probe_cell(int i)\n"
    "{\n"
    "    return vec3(texelFetch(u_probe_maps, ivec2(3 * i, u_probe_row), 0).r,\n"
    "        texelFetch(u_probe_maps, ivec2(3 * i + 1, u_probe_row), 0).r,\n"
    "        texelFetch(u_probe_maps, ivec2(3 * i + 2, u_probe_row), 0).r);\n"
    "}\n"
    "vec3 mirrored(vec3 r)\n"
    "{\n"
    "    if (material.y >= 0.45) {\n"
    "        return harmonics(u_rough, r);\n"
    "    }\n"
    "    vec2 at = r.xy / (abs(r.x) + abs(r.y) + abs(r.z) + 1e-12);\n"
    "    vec2 side = vec2(at.x < 0.0 ? -1.0 : 1.0, at.y < 0.0 ? -1.0 : 1.0);\n"
    "    at = r.z > 0.0 ? (1.0 - abs(at.yx)) * side : at;\n"
    "    at = clamp(at * 8.0 + 8.5, 0.0, 16.499);\n"
    "    ivec2 cell = ivec2(at);\n"
    "    vec2 rest = at - vec2(cell);\n"
    "    int i = cell.y * probe_row + cell.x;\n"
    "    return mix(mix(probe_cell(i), probe_cell(i + 1), rest.x),\n"
    "        mix(probe_cell(i + probe_row), probe_cell(i + probe_row + 1), rest.x), rest.y);\n"
    "}\n"
    /* n, to_lamp and to_eye are unit; left: shares of the light around and of the lamp's */
    "vec3 sent(vec3 color, vec3 n, vec3 to_lamp, vec3 to_eye, vec2 left)\n"
    "{\n"
    "    float rough = material.y;\n"
    "    float cosine = dot(n, to_eye);\n"
    "    float facing = clamp(dot(n, to_lamp), 0.0, 1.0);\n"
    "    vec3 h = to_lamp + to_eye;\n"
    "    h *= inversesqrt(dot(h, h) + 1e-12);\n"
    "    float nh = clamp(dot(n, h), 0.0, 1.0);\n"
    "    float lh = clamp(dot(to_lamp, h), 0.1, 1.0);\n"
    "    float width = rough * rough + 0.06;\n"
    "    float peak = nh * nh * (width * width - 1.0) + 1.0;\n"
    "    float lamp = width * width / (peak * peak) * 0.25 / ((rough + 0.5) * lh * lh) * facing;\n"
    "    vec4 r = rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);\n"
    "    float away = 1.0 - clamp(cosine, 0.02, 1.0);\n"
    "    float a = min(r.x * r.x, away * away * away * away * away) * r.x + r.y;\n"
    "    vec2 share = vec2(r.z - 1.04 * a, clamp(r.w + 1.04 * a, 0.0, 1.0));\n"
    "    vec3 lit = u_direct * left.y;\n"
    "    vec3 diffuse = left.x * harmonics(u_around, n) + lit * facing;\n"
    "    vec3 room = left.x * mirrored(2.0 * cosine * n - to_eye);\n"
    "    vec3 sheen = room * share.x + lit * lamp;\n"
    "    vec3 times = mix(diffuse, sheen, material.x);\n"
    "    vec3 plus = 0.04 * (1.0 - material.x) * sheen + room * share.y;\n"
    "    return sqrt(min(color * times + plus, 1.0));\n"
    "}\n";

gl_probe_uniforms gl_probe_find_uniforms(GLuint program)
{
    gl_probe_uniforms u = {
        glGetUniformLocation(program, "u_around"), glGetUniformLocation(program, "u_rough"),
        glGetUniformLocation(program, "u_direct"), glGetUniformLocation(program, "u_probe_row"),
        glGetUniformLocation(program, "u_material")};
    return u;
}

rlf_result gl_probes_create(gl_probes *out)
{
    out->set = rlf_alloc(sizeof(*out->set));
    out->rows = rlf_alloc_array((size_t)PROBE_OWN * 3 * PROBE_CELLS, sizeof(*out->rows));
    if (out->set == NULL || out->rows == NULL) {
        return RLF_ERROR_MEMORY;
    }
    probe_set_init(out->set);
    out->texture = gl_texture_create(GL_NEAREST);
    return RLF_OK;
}

void gl_probes_destroy(gl_probes *probes)
{
    if (probes->set != NULL) {
        probe_set_destroy(probes->set);
    }
    gl_texture_destroy(&probes->texture);
    rlf_free(probes->set);
    rlf_free(probes->rows);
    *probes = (gl_probes){0};
}

rlf_result gl_probes_update(gl_probes *probes, const probe_def *def, const rlf_render_input *input)
{
    const rlf_result result =
        probe_set_update(probes->set, def, input->frame, input->surface, input->snapshot);
    for (int32_t k = 0; k < probes->set->count && result == RLF_OK; k++) {
        for (int32_t i = 0; i < 3 * PROBE_CELLS; i++) {
            probes->rows[k * 3 * PROBE_CELLS + i] = probes->set->probes[k].map[i / 3][i % 3];
        }
    }
    gl_texture_upload_f32(&probes->texture, probes->rows, 3 * PROBE_CELLS, PROBE_OWN);
    return result;
}

void gl_probes_set(const gl_probe_uniforms *uniforms, const gl_probes *probes, int32_t index)
{
    const int32_t row = probes->set->of[index];
    const light_probe *probe = &probes->set->probes[row];
    glUniform3fv(uniforms->around, PROBE_TERMS, probe->around[0]);
    glUniform3fv(uniforms->rough, PROBE_TERMS, probe->rough[0]);
    glUniform3fv(uniforms->direct, 1, probe->direct);
    glUniform1i(uniforms->row, row);
}

void gl_probes_set_material(const gl_probe_uniforms *uniforms, probe_material material)
{
    glUniform2f(uniforms->material, material.metallic, material.roughness);
}
