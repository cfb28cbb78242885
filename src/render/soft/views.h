/* Inside the CPU renderer: the views other than the camera's picture, and what is drawn over them.
 */
#ifndef RLF_RENDER_SOFT_VIEWS_H
#define RLF_RENDER_SOFT_VIEWS_H

#include "render/soft/draw.h"
#include "render/soft/soft.h"

/* Everything but camera and mesh, in the grid's own image. */
void soft_draw_view(soft *s, const rlf_render_input *input);
/* Whether a view shows the camera's colours at the surface's pixels: s->real is read then. */
bool soft_view_has_colors(const rlf_render_input *input);
/* Colour of the camera's picture where grid point i lies at depth z; grey depth without one, and
 * where something nearer hides it from the colour camera. s->real must be read. */
soft_color soft_grid_color(const soft *s, const rlf_render_input *input, int32_t i, float z);

/* ---- view_points.c: the view of the surface's points, and what views from anywhere share. */

rlf_result soft_draw_points(soft *s, const rlf_render_input *input);

/* Nothing is seen, and no depth is known. */
void soft_clear_view(soft *s);
/* Where the depth camera is: its corners, as far as they are in the picture. */
void soft_draw_frustum(const soft *s);

/* ---- view_mesh.c: the view of the triangle mesh. */

void soft_draw_mesh(soft *s, const rlf_surface *surface);

/* ---- view_map.c: the view of the fused room. */

rlf_result soft_draw_map(soft *s, const rlf_render_input *input);

/* ---- view_contacts.c: the view of contacts. */

/* Over the camera's picture. */
void soft_draw_contacts(soft *s, const rlf_render_input *input);

/* ---- view_known.c: the view of models of real things. */

/* Over the camera's picture. */
void soft_draw_known(soft *s, const rlf_render_input *input);

/* ---- view_marks.c: boxes, labels and arrows over an enlarged grid image. */

void soft_draw_region_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);
void soft_draw_velocity_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);

/* ---- marks.c: lines and texts that the caller wants over the picture. */

void soft_draw_marks(soft *s, const rlf_render_input *input);

#endif
