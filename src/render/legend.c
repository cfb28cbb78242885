/* What the colours of the views mean, from the palette that the views are painted with. */
#include "relief/compositor.h"

#include "render/soft/draw.h"

#include <stdio.h>
#include <string.h>

#define LINE 11  /* dots from row to row */
#define MARGIN 4 /* dots */
#define SWATCH 8 /* dots */
#define STEPS 5  /* of a scale, both ends with it */

/* One row more; the rows that a view has are counted in legend_rows. */
static void add(rlf_legend *legend, soft_color color, const char *text)
{
    rlf_legend_row *row = &legend->rows[legend->row_count++];
    row->r = color.r;
    row->g = color.g;
    row->b = color.b;
    (void)snprintf(row->text, sizeof(row->text), "%s", text);
}

/* A value in hundredths, so that no locale writes a comma. */
static void add_value(rlf_legend *legend, soft_color color, double value, const char *unit)
{
    const int hundredths = (int)(value * 100.0 + 0.5);
    char text[sizeof(legend->rows[0].text)];
    (void)snprintf(text, sizeof(text), "%d.%02d %s", hundredths / 100, hundredths % 100, unit);
    add(legend, color, text);
}

/* The scale that soft_color_near_far has over the rig's range, up to `most` of the palette. */
static void add_depths(rlf_legend *legend, const rlf_rig *rig, double most)
{
    const bool has_range = rig->depth_max_m > rig->depth_min_m;
    const double near_m = has_range ? rig->depth_min_m : 0.5;
    const double far_m = has_range ? rig->depth_max_m : 4.5;
    for (int i = 0; i < STEPS; i++) {
        const double t = (double)i / (STEPS - 1);
        add_value(legend, soft_color_near_far(most * t), near_m + t * (far_m - near_m), "m");
    }
}

static void add_normals(rlf_legend *legend)
{
    add(legend, soft_color_normal(rlf_vec3_make(1, 0, 0)), "faces right, x = 1");
    add(legend, soft_color_normal(rlf_vec3_make(-1, 0, 0)), "faces left, x = -1");
    add(legend, soft_color_normal(rlf_vec3_make(0, -1, 0)), "faces up, y = -1");
    add(legend, soft_color_normal(rlf_vec3_make(0, 1, 0)), "faces down, y = 1");
    add(legend, soft_color_normal(rlf_vec3_make(0, 0, -1)), "faces the camera, z = -1");
    add(legend, soft_rgb(0, 0, 0), "not known");
}

static void add_velocities(rlf_legend *legend)
{
    const double full = SOFT_SPEED_FULL_M_S;
    add(legend, soft_color_velocity(rlf_vec3_make(full, 0, 0)), "to the right, 1 m/s and more");
    add(legend, soft_color_velocity(rlf_vec3_make(0, full, 0)), "down");
    add(legend, soft_color_velocity(rlf_vec3_make(-full, 0, 0)), "to the left");
    add(legend, soft_color_velocity(rlf_vec3_make(0, -full, 0)), "up");
    add(legend, soft_color_velocity(rlf_vec3_make(0.25 * full, 0, 0)), "darker: slower (0.25 m/s)");
    add(legend, soft_rgb(255, 255, 255), "arrow: the way in 0.25 s");
    add(legend, soft_rgb(75, 75, 75), "still");
}

static void add_thicknesses(rlf_legend *legend)
{
    for (int i = 0; i <= STEPS; i++) {
        const double metres = SOFT_THICKNESS_FULL_M * i / STEPS;
        add_value(legend, soft_color_thickness(metres), metres, i < STEPS ? "m" : "m and more");
    }
    add(legend, soft_rgb(75, 75, 75), "not known");
}

static void add_reasons(rlf_legend *legend)
{
    for (int i = 0; i < RLF_REASON_COUNT; i++) {
        add(legend, soft_color_reason((rlf_reason)i), rlf_reason_name((rlf_reason)i));
    }
}

static void add_contacts(rlf_legend *legend)
{
    add(legend, soft_color_contact(RLF_CONTACT_BACKGROUND), "with the room");
    add(legend, soft_color_contact(RLF_CONTACT_FOREGROUND), "with what moves");
    add(legend, soft_color_contact(RLF_CONTACT_BODY), "with another body");
    add(legend, soft_rgb(255, 255, 255), "arrow: 3 cm, 18 cm at 0.2 N s, up to 33 cm");
}

