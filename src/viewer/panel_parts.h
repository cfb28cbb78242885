/* What the parts of the panel share. C++, for Dear ImGui. */
#ifndef RLF_VIEWER_PANEL_PARTS_H
#define RLF_VIEWER_PANEL_PARTS_H

#include <imgui.h>

extern "C" {
#include "viewer/files.h"
#include "viewer/state.h"
}

/* Something to do once the picture is drawn: it may replace what the parts look at. */
enum panel_request { PANEL_NOTHING, PANEL_SOURCE, PANEL_SCENE, PANEL_SETTING, PANEL_MODEL };

/* What the looks were made for. */
struct panel_style {
    float scale; /* of the typeface; 0 = none yet */
    bool is_light;
};

/* Of a list's choices, in its order. */
struct panel_picture {
    rlf_image_rgba8 image; /* data NULL = none */
    int rect;              /* in the texture */
};
struct panel_pictures {
    panel_picture items[RLF_WINDOW_CHOICES_MAX];
    int count;
};

/* A list that files are chosen from, and what for. */
struct panel_files {
    viewer_files files;
    panel_request what;
    const char *endings; /* of the files; nullptr = all */
    bool is_due;         /* it opens with the next picture */
    char path[VIEWER_FILES_PATH];
};

struct viewer_panel {
    viewer *v;
    panel_style style;
    rlf_window_choice sources[RLF_WINDOW_CHOICES_MAX], scenes[RLF_WINDOW_CHOICES_MAX];
    int source_count, scene_count;
    bool has_lists;
    char source[RLF_WINDOW_SOURCE_SIZE], scene[RLF_WINDOW_SOURCE_SIZE],
        model[RLF_WINDOW_SOURCE_SIZE];
    rlf_vec3 down; /* unit; where gravity pulls to, also while it is off */
    panel_files files;
    panel_request request;
    char request_text[RLF_WINDOW_SOURCE_SIZE];
};

void panel_ask_for(viewer_panel *p, panel_request request, const char *text);
/* Grey text in as many lines as it takes. */
void panel_note(const char *text);

/* panel_style.cpp: a context of imgui for a window, one at a time; false where it cannot have one.
 */
bool panel_context_open(GLFWwindow *window);
void panel_context_close(void);
/* Typeface, colours and sizes for the window as it is now, and with the letters those pictures,
 * NULL = none. Between the back ends' new frame and imgui's. */
void panel_set_style(panel_style *style, GLFWwindow *window, bool is_light,
                     panel_pictures *pictures);
/* A name at the left; the control that follows takes the rest of the line. `tip` is shown under the
 * mouse; NULL = none. */
void panel_label(const char *name, const char *tip);
/* Of what was drawn last. */
void panel_tip(const char *text);

/* panel_pictures.cpp: reads those that are there; a style of scale 0 then takes them into its
 * texture. */
void panel_pictures_load(panel_pictures *p, const rlf_window_choice *choices, int count);
void panel_pictures_free(panel_pictures *p);
/* After the typeface was chosen, before its texture is made. */
void panel_pictures_add(panel_pictures *p);
/* That of a choice, so high, as an item of imgui; false where there is none. */
bool panel_pictures_draw(const panel_pictures *p, int index, float height);

/* panel_files.cpp: opens the list, and draws it while it is open; true when `path` was chosen. */
void panel_files_open(panel_files *f, panel_request what, const char *endings);
bool panel_files_draw(panel_files *f);
/* The button beside a field; true when it was pressed. And the room it takes. */
bool panel_files_button(void);
float panel_files_button_width(void);

/* panel.cpp: in an open list the arrows choose, Enter and Space take, and Escape closes it. */
void panel_lead_list(bool is_open);
/* A key that went up before the next picture was still pressed: imgui alone would not know. */
void panel_press_taps(viewer_window *window, bool is_before);

/* panel_lines.cpp */
void panel_write_lines(viewer_panel *p);

void panel_draw_source(viewer_panel *p);
void panel_draw_bodies(viewer_panel *p);
void panel_draw_gravity(viewer_panel *p);
void panel_draw_view(viewer_panel *p);
void panel_draw_settings(viewer_panel *p);
void panel_draw_record(viewer_panel *p);
void panel_draw_times(viewer_panel *p);

#endif
