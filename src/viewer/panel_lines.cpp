/* The lines over the picture, in the panel's typeface. */
#include "viewer/panel_parts.h"

/* Of lines, at 100 % scale. */
#define MARGIN 10.0f
#define PADDING 5.0f

static const ImU32 paper = IM_COL32(0, 0, 0, 130);
static const ImU32 ink = IM_COL32(245, 245, 235, 255);
static const ImU32 red = IM_COL32(240, 60, 50, 255);

/* A red dot where something is recorded, a red bar at an error. Returns the room it takes. */
static float draw_mark(ImDrawList *list, viewer_mark mark, ImVec2 at, float height)
{
    const float side = 0.6f * height;
    switch (mark) {
    case VIEWER_MARK_NONE: break;
    case VIEWER_MARK_RECORDING:
        list->AddCircleFilled(ImVec2(at.x + 0.5f * side, at.y + 0.5f * height), 0.5f * side, red);
        return side;
    case VIEWER_MARK_ERROR:
        list->AddRectFilled(at, ImVec2(at.x + 0.3f * side, at.y + height), red);
        return 0.3f * side;
    }
    return 0.0f;
}

void panel_write_lines(viewer_panel *p)
{
    const viewer *v = p->v;
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    const float height = ImGui::GetTextLineHeight(), padding = PADDING * p->style.scale;
    ImVec2 at(MARGIN * p->style.scale, MARGIN * p->style.scale);
    for (int32_t i = 0; i < v->line_count; i++) {
        const char *text = v->lines[i];
        const float wide = ImGui::CalcTextSize(text).x + (v->line_marks[i] != 0 ? height : 0.0f);
        list->AddRectFilled(ImVec2(at.x - padding, at.y - 0.4f * padding),
                            ImVec2(at.x + wide + padding, at.y + height + 0.4f * padding), paper,
                            padding);
        const float room = draw_mark(list, v->line_marks[i], at, height);
        list->AddText(ImVec2(at.x + room, at.y), ink, text);
        at.y += height + 0.8f * padding;
    }
}
