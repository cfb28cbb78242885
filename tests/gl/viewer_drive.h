/* Drives the window as its user would: keys and clicks. Include after cmocka.h. */
#ifndef RLF_TEST_VIEWER_DRIVE_H
#define RLF_TEST_VIEWER_DRIVE_H

#include "test.h"
#include "relief/image.h"
#include "relief/math.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include <stdio.h>
#include <stdlib.h>

static inline bool has_display(void)
{
    if (getenv("DISPLAY") == NULL) {
        print_message("SKIPPED: no display (DISPLAY is not set)\n");
        return false;
    }
    return true;
}

static inline GLFWwindow *window(void)
{
    return glfwGetCurrentContext();
}

/* A hidden window of 200 x 200 pixels whose context is current. */
static inline GLFWwindow *open_hidden(void)
{
    assert_true(glfwInit());
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow *hidden = glfwCreateWindow(200, 200, "hidden", NULL, NULL);
    assert_non_null(hidden);
    glfwMakeContextCurrent(hidden);
    return hidden;
}

/* The window's monitor is unplugged, as GLFW tells it when it has left full screen by itself.
 * Returns whether the window was in full screen. */
static inline bool unplug_monitor(void)
{
    GLFWmonitor *monitor = glfwGetWindowMonitor(window());
    GLFWmonitorfun on_monitor = glfwSetMonitorCallback(NULL);
    glfwSetMonitorCallback(on_monitor);
    on_monitor(monitor, GLFW_DISCONNECTED);
    return monitor != NULL;
}

/* Presses a key as GLFW would report it. */
static inline void press(int key)
{
    GLFWkeyfun on_key = glfwSetKeyCallback(window(), NULL);
    glfwSetKeyCallback(window(), on_key);
    on_key(window(), key, 0, GLFW_PRESS, 0);
    on_key(window(), key, 0, GLFW_RELEASE, 0);
}

/* Clicks on a pixel of the picture. */
static inline void click_pixel(const rlf_image_rgba8 *image, const double pixel[2])
{
    int width, height;
    glfwGetWindowSize(window(), &width, &height);
    double scale = rlf_min((double)width / image->width, (double)height / image->height);
    double x = 0.5 * width + scale * (pixel[0] + 0.5 - 0.5 * image->width);
    double y = 0.5 * height + scale * (pixel[1] + 0.5 - 0.5 * image->height);
    glfwSetCursorPos(window(), x, y);
    GLFWmousebuttonfun on_button = glfwSetMouseButtonCallback(window(), NULL);
    glfwSetMouseButtonCallback(window(), on_button);
    on_button(window(), GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
    on_button(window(), GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
}

/* Where a pixel of the picture is in the window. */
static inline void point_at(const rlf_image_rgba8 *image, const double pixel[2])
{
    int width, height;
    glfwGetWindowSize(window(), &width, &height);
    double scale = rlf_min((double)width / image->width, (double)height / image->height);
    glfwSetCursorPos(window(), 0.5 * width + scale * (pixel[0] + 0.5 - 0.5 * image->width),
                     0.5 * height + scale * (pixel[1] + 0.5 - 0.5 * image->height));
}

static inline void button(int action)
{
    GLFWmousebuttonfun on_button = glfwSetMouseButtonCallback(window(), NULL);
    glfwSetMouseButtonCallback(window(), on_button);
    on_button(window(), GLFW_MOUSE_BUTTON_LEFT, action, 0);
}

/* Drops a file on the window. */
static inline void drop(const char *path)
{
    GLFWdropfun on_drop = glfwSetDropCallback(window(), NULL);
    glfwSetDropCallback(window(), on_drop);
    on_drop(window(), 1, &path);
}

#endif
