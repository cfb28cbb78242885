/* The panel's source, scene and recording. */
#include "viewer/panel_parts.h"

#include <stdio.h>
#include <string.h>

static void look(viewer_panel *p)
{
    const rlf_window_def *o = p->v->options;
    p->source_count = o->on_sources != nullptr ? o->on_sources(o->context, p->sources) : 0;
    p->scene_count = o->on_scenes != nullptr ? o->on_scenes(o->context, p->scenes) : 0;
    p->has_lists = true;
}

/* A list to choose from; what is typed below may be any other. */
static void draw_choices(viewer_panel *p, const char *label, const char *now,
                         const rlf_window_choice *choices, int count, panel_request request)
{
    panel_label(label, nullptr);
    ImGui::PushID(label);
    const bool is_open = ImGui::BeginCombo("##list", now);
    ImGui::PopID();
    if (!is_open) {
        return;
    }
    if (ImGui::IsWindowAppearing()) {
        look(p);
    }
    for (int i = 0; i < count; i++) {
        ImGui::PushID(i);
        if (ImGui::Selectable(choices[i].text)) {
            panel_ask_for(p, request, choices[i].source);
        }
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

static void draw_path(viewer_panel *p, const char *label, const char *hint, char *text,
                      panel_request request)
{
    panel_label(label, "type it and press Enter, or drop it on the window");
    ImGui::PushID(label);
    ImGui::SetNextItemWidth(-panel_files_button_width());
    const bool is_entered = ImGui::InputTextWithHint("##path", hint, text, RLF_WINDOW_SOURCE_SIZE,
                                                     ImGuiInputTextFlags_EnterReturnsTrue);
    if (panel_files_button()) {
        panel_files_open(&p->files, request, request == PANEL_SCENE ? ".json" : nullptr);
    }
    ImGui::PopID();
    if (is_entered && text[0] != '\0') {
        panel_ask_for(p, request, text);
    }
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != nullptr && slash[1] != '\0' ? slash + 1 : path;
}

static void draw_playing(viewer_panel *p)
{
    viewer *v = p->v;
    static const char *const ends[] = {"stop", "loop", "hold"};
    if (ImGui::Button(v->is_paused ? "Go on" : "Pause")) {
        viewer_toggle_pause(v);
    }
    ImGui::SameLine();
    if (ImGui::Button("Start again")) {
        viewer_restart(v);
    }
    rlf_playback *played = v->stage.playback;
    if (played == nullptr) {
        return;
    }
    int end = rlf_playback_get_end(played);
    panel_label("At the end", "of the recording");
    if (ImGui::Combo("##end", &end, ends, 3)) {
        viewer_set_end(v, (rlf_playback_end)end);
    }
    const int64_t count = rlf_playback_get_count(played);
    int index = (int)rlf_playback_get_index(played);
    if (count > 1) {
        panel_label("Frame", nullptr);
        if (ImGui::SliderInt("##frame", &index, 0, (int)count - 1)) {
            viewer_seek_to(v, (double)index / (double)(count - 1));
        }
    }
}

void panel_draw_source(viewer_panel *p)
{
    const rlf_window_stage *stage = &p->v->stage;
    const char *scene = stage->scene_name[0] != '\0' ? name_of(stage->scene_name) : "two cubes";
    if (!p->has_lists) {
        look(p);
    }
    draw_choices(p, "Source", name_of(stage->source_name), p->sources, p->source_count,
                 PANEL_SOURCE);
    draw_path(p, "Other source", "file, folder, camera", p->source, PANEL_SOURCE);
    draw_choices(p, "Scene", scene, p->scenes, p->scene_count, PANEL_SCENE);
    draw_path(p, "Other scene", "scene.json", p->scene, PANEL_SCENE);
    draw_playing(p);
}

void panel_draw_record(viewer_panel *p)
{
    char text[VIEWER_LINE_SIZE];
    const bool is_on = viewer_describe_recording(p->v, text, sizeof text);
    if (ImGui::Button(is_on ? "Stop recording" : "Record")) {
        viewer_toggle_record(p->v);
    }
    ImGui::SameLine();
    if (ImGui::Button("Save picture")) {
        viewer_save_picture(p->v);
    }
    panel_note(is_on ? text : "What the camera gives goes to a file that plays again.");
}
