/* The panel's views, settings of the surface and times. */
#include "viewer/panel_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLOT_HEIGHT 56.0f /* at 100 % scale */
#define PLOT_MS 66.7f     /* that the plot's height stands for */

static const ImU32 stage_colours[VIEWER_PLOT_STAGES] = {
    IM_COL32(90, 140, 240, 255), IM_COL32(240, 175, 60, 255), IM_COL32(225, 90, 80, 255),
    IM_COL32(95, 190, 110, 255)};

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
    panel_label("Shows", nullptr);
    if (ImGui::BeginCombo("##shows", rlf_view_name(v->view))) {
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
    if (ImGui::Checkbox("Camera beside it", &v->is_beside)) {
        viewer_set_view(v, v->view);
    }
    ImGui::SameLine();
    ImGui::Checkbox("Mirror", &v->is_mirrored);
    ImGui::SameLine();
    ImGui::Checkbox("Fill", &v->fills);
    panel_tip("the whole window, and cut what is beyond it; else black bars");
    ImGui::Checkbox("Text", &v->shows_overlay);
    panel_tip("over the picture");
    ImGui::SameLine();
    ImGui::Checkbox("Keys", &v->shows_help);
    panel_tip("what every key does, and the figures of this frame");
    ImGui::SameLine();
    ImGui::Checkbox("Light", &v->is_light);
    panel_tip("dark letters on a light panel");
    if (ImGui::Button(v->corners.is_on ? "Corners: done" : "Corners")) {
        viewer_toggle_corners(v);
    }
    panel_tip("drag the picture's four corners, for a projector that stands askew");
}

static void wish_setting(viewer_panel *p, const rlf_window_setting *s, const char *value)
{
    char text[96];
    snprintf(text, sizeof text, "%s=%s", s->name, value);
    panel_ask_for(p, PANEL_SETTING, text);
}

static void draw_words(viewer_panel *p, const rlf_window_setting *s)
{
    if (!ImGui::BeginCombo("##value", s->value)) {
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
    panel_label(s->name, s->meaning);
    if (s->is_switch) {
        bool is_on = strcmp(s->value, "on") == 0;
        if (ImGui::Checkbox("##value", &is_on)) {
            wish_setting(p, s, is_on ? "on" : "off");
        }
    } else if (s->words != nullptr) {
        draw_words(p, s);
    } else {
        char value[32];
        snprintf(value, sizeof value, "%s", s->value);
        if (ImGui::InputText("##value", value, sizeof value,
                             ImGuiInputTextFlags_EnterReturnsTrue)) {
            wish_setting(p, s, value);
        }
    }
    panel_tip(s->meaning);
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

/* Each frame is a bar of the stages' times, the oldest at the left, up to twice a camera's period. */
static void draw_plot(const viewer_panel *p)
{
    const viewer *v = p->v;
    const ImVec2 size(ImGui::GetContentRegionAvail().x, PLOT_HEIGHT * p->style.scale);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), ImGui::GetColorU32(ImGuiCol_FrameBg));
    const float width = size.x / VIEWER_PLOT_FRAMES;
    for (int i = 0; i < v->plot_count; i++) {
        float base = at.y + size.y;
        for (int k = 0; k < VIEWER_PLOT_STAGES; k++) {
            const float top = base - size.y * v->plot[i][k] / PLOT_MS;
            const float x = at.x + (float)i * width;
            list->AddRectFilled(ImVec2(x, top > at.y ? top : at.y), ImVec2(x + width, base),
                                stage_colours[k]);
            base = top > at.y ? top : at.y;
        }
    }
    const float middle = at.y + 0.5f * size.y;
    list->AddLine(ImVec2(at.x, middle), ImVec2(at.x + size.x, middle),
                  ImGui::GetColorU32(ImGuiCol_TextDisabled));
    ImGui::Dummy(size);
    panel_tip("the last 120 frames; the line is a camera's period, 33 ms");
}

static void draw_time(const char *name, double ms, ImU32 colour)
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 0.7f * ImGui::GetTextLineHeight(), down = 0.2f * ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(at.x, at.y + down),
                                              ImVec2(at.x + side, at.y + down + side), colour);
    ImGui::Dummy(ImVec2(side, side));
    ImGui::SameLine();
    ImGui::TextUnformatted(name);
    ImGui::SameLine(0.36f * ImGui::GetWindowWidth());
    ImGui::Text("%.1f ms", ms);
}

void panel_draw_times(viewer_panel *p)
{
    const viewer *v = p->v;
    const rlf_stage_times *t = &v->times;
    ImGui::Text("%.1f frames a second, latency %.0f ms", v->fps, v->latency_ms);
    draw_time("Capture", t->capture_ms, stage_colours[0]);
    draw_time("Surface", t->surface_ms, stage_colours[1]);
    draw_time("Physics", t->physics_ms, stage_colours[2]);
    draw_time("Render", t->render_ms, stage_colours[3]);
    draw_time("Panel", v->panel_ms, 0);
    draw_plot(p);
}
