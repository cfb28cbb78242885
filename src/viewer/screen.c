/* Full screen on any monitor, and monitors that go. */
#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <stdio.h>

#define POINTER_NS 2000000000 /* of rest, before the pointer of a full screen hides */

static viewer_window *watched; /* GLFW tells of monitors without saying for which window */

static GLFWmonitor *find(int32_t number)
{
    int count = 0;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    return number > 0 && number <= count ? monitors[number - 1] : glfwGetPrimaryMonitor();
}

static rlf_result fail_number(int32_t number)
{
    char list[256] = "";
    size_t used = 0;
    int count = 0;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count && used < sizeof list; i++) {
        const GLFWvidmode *mode = glfwGetVideoMode(monitors[i]);
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%d is %s, %d x %d",
                                 i > 0 ? "; " : "", i + 1, glfwGetMonitorName(monitors[i]),
                                 mode != NULL ? mode->width : 0, mode != NULL ? mode->height : 0);
    }
    return rlf_fail(RLF_ERROR_INVALID, "window: there is no monitor %d: %s", (int)number, list);
}

/* A window that is not full screen goes to the middle of the monitor's free part. */
static void move_to(viewer_window *window, GLFWmonitor *monitor)
{
    int x, y, width, height, own_width, own_height;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    glfwGetWindowSize(window->handle, &own_width, &own_height);
    const int left = width > own_width ? (width - own_width) / 2 : 0;
    const int top = height > own_height ? (height - own_height) / 2 : 0;
    glfwSetWindowPos(window->handle, x + left, y + top);
}

rlf_result viewer_screen_choose(viewer_window *window, int32_t number)
{
    int count = 0;
    (void)glfwGetMonitors(&count);
    if (number < 0 || number > count) {
        return fail_number(number);
    }
    window->screen_number = number;
    if (number > 0 && !viewer_screen_is_full(window)) {
        move_to(window, find(number));
    }
    return RLF_OK;
}

bool viewer_screen_is_full(const viewer_window *window)
{
    return window->screen != NULL;
}

static void leave(viewer_window *window)
{
    const int32_t *w = window->windowed;
    window->screen = NULL;
    glfwSetWindowMonitor(window->handle, NULL, w[0], w[1], w[2], w[3], GLFW_DONT_CARE);
}

void viewer_screen_toggle(viewer_window *window)
{
    int32_t *w = window->windowed;
    if (viewer_screen_is_full(window)) {
        leave(window);
        return;
    }
    GLFWmonitor *monitor = find(window->screen_number);
    const GLFWvidmode *mode = monitor != NULL ? glfwGetVideoMode(monitor) : NULL;
    if (mode == NULL) {
        return;
    }
    glfwGetWindowPos(window->handle, &w[0], &w[1]);
    glfwGetWindowSize(window->handle, &w[2], &w[3]);
    window->screen = monitor;
    /* A projector goes on while its user works on the other monitor. */
    glfwSetWindowAttrib(window->handle, GLFW_AUTO_ICONIFY, GLFW_FALSE);
    glfwSetWindowMonitor(window->handle, monitor, 0, 0, mode->width, mode->height,
                         mode->refreshRate);
}

void viewer_screen_hide_pointer(viewer_window *window, int64_t now_ns)
{
    const bool is_hidden = viewer_screen_is_full(window) && now_ns - window->moved_ns > POINTER_NS;
    if (is_hidden != window->is_pointer_hidden) {
        glfwSetInputMode(window->handle, GLFW_CURSOR,
                         is_hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
        window->is_pointer_hidden = is_hidden;
    }
}

static void on_monitor(GLFWmonitor *monitor, int event)
{
    if (watched == NULL || event != GLFW_DISCONNECTED || watched->screen != monitor) {
        return;
    }
    watched->screen_number = 0;
    leave(watched);
    if (glfwGetPrimaryMonitor() != NULL) {
        move_to(watched, glfwGetPrimaryMonitor());
    }
    watched->commands.is_screen_lost = true;
}

void viewer_screen_watch(viewer_window *window)
{
    watched = window;
    glfwSetMonitorCallback(on_monitor);
}

void viewer_screen_forget(void)
{
    watched = NULL;
    glfwSetMonitorCallback(NULL);
}
