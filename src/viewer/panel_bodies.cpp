/* The panel's bodies and gravity. */
#include "viewer/panel_parts.h"

#include <stdio.h>

/* The hull of a model has the size it was made for. */
static void remake_model(viewer_panel *p)
{
    const viewer *v = p->v;
    if (v->thrown.kind == VIEWER_THROW_MODEL) {
        panel_ask_for(p, PANEL_MODEL, v->thrown.model);
    }
}

static void draw_shape(viewer_panel *p)
{
    viewer_throw_def *thrown = &p->v->thrown;
    panel_label("Shape", "of what a click throws");
    if (!ImGui::BeginCombo("##shape", viewer_throw_name(thrown->kind))) {
        return;
    }
    const int count = thrown->model[0] != '\0' ? VIEWER_THROW_KINDS : VIEWER_THROW_MODEL;
    for (int i = 0; i < count; i++) {
        if (ImGui::Selectable(viewer_throw_name((viewer_throw_kind)i), i == thrown->kind)) {
            thrown->kind = (viewer_throw_kind)i;
            remake_model(p);
        }
    }
    ImGui::EndCombo();
}

void panel_draw_bodies(viewer_panel *p)
{
    viewer *v = p->v;
    viewer_throw_def *thrown = &v->thrown;
    float size_cm = (float)(100.0 * thrown->size_m);
    float restitution = (float)thrown->restitution;
    draw_shape(p);
    panel_label("Size", nullptr);
    if (ImGui::SliderFloat("##size", &size_cm, (float)(100.0 * VIEWER_THROW_SIZE_MIN),
                           (float)(100.0 * VIEWER_THROW_SIZE_MAX), "%.0f cm")) {
        thrown->size_m = rlf_clamp(0.01 * size_cm, VIEWER_THROW_SIZE_MIN, VIEWER_THROW_SIZE_MAX);
    }
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        remake_model(p);
    }
    panel_label("Bounce", "restitution: 0 stays where it falls, 1 loses no speed");
    if (ImGui::SliderFloat("##bounce", &restitution, 0.0f, 1.0f, "%.2f")) {
        thrown->restitution = rlf_clamp(restitution, 0.0, 1.0);
    }
    panel_label("Model", "a file to throw; you can also drop it on the window");
    ImGui::SetNextItemWidth(-panel_files_button_width());
    if (ImGui::InputTextWithHint("##model", ".glb, .gltf, .obj", p->model, sizeof p->model,
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        p->model[0] != '\0') {
        panel_ask_for(p, PANEL_MODEL, p->model);
    }
    if (panel_files_button()) {
        panel_files_open(&p->files, PANEL_MODEL, ".glb .gltf .obj");
    }
    if (ImGui::Button("Delete all bodies")) {
        viewer_remove_all(v);
    }
    ImGui::SameLine();
    if (ImGui::Button("Bring back")) {
        viewer_bring_back(v);
    }
    panel_tip("those that were deleted last (U, or Ctrl and Z)");
    panel_note("Click throws one. Drag a body to carry it; let go to throw it.");
}

static void set_gravity(viewer_panel *p, double strength)
{
    rlf_world_set_gravity(rlf_pipeline_get_world(p->v->stage.pipeline),
                          rlf_scale(p->down, strength));
}

void panel_draw_gravity(viewer_panel *p)
{
    const rlf_vec3 now =
        rlf_world_get_snapshot(rlf_pipeline_get_world(p->v->stage.pipeline))->gravity;
    const double length = rlf_length(now);
    float strength = (float)length;
    p->down = length > 1e-6 ? rlf_normalize(now) : p->down;
    panel_label("Strength", nullptr);
    if (ImGui::SliderFloat("##strength", &strength, 0.0f, 25.0f, "%.2f m/s2")) {
        set_gravity(p, rlf_clamp(strength, 0.0, 25.0));
    }
    const struct {
        const char *name;
        double strength;
    } places[] = {{"None", 0.0}, {"Moon", 1.62}, {"Earth", 9.81}, {"Turned", -9.81}};
    for (const auto &place : places) {
        if (ImGui::Button(place.name)) {
            set_gravity(p, place.strength);
        }
        ImGui::SameLine();
    }
    ImGui::NewLine();
}
