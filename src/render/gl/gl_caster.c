/* Light that bodies take, in GLSL. */
#include "render/gl/gl_light.h"

#include <stdio.h>

const char gl_caster_glsl[] =
    "struct caster {\n"
    "    vec3 center;\n"
    "    mat3 to_body;\n"
    "    vec3 half_size;\n"
    "    vec3 to_light;\n" /* body frame */
    "    vec4 numbers;\n"  /* round, near_m, length_m, penumbra */
    "    float crease;\n"
    "    int edge_count;\n"
    "    vec4 edges[16];\n"
    "};\n"
    "const float caster_spread = 0.12;\n"
    "vec2 light_lost(caster c, vec2 ray, float z)\n"
    "{\n"
    "    vec3 p = z * vec3(ray, 1.0) - c.center;\n"
    "    vec3 q = c.to_body * p;\n"
    "    float beyond = -1e6;\n"
    "    for (int i = 0; i < c.edge_count; i++) {\n"
    "        beyond = max(beyond, dot(c.edges[i].xyz, p) - c.edges[i].w);\n"
    "    }\n"
    "    float gap = length(q - clamp(q, -c.half_size, c.half_size)) - c.numbers.x;\n"
    "    gap = max(gap, beyond);\n"
    "    float close = max(0.0, 1.0 - max(0.0, gap) / c.numbers.y);\n"
    "    float t = max(0.0, -dot(q, c.to_light));\n"
    "    vec3 k = clamp(q + t * c.to_light, -c.half_size, c.half_size);\n"
    "    t = max(0.0, dot(k - q, c.to_light));\n"
    "    vec3 e = q + t * c.to_light;\n"
    "    float pass = length(e - clamp(e, -c.half_size, c.half_size)) - c.numbers.x;\n"
    "    float width = c.numbers.w + caster_spread * t;\n"
    "    float hidden = clamp(0.5 - max(pass, beyond) / width, 0.0, 1.0);\n"
    "    hidden *= max(0.0, 1.0 - t / c.numbers.z) * clamp(t / c.numbers.w, 0.0, 1.0);\n"
    "    float behind = max(0.0, -dot(p, vec3(ray, 1.0)));\n"
    "    float square = dot(p, p) * (1.0 + dot(ray, ray));\n"
    "    float facing = 1.0 - behind * behind / (square + 1e-12);\n"
    "    float fourth = close * close * close * close;\n"
    "    float creased = mix(facing, 1.0, c.crease * fourth * fourth);\n"
    "    return vec2(close * close * creased, hidden * facing);\n"
    "}\n";

static GLint find(GLuint program, const char *name, const char *field)
{
    char text[64];
    (void)snprintf(text, sizeof(text), "%s.%s", name, field);
    return glGetUniformLocation(program, text);
}

gl_caster_uniforms gl_caster_find_uniforms(GLuint program, const char *name)
{
    gl_caster_uniforms u = {find(program, name, "center"),     find(program, name, "to_body"),
                            find(program, name, "half_size"),  find(program, name, "to_light"),
                            find(program, name, "numbers"),    find(program, name, "crease"),
                            find(program, name, "edge_count"), find(program, name, "edges")};
    return u;
}

void gl_caster_set_uniforms(const gl_caster_uniforms *uniforms, const caster *c)
{
    GLfloat columns[9];
    for (int i = 0; i < 9; i++) {
        columns[i] = c->axis[i % 3][i / 3];
    }
    glUniform3fv(uniforms->center, 1, c->center);
    glUniformMatrix3fv(uniforms->to_body, 1, GL_FALSE, columns);
    glUniform3fv(uniforms->half_size, 1, c->half);
    glUniform3fv(uniforms->to_light, 1, c->to_light);
    glUniform1f(uniforms->crease, c->crease);
    glUniform1i(uniforms->edge_count, c->edge_count);
    if (c->edge_count > 0) {
        glUniform4fv(uniforms->edges, c->edge_count, c->edge[0]);
    }
    glUniform4f(uniforms->numbers, c->round, c->near_m, c->length_m, c->penumbra);
}
