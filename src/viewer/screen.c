/* Full screen on any monitor, and monitors that go. */
#include "viewer/window.h"

#include "relief/math.h"

#include <GLFW/glfw3.h>
#include <stdio.h>

#define POINTER_NS 2000000000 /* of rest, before the pointer of a full screen hides */

static viewer_window *watched; /* GLFW tells of monitors without saying for which window */

/* The one that most of the window is on. */
static GLFWmonitor *find_under(const viewer_window *window, GLFWmonitor **monitors, int count)
{
    int x, y, width, height, most = 0;
    GLFWmonitor *found = glfwGetPrimaryMonitor();
    glfwGetWindowPos(window->handle, &x, &y);
    glfwGetWindowSize(window->handle, &width, &height);
    for (int i = 0; i < count; i++) {
        int left, top;
        const GLFWvidmode *mode = glfwGetVideoMode(monitors[i]);
        glfwGetMonitorPos(monitors[i], &left, &top);
        const int wide =
            mode == NULL ? 0 : (int)(rlf_min(x + width, left + mode->width) - rlf_max(x, left));
        const int high =
            mode == NULL ? 0 : (int)(rlf_min(y + height, top + mode->height) - rlf_max(y, top));
        if (wide > 0 && high > 0 && wide * high > most) {
            most = wide * high;
            found = monitors[i];
        }
    }
    return found;
}

static GLFWmonitor *find(const viewer_window *window)
{
    int count = 0;
    const int32_t number = window->screen_number;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    return number > 0 && number <= count ? monitors[number - 1]
                                         : find_under(window, monitors, count);
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
        move_to(window, find(window));
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
    GLFWmonitor *monitor = find(window);
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

void viewer_screen_settle(viewer_window *window, int64_t now_ns)
{
    if (window->is_full_due) {
        window->is_full_due = false;
        if (viewer_screen_is_full(window) && window->screen != find(window)) {
            leave(window);
        }
        if (!viewer_screen_is_full(window)) {
            viewer_screen_toggle(window);
        }
    }
    const bool rests = window->is_kiosk || now_ns - window->moved_ns > POINTER_NS;
    const bool is_hidden = viewer_screen_is_full(window) && rests && !window->needs_pointer;
    if (is_hidden != window->is_pointer_hidden) {
        glfwSetInputMode(window->handle, GLFW_CURSOR,
                         is_hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
        window->is_pointer_hidden = is_hidden;
    }
}

static void on_monitor(GLFWmonitor *monitor, int event)
{
    if (watched == NULL) {
        return;
    }
    watched->is_full_due = watched->is_kiosk;
    if (event != GLFW_DISCONNECTED || watched->screen != monitor) {
        return;
    }
    rlf_log(RLF_LOG_WARNING, "window: the monitor of the full screen is gone");
    watched->screen_number = watched->is_kiosk ? watched->screen_number : 0;
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
