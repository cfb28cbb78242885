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

viewer_menu *viewer_menu_create(viewer_window *window)
{
    (void)window;
    return NULL;
}

void viewer_menu_destroy(viewer_menu **menu)
{
    *menu = NULL;
}

void viewer_menu_look(viewer_menu *menu, const rlf_window_choice *choices, int32_t count)
{
    (void)menu;
    (void)choices;
    (void)count;
}

void viewer_menu_open_files(viewer_menu *menu)
{
    (void)menu;
}

void viewer_panel_open_files(viewer_panel *panel)
{
    (void)panel;
}

int32_t viewer_menu_draw(viewer_menu *menu, rlf_window_choice *choices, int32_t count,
                         int32_t selected)
{
    (void)menu;
    (void)choices;
    (void)count;
    (void)selected;
    return -1;
}

int32_t viewer_panel_get_width(const viewer_panel *panel)
{
    (void)panel;
    return 0;
}
