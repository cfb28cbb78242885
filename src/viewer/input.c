/* What keys, mouse and dropped files ask for. */
#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>

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
    case GLFW_KEY_F: viewer_screen_toggle(window); break;
    case GLFW_KEY_I: wishes->toggle_overlay = true; break;
    case GLFW_KEY_Y: wishes->toggle_mirror = true; break;
    case GLFW_KEY_M: wishes->toggle_panel = true; break;
    case GLFW_KEY_L: wishes->next_end = true; break;
    case GLFW_KEY_G: wishes->next_shape = true; break;
    case GLFW_KEY_DELETE: wishes->delete_body = true; break;
    case GLFW_KEY_T:
        glfwGetCursorPos(window->handle, &x, &y);
        wish_throw(window, x, y, 0.0);
        break;
    case GLFW_KEY_ESCAPE: wishes->leave = true; break;
    case GLFW_KEY_Q: glfwSetWindowShouldClose(window->handle, GLFW_TRUE); break;
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

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int modifiers)
{
    (void)scancode;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    bool is_other_command = (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;
    window->wishes.refresh = true;
    if (action == GLFW_PRESS && window->tap_count < VIEWER_TAPS_MAX) {
        window->taps[window->tap_count++] = key;
    }
    if (!is_other_command && !window->is_key_taken &&
        (action == GLFW_PRESS || (action == GLFW_REPEAT && repeats(key)))) {
        window->wishes.is_fine = (modifiers & GLFW_MOD_SHIFT) != 0;
        take_key(window, key);
    }
}

static bool is_over_panel(const viewer_window *window)
{
    int width = 0;
    int height = 0;
    double x;
    double y;
    glfwGetWindowSize(window->handle, &width, &height);
    glfwGetCursorPos(window->handle, &x, &y);
    return window->is_list_open || (window->panel_width > 0 && x >= width - window->panel_width);
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    (void)modifiers;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    window->wishes.refresh = true;
    if (action == GLFW_PRESS && is_over_panel(window)) {
        window->is_key_taken = true; /* until the panel is drawn and knows better */
        return;
    }
    if (button == GLFW_MOUSE_BUTTON_MIDDLE && action == GLFW_PRESS) {
        window->wishes.delete_body = true;
    }
    if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        window->is_turning = action == GLFW_PRESS;
        glfwGetCursorPos(handle, &window->turned_x, &window->turned_y);
    }
    if (button != GLFW_MOUSE_BUTTON_LEFT) {
        return;
    }
    if (action != GLFW_PRESS) {
        window->is_held = false;
    }
    if (action == GLFW_PRESS) {
        window->is_key_taken = false; /* it leaves the control that had the focus */
        glfwGetCursorPos(handle, &window->press_x, &window->press_y);
        window->is_dragging = true;
        window->wishes.press = true;
        window->wishes.press_x = window->press_x;
        window->wishes.press_y = window->press_y;
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
    window->wishes.refresh = window->wishes.refresh || window->follows_mouse;
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
    window->wishes.refresh = true;
    window->wishes.zoom += is_over_panel(window) ? 0.0 : y;
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

static void on_drop(GLFWwindow *handle, int count, const char **paths)
{
    viewer_window *window = glfwGetWindowUserPointer(handle);
    if (count > 0) {
        window->wishes.has_drop = true;
        (void)snprintf(window->wishes.drop, sizeof window->wishes.drop, "%s", paths[0]);
    }
}

void viewer_window_take_input(viewer_window *window)
{
    glfwSetKeyCallback(window->handle, on_key);
    glfwSetMouseButtonCallback(window->handle, on_button);
    glfwSetCursorPosCallback(window->handle, on_cursor);
    glfwSetScrollCallback(window->handle, on_scroll);
    glfwSetWindowRefreshCallback(window->handle, on_refresh);
    glfwSetFramebufferSizeCallback(window->handle, on_framebuffer_size);
    glfwSetDropCallback(window->handle, on_drop);
}
