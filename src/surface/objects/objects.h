/* Things and what they stand on, as regions of the background.
 *
 * Large planes are found first: floors, walls, tables (planes.c). Pixels on one of them are its
 * region (support.c). What is left is cut along concave contacts and depth steps, where one thing
 * touches another, and its connected components are the things (objects.c). */
#ifndef RLF_SURFACE_OBJECTS_H
#define RLF_SURFACE_OBJECTS_H

#include "surface/steps.h"

/* A square of pixels and the plane through its points. Planes are fitted to inverse depth, which is
 * linear in the rays: 1 / z = a ray_x + b ray_y + c, and (a, b, c) is along the normal. */
typedef struct rlf_plane_sum {
    double count, x, y, w;
    double xx, xy, yy, xw, yw, ww;
} rlf_plane_sum;

typedef struct rlf_support_plane {
    double a, b, c;
    double variance; /* of inverse depth about it */
} rlf_support_plane;

typedef struct rlf_patch {
    rlf_plane_sum sum;
    rlf_support_plane plane;
    double sigma;     /* of the sensor's inverse depth here */
    double off;       /* inverse depth of its middle, off its support plane */
    int32_t plane_id; /* its support plane, from 1; 0 = none */
    int32_t was;      /* the same in the image before */
    bool is_flat, is_used;
} rlf_patch;

/* Most support planes of one image, and rows of patches per chunk of a parallel loop. */
enum { RLF_SUPPORTS = 16, RLF_PATCH_GRAIN = 4 };

/* What is known of a thing. */
typedef struct rlf_object_sum {
    double count, p[3], n[3];
    double along, square; /* of point . normal, and of point . point */
    int32_t border;       /* pixels of it */
    int32_t neighbour;    /* the thing that most of it is with; 0 = none */
    int32_t shared;       /* pixels of that part ... */
    int32_t was_one;      /* ... where both had the same label */
} rlf_object_sum;

/* Neighbouring pixels of two numbers, a < b; a = 0: this entry is free. */
typedef struct rlf_border {
    int32_t a, b;
    int32_t pixels;  /* pairs of them ... */
    int32_t open;    /* ... that nothing parts */
    int32_t was_one; /* ... that had the same label */
} rlf_border;

/* Beside the RLF_LINK_ bits of a pixel: none was left. */
enum { RLF_OBJECT_CUT = 128 };

/* Most numbers of things that are looked at so, and most pairs of them. */
enum { RLF_OBJECTS_SUMMED = 1024, RLF_BORDERS = 4096 };

typedef struct rlf_objects {
    int32_t side;          /* of a patch, pixels */
    int32_t stride;        /* of the pixels that sums are made of */
    int32_t width, height; /* in patches */
    rlf_patch *patch;
    uint32_t *near;       /* per patch: a bit for each support plane that may be seen there */
    uint32_t *scratch[2]; /* the same */
    int32_t *queue;       /* patches */
    uint8_t *support;     /* plane of pixels: of which support plane, from 1; 0 = of none */
    uint8_t *links;       /* plane: RLF_LINK_ bits before things are cut, and RLF_OBJECT_CUT */
    uint8_t *distance;    /* plane: pixels from what has a number */
    rlf_object_sum *sum;  /* RLF_OBJECTS_SUMMED */
    rlf_border *border;   /* RLF_BORDERS */
    rlf_support_plane plane[RLF_SUPPORTS];
    bool is_seen[RLF_SUPPORTS];
    int32_t count;      /* of planes; some may be seen no more */
    int32_t components; /* numbers of pixels, before things are joined */
} rlf_objects;

/* objects.c: side and extent of the patches of a grid. */
rlf_objects rlf_objects_layout(const image_grid *grid);
/* NULL when they are not wanted. */
rlf_objects *objects_allocate(rlf_arena *arena, const rlf_reconstruct_def *def,
                              const image_grid *grid);
/* Forgets the image before, of `count` pixels. */
void rlf_objects_reset(rlf_objects *objects, int32_t count);

/* planes.c */
void rlf_plane_sum_add(rlf_plane_sum *sum, const rlf_plane_sum *other);
/* Least squares; false when the points are on a line. */
bool rlf_plane_sum_fit(const rlf_plane_sum *sum, rlf_support_plane *out);
double rlf_support_cosine(const rlf_support_plane *a, const rlf_support_plane *b);
/* Finds the support planes of a layer. */
void rlf_supports_find(rlf_reconstruct *stage, const rlf_layer_in *in);

/* support.c: writes objects.support. */
void rlf_supports_mark(rlf_reconstruct *stage, const rlf_layer_in *in);

/* join.c: gives things that are one the same number, in work.component. */
void rlf_objects_join(rlf_reconstruct *stage, const rlf_layer_in *in, int32_t components);

/* objects.c: one step of RLF_OBJECT_STEPS that rlf_objects_find begins with: a frame may do each,
 * and a later one the rest. */
enum { RLF_OBJECT_STEPS = 2 };
void rlf_objects_step(rlf_reconstruct *stage, const rlf_layer_in *in);
/* objects.c: components of a layer into work.runs, as rlf_components_find does. */
int32_t rlf_objects_find(rlf_reconstruct *stage, const rlf_layer_in *in);

#endif
