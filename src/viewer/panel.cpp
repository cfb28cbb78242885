/* The panel: its life, its place and what it asks for. */
#include "viewer/panel_parts.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <stdio.h>
#include <string.h>

#define MESSAGE_ROWS 5

bool viewer_panel_is_built(void)
{
    return true;
}

viewer_panel *viewer_panel_create(struct viewer *v)
{
    viewer_panel *p = (viewer_panel *)rlf_alloc(sizeof *p);
    if (p != nullptr && !panel_context_open(v->window.handle)) {
        rlf_free(p);
        p = nullptr;
    }
    if (p != nullptr) {
        p->v = v;
        p->down = rlf_vec3_make(0.0, 1.0, 0.0);
    }
    return p;
}

void viewer_panel_destroy(viewer_panel **panel)
{
    if (*panel == nullptr) {
        return;
    }
    panel_context_close();
    rlf_free(*panel);
    *panel = nullptr;
}

int32_t viewer_panel_get_width(const viewer_panel *panel)
{
    int32_t width, height;
    if (panel == nullptr) {
        return 0;
    }
    viewer_window_get_size(&panel->v->window, &width, &height);
    const int32_t own = (int32_t)(VIEWER_PANEL_WIDTH * (panel->style.scale > 0.0f ? panel->style.scale : 1.0f));
    return width >= 2 * own && height >= 100 ? own : 0;
}

void panel_ask_for(viewer_panel *p, panel_request request, const char *text)
{
    p->request = request;
    snprintf(p->request_text, sizeof p->request_text, "%s", text);
}

void panel_note(const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

/* Always there and always as high, so that a message moves no control. */
static void draw_messages(viewer_panel *p)
{
    const viewer *v = p->v;
    ImGui::Separator();
    ImGui::BeginChild("messages");
    panel_note(v->message_count > 0 ? "Messages, the newest first" : "Messages: none yet");
    for (int32_t i = 0; i < v->message_count; i++) {
        if (v->messages[i].is_error) {
            ImGui::PushStyleColor(ImGuiCol_Text, v->is_light ? ImVec4(0.75f, 0.1f, 0.0f, 1.0f)
                                                             : ImVec4(1.0f, 0.5f, 0.4f, 1.0f));
            ImGui::TextWrapped("%s", v->messages[i].text);
            ImGui::PopStyleColor();
        } else {
            panel_note(v->messages[i].text);
        }
    }
    ImGui::EndChild();
}

void panel_press_taps(viewer_window *window, bool is_before)
{
#if IMGUI_VERSION_NUM < 18700
    ImGuiIO &io = ImGui::GetIO();
    for (int32_t i = 0; i < window->tap_count; i++) {
        const int key = window->taps[i];
        if (key >= 0 && key < IM_ARRAYSIZE(io.KeysDown)) {
            io.KeysDown[key] = is_before || glfwGetKey(window->handle, key) == GLFW_PRESS;
        }
    }
#endif
    window->tap_count = is_before ? window->tap_count : 0;
}

/* Elsewhere keys are the window's. */
void panel_lead_list(bool is_open)
{
    ImGuiIO &io = ImGui::GetIO();
    if (!is_open) {
        io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
        return;
    }
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
#if IMGUI_VERSION_NUM < 18700
    const bool is_taken = io.KeysDown[GLFW_KEY_ENTER] || io.KeysDown[GLFW_KEY_KP_ENTER];
    io.NavInputs[ImGuiNavInput_Activate] = is_taken ? 1.0f : 0.0f;
#endif
}

static void draw_all(viewer_panel *p)
{
    const struct {
        const char *title;
        void (*draw)(viewer_panel *p);
        bool is_open;
    } parts[] = {{"Source and scene", panel_draw_source, true},
                 {"Bodies", panel_draw_bodies, true},
                 {"Gravity", panel_draw_gravity, true},
                 {"View", panel_draw_view, true},
                 {"Record", panel_draw_record, true},
                 {"Stage times", panel_draw_times, true},
                 {"Surface settings", panel_draw_settings, false}};
    for (const auto &part : parts) {
        const ImGuiTreeNodeFlags flags = part.is_open ? ImGuiTreeNodeFlags_DefaultOpen : 0;
        if (ImGui::CollapsingHeader(part.title, flags)) {
            ImGui::PushID(part.title);
            part.draw(p);
            ImGui::PopID();
        }
    }
}

/* What was asked for replaces what the parts look at, so it comes after them. */
static void fulfil(viewer_panel *p)
{
    const panel_request request = p->request;
    p->request = PANEL_NOTHING;
    switch (request) {
    case PANEL_NOTHING: break;
    case PANEL_SOURCE: (void)viewer_open_stage(p->v, RLF_WINDOW_OPEN_SOURCE, p->request_text); break;
    case PANEL_SCENE: (void)viewer_open_stage(p->v, RLF_WINDOW_OPEN_SCENE, p->request_text); break;
    case PANEL_SETTING: (void)viewer_open_stage(p->v, RLF_WINDOW_OPEN_SETTING, p->request_text); break;
    case PANEL_MODEL: viewer_open_path(p->v, p->request_text); break;
    }
}

static void draw_controls(viewer_panel *p, int32_t own)
{
    int32_t width, height;
    viewer_window_get_size(&p->v->window, &width, &height);
    ImGui::SetNextWindowPos(ImVec2((float)(width - own), 0.0f));
    ImGui::SetNextWindowSize(ImVec2((float)own, (float)height));
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                     ImGuiWindowFlags_NoScrollWithMouse);
    const float rest = MESSAGE_ROWS * ImGui::GetTextLineHeightWithSpacing();
    /* Tab leads from one field to the next, but into the panel only the mouse leads. */
    ImGui::BeginChild("controls", ImVec2(0.0f, -rest), false,
                      p->v->window.is_key_taken ? 0 : ImGuiWindowFlags_NoNavInputs);
    draw_all(p);
    ImGui::EndChild();
    draw_messages(p);
    if (panel_files_draw(&p->files)) {
        panel_ask_for(p, p->files.what, p->files.path);
    }
    ImGui::End();
}

void viewer_panel_open_files(viewer_panel *p)
{
    panel_files_open(&p->files, PANEL_SOURCE, nullptr);
}

void viewer_panel_draw(viewer_panel *p)
{
    viewer_window *window = &p->v->window;
    const int32_t own = window->panel_width;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    panel_set_style(&p->style, window->handle, p->v->is_light, nullptr);
    panel_press_taps(window, true);
    panel_lead_list(window->is_list_open);
    ImGui::NewFrame();
    if (own > 0) {
        draw_controls(p, own);
    }
    panel_write_lines(p);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    panel_press_taps(window, false);
    window->is_list_open = own > 0 && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    window->is_key_taken = window->is_list_open || (own > 0 && ImGui::IsAnyItemActive());
    fulfil(p);
}
