/* Bisection for the place of a line that is nearest to a body. */
#include "physics/grid/line.h"

#define HALVINGS 6

double grid_line_nearest(const grid_job *job, rlf_vec3 start, rlf_vec3 way, double length)
{
    rlf_vec3 along = rlf_mat3_mul_vec(&job->R_body_grid, way);
    double low = 0.0, high = length, square = rlf_dot(along, along);
    double place = rlf_dot(rlf_sub(job->centre, start), way) / square;
    place = rlf_clamp(place, low, high);
    for (int32_t i = 0; i < HALVINGS; i++) {
        rlf_vec3 gradient, p = rlf_sub(rlf_mad(start, way, place), job->centre);
        phys_shape_distance(&job->body->shape, rlf_mat3_mul_vec(&job->R_body_grid, p), &gradient);
        bool is_beyond = rlf_dot(gradient, along) > 0.0;
        if (is_beyond ? place <= 0.0 : place >= length) {
            return place;
        }
        low = is_beyond ? low : place;
        high = is_beyond ? place : high;
        bool is_first = i == 0; /* it may well be an end */
        place = is_first ? (is_beyond ? low : high) : 0.5 * (low + high);
    }
    return place;
}
