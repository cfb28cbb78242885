/* The panel beside the picture, drawn by Dear ImGui where the build has it. */
#ifndef RLF_VIEWER_PANEL_H
#define RLF_VIEWER_PANEL_H

#include "base/messages.h"
#include "relief/window.h"
#include "viewer/window.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct viewer;
typedef struct viewer_panel viewer_panel;

#define VIEWER_GET_PANEL RLF_GET_PART("libimgui-dev g++", "script/bootstrap", "RELIEF_WITH_IMGUI")

/* Of the panel, at 100 % scale. */
#define VIEWER_PANEL_WIDTH 340
#define VIEWER_PANEL_HEIGHT 640 /* that a window begins with */

/* Whether this build has one. */
bool viewer_panel_is_built(void);
/* NULL: this build has none, or this context cannot have one. After the window is open. */
viewer_panel *viewer_panel_create(struct viewer *v);
void viewer_panel_destroy(viewer_panel **panel);
/* Draws it at the right of the window, where that has room for it, and does what its user asks for;
 * writes the viewer's lines over the picture in its own typeface. Before the swap. */
void viewer_panel_draw(viewer_panel *panel);
/* Opens the list of files to choose a source from, with the next picture. */
void viewer_panel_open_files(viewer_panel *panel);
/* Part of the window that it takes, in the unit of mouse positions. */
int32_t viewer_panel_get_width(const viewer_panel *panel);

/* The start page's list, over what was drawn in the window. NULL: as of the panel. */
typedef struct viewer_menu viewer_menu;
viewer_menu *viewer_menu_create(viewer_window *window);
void viewer_menu_destroy(viewer_menu **menu);
/* Takes the pictures of a new list. */
void viewer_menu_look(viewer_menu *menu, const rlf_window_choice *choices, int32_t count);
/* The list of files opens with the next picture. */
void viewer_menu_open_files(viewer_menu *menu);
/* Returns the one that was clicked, -1 = none; `count`: another file, which is choices[count] now.
 * `selected` is in view. Before the swap. */
int32_t viewer_menu_draw(viewer_menu *menu, rlf_window_choice *choices, int32_t count,
                         int32_t selected);

#ifdef __cplusplus
}
#endif
#endif
