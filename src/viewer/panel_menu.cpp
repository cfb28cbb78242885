/* The start page's list, drawn by Dear ImGui. */
#include "viewer/panel_parts.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <stdio.h>
#include <string.h>

#define NAME_SHARE 0.24f /* of the list's width */
#define PICTURE_ROWS 3.0f /* of text, as high as a picture is */
#define MENU_WORD 100    /* room for a name */
#define MARGIN 0.06f     /* of the window, around the page */

struct viewer_menu {
    viewer_window *window;
    panel_style style;
    int32_t shown; /* the selected one when it was drawn last */
    panel_pictures pictures;
    panel_files files;
};

viewer_menu *viewer_menu_create(viewer_window *window)
{
    viewer_menu *menu = (viewer_menu *)rlf_alloc(sizeof *menu);
    if (menu != nullptr && !panel_context_open(window->handle)) {
        rlf_free(menu);
        menu = nullptr;
    }
    if (menu != nullptr) {
        menu->window = window;
        menu->shown = -1;
        window->follows_mouse = true;
    }
    return menu;
}

void viewer_menu_destroy(viewer_menu **menu)
{
    if (*menu == nullptr) {
        return;
    }
    panel_context_close();
    panel_pictures_free(&(*menu)->pictures);
    rlf_free(*menu);
    *menu = nullptr;
}

void viewer_menu_look(viewer_menu *menu, const rlf_window_choice *choices, int32_t count)
{
    panel_pictures_load(&menu->pictures, choices, count);
    menu->style.scale = 0.0f; /* the texture is made anew */
    menu->shown = -1;
}

/* What the texts of a kind begin with, and the title over the first of them. */
static const struct {
    const char *word, *title;
    bool has_name; /* "scene crowd: sixty cubes"; else "camera: the name" */
} kinds[] = {{"scene ", "Scenes", true},
             {"camera: ", "Cameras", false},
             {"recent: ", "Recent recordings", false}};

static const char *split(const char *text, char *out_name, const char **out_about)
{
    const char *title = "";
    *out_about = "";
    for (const auto &kind : kinds) {
        const size_t length = strlen(kind.word);
        if (strncmp(text, kind.word, length) != 0) {
            continue;
        }
        title = kind.title;
        text += length;
        const char *colon = kind.has_name ? strstr(text, ": ") : nullptr;
        if (colon != nullptr) {
            snprintf(out_name, MENU_WORD, "%.*s", (int)(colon - text), text);
            *out_about = colon + 2;
            return title;
        }
    }
    snprintf(out_name, MENU_WORD, "%s", text);
    return title;
}

/* What it is below its name, where a picture makes room; else beside it. */
static void write_words(const char *name, const char *about, bool is_below)
{
    ImGui::BeginGroup();
    ImGui::TextUnformatted(name);
    if (about[0] != '\0' && !is_below) {
        ImGui::SameLine(NAME_SHARE * ImGui::GetWindowWidth());
    }
    if (about[0] != '\0') {
        ImGui::TextDisabled("%s", about);
    }
    ImGui::EndGroup();
}

static bool draw_choice(const viewer_menu *menu, const rlf_window_choice *choice, int32_t index,
                        bool is_selected, const char **title)
{
    char name[MENU_WORD], number[4] = "";
    const char *about, *own = split(choice->text, name, &about);
    if (strcmp(own, *title) != 0) {
        ImGui::Spacing();
        panel_note(own);
        *title = own;
    }
    if (index < 9) {
        number[0] = (char)('1' + index);
    }
    const bool has_picture = menu->pictures.items[index].image.data != nullptr;
    const float height = has_picture ? PICTURE_ROWS * ImGui::GetTextLineHeight() : 0.0f;
    ImGui::PushID(index);
    ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyleColorVec4(ImGuiCol_HeaderHovered));
    const bool is_clicked = ImGui::Selectable("##choice", is_selected, 0, ImVec2(0.0f, height));
    ImGui::PopStyleColor();
    ImGui::PopID();
    if (is_selected && menu->shown != index) {
        ImGui::SetScrollHereY();
    }
    ImGui::SameLine(0.5f * ImGui::GetFontSize());
    ImGui::TextDisabled("%s", number);
    ImGui::SameLine(2.0f * ImGui::GetFontSize());
    if (has_picture && panel_pictures_draw(&menu->pictures, index, height)) {
        ImGui::SameLine();
    }
    write_words(name, about, has_picture);
    return is_clicked;
}

/* Any other file or folder becomes one more choice, the last. */
static int32_t draw_files(viewer_menu *menu, rlf_window_choice *choices, int32_t count)
{
    if (ImGui::SmallButton("Open a file or folder (O)")) {
        panel_files_open(&menu->files, PANEL_SOURCE, nullptr);
    }
    const bool is_chosen = panel_files_draw(&menu->files);
    if (!is_chosen || count == RLF_WINDOW_CHOICES_MAX) {
        return -1;
    }
    choices[count] = {};
    snprintf(choices[count].source, sizeof choices[count].source, "%s", menu->files.path);
    return count;
}

static int32_t draw_page(viewer_menu *menu, rlf_window_choice *choices, int32_t count, int32_t selected)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const char *title = "";
    int32_t clicked = -1;
    ImGui::SetNextWindowPos(ImVec2(MARGIN * size.x, MARGIN * size.y));
    ImGui::SetNextWindowSize(ImVec2((1.0f - 2.0f * MARGIN) * size.x, (1.0f - 2.0f * MARGIN) * size.y));
    ImGui::SetNextWindowBgAlpha(0.85f);
    ImGui::Begin("start", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
    ImGui::TextUnformatted("Relief: choose a camera, a recording or a scene");
    ImGui::Separator();
    ImGui::BeginChild("list", ImVec2(0.0f, -1.5f * ImGui::GetTextLineHeightWithSpacing()));
    for (int32_t i = 0; i < count; i++) {
        clicked = draw_choice(menu, &choices[i], i, i == selected, &title) ? i : clicked;
    }
    ImGui::EndChild();
    const int32_t other = draw_files(menu, choices, count);
    ImGui::SameLine();
    panel_note("Arrows and Enter, number or click    R  look again    Q  quit");
    ImGui::End();
    menu->shown = selected;
    return other >= 0 ? other : clicked;
}

void viewer_menu_open_files(viewer_menu *menu)
{
    panel_files_open(&menu->files, PANEL_SOURCE, nullptr);
}

int32_t viewer_menu_draw(viewer_menu *menu, rlf_window_choice *choices, int32_t count, int32_t selected)
{
    viewer_window *window = menu->window;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    panel_set_style(&menu->style, menu->window->handle, false, &menu->pictures);
    panel_press_taps(window, true);
    panel_lead_list(window->is_list_open);
    ImGui::NewFrame();
    const int32_t clicked = draw_page(menu, choices, count, selected);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    panel_press_taps(window, false);
    window->is_list_open = window->is_key_taken = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    return clicked;
}
