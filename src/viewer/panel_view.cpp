/* The panel's views, settings of the surface and times. */
#include "viewer/panel_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void draw_legend(const viewer *v)
{
    const rlf_rig *rig = &rlf_source_get_info(v->stage.source)->rig;
    const rlf_legend legend = rlf_view_legend(v->view, rig);
    const float side = ImGui::GetTextLineHeight();
    panel_note(legend.title != nullptr ? legend.title : "");
    for (int i = 0; i < legend.row_count; i++) {
        const rlf_legend_row *row = &legend.rows[i];
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + side, at.y + side),
                                                  IM_COL32(row->r, row->g, row->b, 255));
        ImGui::Dummy(ImVec2(side, side));
        ImGui::SameLine();
        ImGui::TextWrapped("%s", row->text);
    }
}

void panel_draw_view(viewer_panel *p)
{
    viewer *v = p->v;
    if (ImGui::BeginCombo("shows", rlf_view_name(v->view))) {
        for (int i = 0; i < RLF_VIEW_COUNT; i++) {
            if (ImGui::Selectable(rlf_view_name((rlf_view)i), i == (int)v->view)) {
                viewer_set_view(v, (rlf_view)i);
            }
        }
        ImGui::EndCombo();
    }
    if (v->stage.source != nullptr) {
        draw_legend(v);
    }
    if (ImGui::Checkbox("beside the camera", &v->is_beside)) {
        viewer_set_view(v, v->view);
    }
    ImGui::Checkbox("mirror", &v->is_mirrored);
    ImGui::SameLine();
    ImGui::Checkbox("text", &v->shows_overlay);
    ImGui::SameLine();
    ImGui::Checkbox("keys", &v->shows_help);
}

static void wish_setting(viewer_panel *p, const rlf_window_setting *s, const char *value)
{
    char text[96];
    snprintf(text, sizeof text, "%s=%s", s->name, value);
    panel_ask_for(p, PANEL_SETTING, text);
}

static void draw_words(viewer_panel *p, const rlf_window_setting *s)
{
    if (!ImGui::BeginCombo(s->name, s->value)) {
        return;
    }
    for (int i = 0; s->words[i] != nullptr; i++) {
        if (ImGui::Selectable(s->words[i], strcmp(s->words[i], s->value) == 0)) {
            wish_setting(p, s, s->words[i]);
        }
    }
    ImGui::EndCombo();
}

static void draw_setting(viewer_panel *p, const rlf_window_setting *s)
{
    if (s->is_switch) {
        bool is_on = strcmp(s->value, "on") == 0;
        if (ImGui::Checkbox(s->name, &is_on)) {
            wish_setting(p, s, is_on ? "on" : "off");
        }
    } else if (s->words != nullptr) {
        draw_words(p, s);
    } else {
        char value[32];
        snprintf(value, sizeof value, "%s", s->value);
        if (ImGui::InputText(s->name, value, sizeof value, ImGuiInputTextFlags_EnterReturnsTrue)) {
            wish_setting(p, s, value);
        }
    }
    panel_note(s->meaning);
    if (s->need != nullptr) {
        char text[160];
        snprintf(text, sizeof text, "no effect now: needs %s", s->need);
        panel_note(text);
    }
}

void panel_draw_settings(viewer_panel *p)
{
    const rlf_window_def *o = p->v->options;
    const rlf_reconstruct_def *def = p->v->stage.reconstruct;
    if (def == nullptr || o->on_setting == nullptr) {
        return;
    }
    panel_note("How depth becomes a surface. A change begins the scene again.");
    if (ImGui::Button("As the profile has them")) {
        panel_ask_for(p, PANEL_SETTING, "");
    }
    rlf_window_setting s;
    for (int i = 0; o->on_setting(o->context, i, def, &s); i++) {
        ImGui::PushID(i);
        draw_setting(p, &s);
        ImGui::PopID();
    }
}

void panel_draw_times(viewer_panel *p)
{
    const viewer *v = p->v;
    const rlf_stage_times *t = &v->times;
    float sums[VIEWER_PLOT_FRAMES];
    for (int i = 0; i < v->plot_count; i++) {
        const float *values = v->plot[i];
        sums[i] = values[0] + values[1] + values[2] + values[3];
    }
    ImGui::Text("%.1f frames per second", v->fps);
    ImGui::Text("capture %5.1f   surface %5.1f ms", t->capture_ms, t->surface_ms);
    ImGui::Text("physics %5.1f   render  %5.1f ms", t->physics_ms, t->render_ms);
    ImGui::Text("latency %5.1f   panel   %5.2f ms", v->latency_ms, v->panel_ms);
    ImGui::PlotLines("##sum", sums, v->plot_count, 0, "all stages, 0 to 66 ms", 0.0f, 66.7f,
                     ImVec2(ImGui::GetContentRegionAvail().x, 48.0f * p->scale));
}
