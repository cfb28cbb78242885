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

/* The picture's size, or the largest of its proportions that leaves the desktop some room; the
 * panel has its own size beside it, enlarged as text is on this desktop. */
static void fit_to_desktop(const viewer_window_size *wanted, int32_t *out_width,
                           int32_t *out_height)
{
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor != NULL ? glfwGetVideoMode(monitor) : NULL;
    float text_scale = 1.0f;
    float text_scale_y = 1.0f;
    *out_width = wanted->width + wanted->panel_width;
    *out_height = wanted->height > wanted->panel_height ? wanted->height : wanted->panel_height;
    if (mode == NULL) {
        return;
    }
    glfwGetMonitorContentScale(monitor, &text_scale, &text_scale_y);
    const double panel_width = wanted->panel_width * (double)text_scale;
    const double panel_height = wanted->panel_height * (double)text_scale;
    const double width_max = 0.9 * mode->width - panel_width;
    const double height_max = 0.85 * mode->height;
    double scale = width_max / wanted->width;
    scale = height_max < scale * wanted->height ? height_max / wanted->height : scale;
    scale = scale < 1.0 ? scale : 1.0;
    double height = scale * wanted->height > panel_height ? scale * wanted->height : panel_height;
    height = height < height_max ? height : height_max;
    *out_width = (int32_t)(scale * wanted->width + panel_width + 0.5);
    *out_height = (int32_t)(height + 0.5);
}

rlf_result viewer_window_open(const char *title, const viewer_window_size *size, viewer_window *out)
{
    int32_t width;
    int32_t height;
    *out = (viewer_window){0};
    out->commands.view = -1;
    glfw_message[0] = '\0';
    glfwSetErrorCallback(note_error);
    if (!glfwInit()) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "window: no display to open one on: %s: set DISPLAY or add --headless",
                        glfw_message);
    }
    fit_to_desktop(size, &width, &height);
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

void viewer_window_leave(viewer_window *window)
{
    if (viewer_screen_is_full(window)) {
        viewer_screen_toggle(window);
    } else {
        glfwSetWindowShouldClose(window->handle, GLFW_TRUE);
    }
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
