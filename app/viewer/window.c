/* GLFW: window, keys and mouse. */
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

/* ---- input ---------------------------------------------------------------------------------- */

static void toggle_fullscreen(viewer_window *window)
{
    int32_t *w = window->windowed;
    if (glfwGetWindowMonitor(window->handle) != NULL) {
        glfwSetWindowMonitor(window->handle, NULL, w[0], w[1], w[2], w[3], GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor != NULL ? glfwGetVideoMode(monitor) : NULL;
    if (mode == NULL) {
        return;
    }
    glfwGetWindowPos(window->handle, &w[0], &w[1]);
    glfwGetWindowSize(window->handle, &w[2], &w[3]);
    glfwSetWindowMonitor(window->handle, monitor, 0, 0, mode->width, mode->height,
                         mode->refreshRate);
}

static void wish_throw(viewer_window *window, double x, double y, double drag_fraction)
{
    window->wishes.throw_body = true;
    window->wishes.throw_x = x;
    window->wishes.throw_y = y;
    window->wishes.throw_drag_fraction = drag_fraction;
}

static void take_place_key(viewer_wishes *wishes, int key)
{
    switch (key) {
    case GLFW_KEY_TAB: wishes->next_object = true; break;
    case GLFW_KEY_X: wishes->skip_point = true; break;
    case GLFW_KEY_BACKSPACE: wishes->undo_points = true; break;
    case GLFW_KEY_ENTER: wishes->solve_points = true; break;
    case GLFW_KEY_S: wishes->save_scene = true; break;
    case GLFW_KEY_LEFT: wishes->nudge_x--; break;
    case GLFW_KEY_RIGHT: wishes->nudge_x++; break;
    case GLFW_KEY_UP: wishes->nudge_y--; break;
    case GLFW_KEY_DOWN: wishes->nudge_y++; break;
    case GLFW_KEY_PAGE_UP: wishes->nudge_z++; break;
    case GLFW_KEY_PAGE_DOWN: wishes->nudge_z--; break;
    case GLFW_KEY_LEFT_BRACKET: wishes->nudge_turn--; break;
    case GLFW_KEY_RIGHT_BRACKET: wishes->nudge_turn++; break;
    default: break;
    }
}

/* Steps and moves repeat while their key is held. */
static bool repeats(int key)
{
    return key == GLFW_KEY_N || key == GLFW_KEY_PERIOD ||
           (key >= GLFW_KEY_RIGHT && key <= GLFW_KEY_PAGE_DOWN) || key == GLFW_KEY_LEFT_BRACKET ||
           key == GLFW_KEY_RIGHT_BRACKET;
}

static void take_key(viewer_window *window, int key)
{
    viewer_wishes *wishes = &window->wishes;
    double x;
    double y;
    switch (key) {
    case GLFW_KEY_SPACE: wishes->toggle_pause = true; break;
    case GLFW_KEY_N:
    case GLFW_KEY_PERIOD: wishes->step = true; break;
    case GLFW_KEY_R: wishes->restart = true; break;
    case GLFW_KEY_H: wishes->toggle_help = true; break;
    case GLFW_KEY_V: wishes->next_view = true; break;
    case GLFW_KEY_P: wishes->save_picture = true; break;
    case GLFW_KEY_E: wishes->toggle_record = true; break;
    case GLFW_KEY_F: toggle_fullscreen(window); break;
    case GLFW_KEY_T:
        glfwGetCursorPos(window->handle, &x, &y);
        wish_throw(window, x, y, 0.0);
        break;
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(window->handle, GLFW_TRUE); break;
    case GLFW_KEY_0: wishes->view = 9; break;
    case GLFW_KEY_O: wishes->view = 10; break;
    case GLFW_KEY_C: wishes->view = 11; break;
    case GLFW_KEY_B: wishes->toggle_beside = true; break;
    case GLFW_KEY_K: wishes->toggle_place = true; break;
    default:
        take_place_key(wishes, key);
        if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
            wishes->view = key - GLFW_KEY_1;
        }
        break;
    }
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int modifiers)
{
    (void)scancode;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    bool is_other_command = (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;
    if (!is_other_command && (action == GLFW_PRESS || (action == GLFW_REPEAT && repeats(key)))) {
        window->wishes.is_fine = (modifiers & GLFW_MOD_SHIFT) != 0;
        take_key(window, key);
    }
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    (void)modifiers;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        window->is_turning = action == GLFW_PRESS;
        glfwGetCursorPos(handle, &window->turned_x, &window->turned_y);
    }
    if (button != GLFW_MOUSE_BUTTON_LEFT) {
        return;
    }
    if (action == GLFW_PRESS) {
        glfwGetCursorPos(handle, &window->press_x, &window->press_y);
        window->is_dragging = true;
    } else if (window->is_dragging) {
        wish_throw(window, window->press_x, window->press_y, viewer_window_get_drag(window));
        window->is_dragging = false;
    }
}

static void on_cursor(GLFWwindow *handle, double x, double y)
{
    viewer_window *window = glfwGetWindowUserPointer(handle);
    int width = 0;
    int height = 0;
    glfwGetWindowSize(handle, &width, &height);
    if (window->is_turning && height > 0) {
        window->wishes.turn_x += (x - window->turned_x) / height;
        window->wishes.turn_y += (y - window->turned_y) / height;
        window->turned_x = x;
        window->turned_y = y;
    }
}

static void on_scroll(GLFWwindow *handle, double x, double y)
{
    (void)x;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    window->wishes.zoom += y;
}

static void on_refresh(GLFWwindow *handle)
{
    viewer_window *window = glfwGetWindowUserPointer(handle);
    window->wishes.refresh = true;
}

static void on_framebuffer_size(GLFWwindow *handle, int width, int height)
{
    (void)width;
    (void)height;
    on_refresh(handle);
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

static void set_callbacks(viewer_window *window)
{
    glfwSetWindowUserPointer(window->handle, window);
    glfwSetKeyCallback(window->handle, on_key);
    glfwSetMouseButtonCallback(window->handle, on_button);
    glfwSetCursorPosCallback(window->handle, on_cursor);
    glfwSetScrollCallback(window->handle, on_scroll);
    glfwSetWindowRefreshCallback(window->handle, on_refresh);
    glfwSetFramebufferSizeCallback(window->handle, on_framebuffer_size);
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
    set_callbacks(out);
    glfwMakeContextCurrent(out->handle);
    glfwSwapInterval(1);
    return RLF_OK;
}

void viewer_window_close(viewer_window *window)
{
    if (window->handle != NULL) {
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

double viewer_window_get_drag(const viewer_window *window)
{
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window->handle, &width, &height);
    if (!window->is_dragging || height < 1) {
        return -1.0;
    }
    double x;
    double y;
    glfwGetCursorPos(window->handle, &x, &y);
    double dx = x - window->press_x;
    double dy = y - window->press_y;
    return sqrt(dx * dx + dy * dy) / height;
}

void viewer_window_swap(viewer_window *window)
{
    glfwSwapBuffers(window->handle);
}
