/* No panel: the build found no Dear ImGui. */
#include "viewer/panel.h"

#include <stddef.h>

bool viewer_panel_is_built(void)
{
    return false;
}

viewer_panel *viewer_panel_create(struct viewer *v)
{
    (void)v;
    return NULL;
}

void viewer_panel_destroy(viewer_panel **panel)
{
    *panel = NULL;
}

void viewer_panel_draw(viewer_panel *panel)
{
    (void)panel;
}

int32_t viewer_panel_get_width(const viewer_panel *panel)
{
    (void)panel;
    return 0;
}
