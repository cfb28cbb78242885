/* From where the picture is drawn. */
#include "render/soft/soft.h"

#define FINE_FOCAL_PX 800.0 /* from here on shadows are as coarse as on half as many pixels */

void soft_set_viewpoint(soft *s, const rlf_camera *camera, const rlf_pose *T_picture_depth)
{
    s->camera = *camera;
    s->T_picture_depth = *T_picture_depth;
    s->to_light = rlf_neg(rlf_rotate(T_picture_depth->q, s->direction.now));
    s->shade_px = camera->fx > FINE_FOCAL_PX ? 8 : 4;
    s->ray_x0 = (float)(-camera->cx / camera->fx);
    s->ray_y0 = (float)(-camera->cy / camera->fy);
    s->ray_step_x = (float)(1.0 / camera->fx);
    s->ray_step_y = (float)(1.0 / camera->fy);
}
