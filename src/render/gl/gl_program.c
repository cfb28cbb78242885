/* Compiles and links shader programs. */
#include "render/gl/gl_context.h"

const char gl_program_screen_vertex[] =
    "void main()\n"
    "{\n"
    "    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "    gl_Position = vec4(corner, 0.0, 1.0);\n"
    "}\n";

static const char *preamble(bool is_es)
{
    return is_es ? "#version 300 es\n"
                   "precision highp float;\n"
                   "precision highp int;\n"
                   "precision highp sampler2D;\n"
                   "precision highp sampler2DArray;\n"
                 : "#version 330 core\n";
}

/* Drivers write several lines; an error of ours is one. */
static void cut_to_one_line(char *text)
{
    for (char *p = text; *p != '\0'; p++) {
        if (*p == '\n') {
            *p = p[1] == '\0' ? '\0' : ' ';
        }
    }
}

static GLuint compile(bool is_es, GLenum type, const gl_program_source *source)
{
    bool is_vertex = type == GL_VERTEX_SHADER;
    const char *const *pieces = is_vertex ? source->vertex : source->fragment;
    const char *text[1 + GL_PROGRAM_PIECES] = {preamble(is_es)};
    for (int i = 0; i < GL_PROGRAM_PIECES; i++) {
        text[1 + i] = pieces[i] != NULL ? pieces[i] : "";
    }
    GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1 + GL_PROGRAM_PIECES, text, NULL);
    glCompileShader(shader);
    GLint is_compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled != GL_TRUE) {
        char log[512] = "";
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        cut_to_one_line(log);
        (void)rlf_fail(RLF_ERROR_DEVICE,
                       "OpenGL: %s shader of '%s' does not compile: %s: use --renderer soft",
                       is_vertex ? "vertex" : "fragment", source->name, log);
        glDeleteShader(shader);
        return 0;
    }
    return shader;
}

static GLuint link(GLuint vertex, GLuint fragment, const char *name)
{
    GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    GLint is_linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
    if (is_linked != GL_TRUE) {
        char log[512] = "";
        glGetProgramInfoLog(program, sizeof log, NULL, log);
        cut_to_one_line(log);
        (void)rlf_fail(RLF_ERROR_DEVICE,
                       "OpenGL: program '%s' does not link: %s: use --renderer soft", name, log);
        glDeleteProgram(program);
        return 0;
    }
    return program;
}

GLuint gl_program_build(bool is_es, const gl_program_source *source)
{
    GLuint vertex = compile(is_es, GL_VERTEX_SHADER, source);
    if (vertex == 0) {
        return 0;
    }
    GLuint program = 0;
    GLuint fragment = compile(is_es, GL_FRAGMENT_SHADER, source);
    if (fragment != 0) {
        program = link(vertex, fragment, source->name);
        glDeleteShader(fragment);
    }
    glDeleteShader(vertex);
    return program;
}