static void add_rows(rlf_legend *legend, rlf_view view, const rlf_rig *rig)
{
    switch (view) {
    case RLF_VIEW_DEPTH:
    case RLF_VIEW_BACKGROUND:
        add_depths(legend, rig, 1.0);
        add(legend, soft_rgb(0, 0, 0), "not known");
        break;
    case RLF_VIEW_MESH: add_depths(legend, rig, 0.7); break;
    case RLF_VIEW_NORMALS: add_normals(legend); break;
    case RLF_VIEW_REGIONS:
        add(legend, soft_color_label(1), "region 1; every region has its own colour");
        add(legend, soft_color_label(2), "region 2; fg: one that moves");
        add(legend, soft_rgb(0, 0, 0), "dark: no region");
        break;
    case RLF_VIEW_FOREGROUND:
        add(legend, soft_color_foreground(), "moves, or was not there at the start");
        add(legend, soft_rgb(0, 0, 0), "dark: background");
        break;
    case RLF_VIEW_VELOCITY: add_velocities(legend); break;
    case RLF_VIEW_THICKNESS: add_thicknesses(legend); break;
    case RLF_VIEW_REASON: add_reasons(legend); break;
    case RLF_VIEW_POINTS:
        add(legend, soft_color_unseen(), "background behind what moves");
        add(legend, soft_rgb(255, 255, 255), "the camera, 0.25 m long");
        break;
    case RLF_VIEW_CONTACTS: add_contacts(legend); break;
    case RLF_VIEW_KNOWN: add(legend, soft_color_known(), "model of a real thing"); break;
    case RLF_VIEW_HANDS:
        add(legend, soft_rgb(120, 255, 120), "palm of a hand");
        add(legend, soft_rgb(150, 150, 150), "rather no hand");
        add(legend, soft_rgb(255, 90, 90), "finger tip");
        add(legend, soft_rgb(255, 230, 60), "pinch");
        break;
    case RLF_VIEW_MAP:
        add(legend, soft_color_path(), "where the camera has been");
        add(legend, soft_rgb(255, 255, 255), "the camera now, 0.25 m long");
        add(legend, soft_rgb(150, 150, 150), "grey: seen without colour");
        add(legend, soft_color_dark(), "dark: not seen yet");
        break;
    case RLF_VIEW_BODIES: add(legend, soft_rgb(0, 0, 0), "no body; clear in a PNG"); break;
    case RLF_VIEW_CAMERA:
    case RLF_VIEW_COUNT: break;
    }
}

rlf_legend rlf_view_legend(rlf_view view, const rlf_rig *rig)
{
    static const char *const titles[RLF_VIEW_COUNT] = {
        "camera: its picture with the bodies",
        "depth along the camera's axis, m",
        "normals: where the surface faces",
        "mesh: triangles of the surface; depth, m",
        "regions, with their boxes",
        "foreground",
        "background's depth, m",
        "velocity of the surface, m/s",
        "thickness of what is seen, m",
        "reason: why a pixel has depth, or none",
        "points of the surface, from anywhere",
        "contacts: arrow along the normal, length by impulse, N s",
        "known: models of real things",
        "hands: palms, finger tips, gestures",
        "map: the room so far, from anywhere",
        "bodies alone",
    };
    rlf_legend legend;
    memset(&legend, 0, sizeof(legend));
    if (RLF_ASSERT((int)view >= 0 && view < RLF_VIEW_COUNT && rig != NULL)) {
        legend.title = titles[view];
        add_rows(&legend, view, rig);
    }
    return legend;
}

void rlf_legend_draw(const rlf_legend *legend, const rlf_image_rgba8 *image)
{
    if (!RLF_ASSERT(legend != NULL && image != NULL && image->data != NULL) ||
        legend->title == NULL) {
        return;
    }
    const int32_t scale = soft_text_scale(image->height);
    int32_t y = image->height - (legend->row_count + 1) * LINE * scale;
    soft_text style = {MARGIN * scale, y, scale, soft_rgb(255, 255, 255), true};
    soft_draw_text(image, &style, legend->title);
    for (int32_t i = 0; i < legend->row_count && i < RLF_LEGEND_ROWS; i++) {
        const rlf_legend_row *row = &legend->rows[i];
        style.x = (2 * MARGIN + SWATCH) * scale;
        style.y += LINE * scale;
        const pixel_rect frame = {MARGIN * scale, style.y - scale, (MARGIN + SWATCH) * scale,
                                  style.y + 7 * scale};
        const pixel_rect swatch = {frame.x0 + 1, frame.y0 + 1, frame.x1 - 1, frame.y1 - 1};
        soft_draw_text(image, &style, row->text);
        soft_fill_rect(image, frame, soft_rgb(128, 128, 128), 256); /* black is seen, too */
        soft_fill_rect(image, swatch, soft_rgb(row->r, row->g, row->b), 256);
    }
}
