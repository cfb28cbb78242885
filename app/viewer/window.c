/* GLFW: the window and its context. */
#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Remembers GLFW's last complaint for our own error line. */
static char glfw_message[256];

static void note_error(int code, const char *description)
{
    (void)snprintf(glfw_message, sizeof glfw_message, "%s (0x%x)", description, (unsigned)code);
}

/* ---- open and close ------------------------------------------------------------------------- */

static void hint_core(void)
{
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

static void hint_es(void)
{
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
}

/* The picture's size, or the largest of its proportions that leaves the desktop some room. */
static void fit_to_desktop(int32_t *width, int32_t *height)
{
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor != NULL ? glfwGetVideoMode(monitor) : NULL;
    if (mode == NULL) {
        return;
    }
    double scale_x = 0.9 * mode->width / *width;
    double scale_y = 0.85 * mode->height / *height;
    double scale = scale_x < scale_y ? scale_x : scale_y;
    if (scale < 1.0) {
        *width = (int32_t)(*width * scale) + 1;
        *height = (int32_t)(*height * scale) + 1;
    }
}

rlf_result viewer_window_open(const char *title, int32_t width, int32_t height, viewer_window *out)
{
    *out = (viewer_window){0};
    out->wishes.view = -1;
    glfw_message[0] = '\0';
    glfwSetErrorCallback(note_error);
    if (!glfwInit()) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "window: no display to open one on: %s: set DISPLAY or add --headless",
                        glfw_message);
    }
    fit_to_desktop(&width, &height);
    hint_core();
    out->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    if (out->handle == NULL) {
        hint_es();
        out->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    }
    if (out->handle == NULL) {
        glfwTerminate();
        return rlf_fail(RLF_ERROR_DEVICE,
                        "window: this display offers neither OpenGL 3.3 nor ES 3.0: %s: install a "
                        "driver or add --headless",
                        glfw_message);
    }
    glfwSetWindowUserPointer(out->handle, out);
    viewer_window_take_input(out);
    viewer_screen_watch(out);
    glfwMakeContextCurrent(out->handle);
    glfwSwapInterval(1);
    return RLF_OK;
}

void viewer_window_close(viewer_window *window)
{
    if (window->handle != NULL) {
        viewer_screen_forget();
        glfwDestroyWindow(window->handle);
        window->handle = NULL;
        glfwTerminate();
    }
}

/* ---- the rest ------------------------------------------------------------------------------- */

bool viewer_window_is_software_gl(const viewer_window *window)
{
    (void)window;
    union {
        GLFWglproc any;
        const GLubyte *(*get_string)(GLenum name);
    } proc = {glfwGetProcAddress("glGetString")};
    const char *name = proc.any != NULL ? (const char *)proc.get_string(GL_RENDERER) : NULL;
    return name != NULL && (strstr(name, "llvmpipe") != NULL || strstr(name, "softpipe") != NULL);
}

bool viewer_window_should_close(const viewer_window *window)
{
    return glfwWindowShouldClose(window->handle) == GLFW_TRUE;
}

void viewer_window_poll(viewer_window *window, double timeout_s)
{
    (void)window;
    if (timeout_s > 0.0) {
        glfwWaitEventsTimeout(timeout_s);
    } else {
        glfwPollEvents();
    }
}

void viewer_window_get_framebuffer_size(const viewer_window *window, int32_t *out_width,
                                        int32_t *out_height)
{
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window->handle, &width, &height);
    *out_width = width;
    *out_height = height;
}

void viewer_window_get_size(const viewer_window *window, int32_t *out_width, int32_t *out_height)
{
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window->handle, &width, &height);
    *out_width = width;
    *out_height = height;
}

void viewer_window_get_cursor(const viewer_window *window, double *out_x, double *out_y)
{
    glfwGetCursorPos(window->handle, out_x, out_y);
}

void viewer_window_swap(viewer_window *window)
{
    glfwSwapBuffers(window->handle);
}
