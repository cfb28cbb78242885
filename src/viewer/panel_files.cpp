/* A small list of files to choose one from. */
#include "viewer/panel_parts.h"

#define ROWS 16        /* that are shown at a time */
#define LETTERS 26.0f  /* of a row, in heights of a letter */

void panel_files_open(panel_files *f, panel_request what, const char *endings)
{
    f->what = what;
    f->endings = endings;
    f->is_due = viewer_files_enter(&f->files, "", endings);
}

/* True: `f->path` was chosen. */
static bool draw_rows(panel_files *f)
{
    const char *entered = nullptr;
    bool is_chosen = false;
    if (ImGui::IsWindowAppearing()) {
        ImGui::SetNextWindowFocus(); /* arrows begin in the list */
    }
    ImGui::BeginChild("rows", ImVec2(LETTERS * ImGui::GetFontSize(), ROWS * ImGui::GetTextLineHeightWithSpacing()));
    if (ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups)) {
        entered = "..";
    }
    ImGui::SetItemDefaultFocus();
    for (int i = 0; i < f->files.count; i++) {
        const viewer_file *file = &f->files.list[i];
        ImGui::PushID(i);
        if (ImGui::Selectable("##row", false, ImGuiSelectableFlags_DontClosePopups)) {
            entered = file->is_folder ? file->name : nullptr;
            is_chosen = !file->is_folder && viewer_files_path(&f->files, file->name, f->path);
        }
        ImGui::PopID();
        ImGui::SameLine(0.3f * ImGui::GetFontSize());
        ImGui::Text("%s%s", file->name, file->is_folder ? "/" : "");
    }
    ImGui::EndChild();
    if (entered != nullptr) {
        (void)viewer_files_enter(&f->files, entered, f->endings);
    }
    return is_chosen;
}

bool panel_files_draw(panel_files *f)
{
    bool is_chosen = false;
    if (f->is_due) {
        ImGui::OpenPopup("files");
        f->is_due = false;
    }
    if (!ImGui::BeginPopup("files")) {
        return false;
    }
    ImGui::PushTextWrapPos(LETTERS * ImGui::GetFontSize());
    panel_note(f->files.folder);
    ImGui::PopTextWrapPos();
    is_chosen = draw_rows(f);
    if (f->what == PANEL_SOURCE && ImGui::Button("Open this folder")) {
        is_chosen = viewer_files_path(&f->files, "", f->path);
    }
    if (f->what == PANEL_SOURCE) {
        ImGui::SameLine();
    }
    if (ImGui::Button("Close") || is_chosen) {
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return is_chosen;
}

bool panel_files_button(void)
{
    ImGui::SameLine();
    const bool is_pressed = ImGui::Button("...");
    panel_tip("choose it from a list");
    return is_pressed;
}

float panel_files_button_width(void)
{
    const ImGuiStyle &style = ImGui::GetStyle();
    return ImGui::CalcTextSize("...").x + 2.0f * style.FramePadding.x + style.ItemSpacing.x;
}
