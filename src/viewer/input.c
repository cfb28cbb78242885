/* What keys, mouse and dropped files ask for. */
#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <math.h>
#include <stdio.h>

static void command_throw(viewer_window *window, double x, double y, double drag_fraction)
{
    window->commands.throw_body = true;
    window->commands.throw_x = x;
    window->commands.throw_y = y;
    window->commands.throw_drag_fraction = drag_fraction;
}

static void take_place_key(viewer_commands *commands, int key)
{
    switch (key) {
    case GLFW_KEY_TAB: commands->next_object = true; break;
    case GLFW_KEY_X: commands->skip_point = true; break;
    case GLFW_KEY_BACKSPACE: commands->undo_points = true; break;
    case GLFW_KEY_ENTER: commands->solve_points = true; break;
    case GLFW_KEY_S: commands->save_scene = true; break;
    case GLFW_KEY_LEFT: commands->nudge_x--; break;
    case GLFW_KEY_RIGHT: commands->nudge_x++; break;
    case GLFW_KEY_UP: commands->nudge_y--; break;
    case GLFW_KEY_DOWN: commands->nudge_y++; break;
    case GLFW_KEY_PAGE_UP: commands->nudge_z++; break;
    case GLFW_KEY_PAGE_DOWN: commands->nudge_z--; break;
    case GLFW_KEY_LEFT_BRACKET: commands->nudge_turn--; break;
    case GLFW_KEY_RIGHT_BRACKET: commands->nudge_turn++; break;
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
    viewer_commands *commands = &window->commands;
    double x;
    double y;
    switch (key) {
    case GLFW_KEY_SPACE: commands->toggle_pause = true; break;
    case GLFW_KEY_N:
    case GLFW_KEY_PERIOD: commands->step = true; break;
    case GLFW_KEY_R: commands->restart = true; break;
    case GLFW_KEY_H: commands->toggle_help = true; break;
    case GLFW_KEY_V: commands->next_view = true; break;
    case GLFW_KEY_P: commands->save_picture = true; break;
    case GLFW_KEY_E: commands->toggle_record = true; break;
    case GLFW_KEY_F: viewer_screen_toggle(window); break;
    case GLFW_KEY_I: commands->toggle_overlay = true; break;
    case GLFW_KEY_Y: commands->toggle_mirror = true; break;
    case GLFW_KEY_M: commands->toggle_panel = true; break;
    case GLFW_KEY_L: commands->next_end = true; break;
    case GLFW_KEY_G: commands->next_shape = true; break;
    case GLFW_KEY_DELETE: commands->delete_body = true; break;
    case GLFW_KEY_T:
        glfwGetCursorPos(window->handle, &x, &y);
        command_throw(window, x, y, 0.0);
        break;
    case GLFW_KEY_ESCAPE: commands->leave = true; break;
    case GLFW_KEY_Q: glfwSetWindowShouldClose(window->handle, GLFW_TRUE); break;
    case GLFW_KEY_0: commands->view = 9; break;
    case GLFW_KEY_O: commands->view = 10; break;
    case GLFW_KEY_C: commands->view = 11; break;
    case GLFW_KEY_A: commands->view = 15; break;
    case GLFW_KEY_U: commands->bring_back = true; break;
    case GLFW_KEY_W: commands->toggle_fill = true; break;
    case GLFW_KEY_D: commands->toggle_corners = true; break;
    case GLFW_KEY_B: commands->toggle_beside = true; break;
    case GLFW_KEY_K: commands->toggle_place = true; break;
    default:
        take_place_key(commands, key);
        if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
            commands->view = key - GLFW_KEY_1;
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
    window->commands.refresh = true;
    if (action == GLFW_PRESS && window->tap_count < VIEWER_TAPS_MAX) {
        window->taps[window->tap_count++] = key;
    }
    if (key == GLFW_KEY_O && (modifiers & GLFW_MOD_CONTROL) != 0 && action == GLFW_PRESS &&
        !window->is_key_taken) {
        window->commands.open_files = true;
    }
    if (key == GLFW_KEY_Z && (modifiers & GLFW_MOD_CONTROL) != 0 && action == GLFW_PRESS &&
        !window->is_key_taken) {
        window->commands.bring_back = true;
    }
    if (!is_other_command && !window->is_key_taken &&
        (action == GLFW_PRESS || (action == GLFW_REPEAT && repeats(key)))) {
        window->commands.is_fine = (modifiers & GLFW_MOD_SHIFT) != 0;
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
    window->commands.refresh = true;
    if (action == GLFW_PRESS && is_over_panel(window)) {
        window->is_key_taken = true; /* until the panel is drawn and knows better */
        return;
    }
    if (button == GLFW_MOUSE_BUTTON_MIDDLE && action == GLFW_PRESS) {
        window->commands.delete_body = true;
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
        window->commands.press = true;
        window->commands.press_x = window->press_x;
        window->commands.press_y = window->press_y;
    } else if (window->is_dragging) {
        command_throw(window, window->press_x, window->press_y, viewer_window_get_drag(window));
        window->is_dragging = false;
    }
}

static void on_cursor(GLFWwindow *handle, double x, double y)
{
    viewer_window *window = glfwGetWindowUserPointer(handle);
    int width = 0;
    int height = 0;
    glfwGetWindowSize(handle, &width, &height);
    window->commands.refresh = window->commands.refresh || window->follows_mouse;
    window->moved_ns = rlf_clock_ns();
    if (window->is_turning && height > 0) {
        window->commands.turn_x += (x - window->turned_x) / height;
        window->commands.turn_y += (y - window->turned_y) / height;
        window->turned_x = x;
        window->turned_y = y;
    }
}

static void on_scroll(GLFWwindow *handle, double x, double y)
{
    (void)x;
    viewer_window *window = glfwGetWindowUserPointer(handle);
    window->commands.refresh = true;
    window->commands.zoom += is_over_panel(window) ? 0.0 : y;
}

static void on_refresh(GLFWwindow *handle)
{
    viewer_window *window = glfwGetWindowUserPointer(handle);
    window->commands.refresh = true;
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
        window->commands.has_drop = true;
        (void)snprintf(window->commands.drop, sizeof window->commands.drop, "%s", paths[0]);
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
