/* Inside the CPU renderer: pixels of a body's faces one behind the other, so that all lanes have
 * work however few pixels a face has in a row. */
#ifndef RLF_RENDER_SOFT_STREAM_H
#define RLF_RENDER_SOFT_STREAM_H

#include "render/soft/soft.h"

enum { STREAM_LANES = 256, STREAM_ROOM = STREAM_LANES + SOFT_LANES };

/* Up to SOFT_LANES pixels of a row, from pixel x and lane `at` on. */
typedef struct stream_segment {
    int32_t row, x, count, at;
    int32_t face;
    float clear_z; /* what is real hides nothing of the face from here on */
} stream_segment;

/* Pixels that wait for their colour. Of each lane: */
typedef struct soft_stream {
    const soft_body *body;   /* of all faces */
    bool has_skin;           /* alike; else the body's own pattern */
    probe_material material; /* of the face that is being added */
    int32_t count;           /* of lanes; the next SOFT_LANES may hold anything */
    int32_t segment_count;
    float coverage[STREAM_ROOM]; /* share of the samples that see the face */
    float z[STREAM_ROOM];        /* first 1/z */
    float n[3][STREAM_ROOM];     /* normal / z */
    float ray_x[STREAM_ROOM], ray_y[STREAM_ROOM];
    float metallic[STREAM_ROOM], roughness[STREAM_ROOM];
    float s[STREAM_ROOM], t[STREAM_ROOM];            /* first s/z, t/z */
    float ambient[STREAM_ROOM], direct[STREAM_ROOM]; /* shares of light that are left */
    /* light sent, colour times the one plus the other; without a skin its codes */
    float times[3][STREAM_ROOM], plus[3][STREAM_ROOM], codes[3][STREAM_ROOM];
    float pattern[STREAM_ROOM]; /* of the body's own, linear */
    int32_t texel[STREAM_ROOM];
    uint32_t texels[STREAM_ROOM];
    stream_segment segments[STREAM_LANES];
} soft_stream;

RLF_KERNEL_PART float stream_clamp(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* stream.c: adds what is waiting to the sums of the group's rows; then nothing waits. */
void soft_stream_flush(const soft *s, const soft_group *group, soft_stream *stream);

/* gloss.c: light that the waiting pixels send, by a unit vector to the lamp. */
void soft_light_lanes(const light_probe *probe, const float light[3], soft_stream *v);

/* skin.c: normals, metal and roughness of a segment of row y, as the skin's textures have them. */
void soft_skin_surface(const soft_skin *skin, const soft_face *face, const stream_segment *part,
                       int32_t y, soft_stream *v);

/* ---- body_light.c: what is left of the light on a body's faces, at nodes a few pixels apart. */

#define CHUNK_NODES 12 /* pixels of so many nodes at a time: the last block needs more */

/* What other bodies leave of the light around and of the directed light: `per_row` nodes of one
 * row, then of another. */
typedef struct light_nodes {
    int32_t per_row;
    float ambient[2 * ROW_NODES], direct[2 * ROW_NODES];
} light_nodes;

/* Linear in the picture: at0 + step i. */
typedef struct ramp {
    float at0, step;
} ramp;

RLF_KERNEL_PART ramp ramp_at(const soft_plane *plane, float dx, float dy)
{
    ramp r = {plane->at0 + plane->dx * dx + plane->dy * dy, plane->dx};
    return r;
}

/* What is left at nodes of rows y0 and y1 from x on, of which `count` pixels will be drawn. False
 * when nothing takes any. */
bool soft_fill_nodes(const soft *s, const soft_face *f, const int32_t y[2], int32_t x,
                     int32_t count, light_nodes *out);

#endif
