/* Triangles of the zero level: marching cubes without its table. On each face of a cell every run
 * of corners that are inside is cut off by a line; the lines close to polygons. Two runs on a face
 * are cut off one by one from either side of it, so neighbouring cells always agree. Corners of
 * triangles are numbered block by block, in the order of the blocks' places: each edge of the grid
 * that a triangle has a corner on is a bit, its rank the number. */
#include "map/volume.h"

#include <string.h>

enum { WORDS = 3 * MAP_VOXELS / 64 };

/* Corners of a cell have the bits x = 1, y = 2, z = 4. An edge goes along `axis` from its lower
 * corner; its number is axis * 8 + corner. */
enum { EDGES = 24, TRIANGLES_MOST = 12 };

/* Corners one after the other, all faces the same way round as seen from outside of the cell. */
static const uint8_t faces[6][4] = {
    {0, 4, 6, 2}, {1, 3, 7, 5}, /* x = 0, 1 */
    {0, 1, 5, 4}, {2, 6, 7, 3}, /* y = 0, 1 */
    {0, 2, 3, 1}, {4, 5, 7, 6}, /* z = 0, 1 */
};

static int32_t edge_between(int32_t a, int32_t b)
{
    const int32_t difference = a ^ b, axis = difference >> 1; /* 1, 2, 4 to 0, 1, 2 */
    return axis * 8 + (a < b ? a : b);
}

/* From the edge where a run of corners ends to the edge where it began. */
static void cut_face(const uint8_t face[4], uint32_t inside, int8_t next[EDGES])
{
    for (int32_t i = 0; i < 4; i++) {
        const int32_t here = face[i], after = face[(i + 1) & 3];
        if ((inside >> here & 1) == 0 || (inside >> after & 1) != 0) {
            continue;
        }
        int32_t first = i;
        while ((inside >> face[(first + 3) & 3] & 1) != 0) {
            first = (first + 3) & 3;
        }
        const int32_t begin = edge_between(face[(first + 3) & 3], face[first]);
        next[edge_between(here, after)] = (int8_t)begin;
    }
}

/* Edges that triangles have their corners on, three a triangle, counter-clockwise as seen from the
 * corners that are not inside. `inside`: a bit per corner. Returns the number of triangles. */
static int32_t triangles_of(uint32_t inside, uint8_t edges[3 * TRIANGLES_MOST])
{
    int8_t next[EDGES];
    for (int32_t i = 0; i < EDGES; i++) {
        next[i] = -1;
    }
    for (int32_t i = 0; i < 6; i++) {
        cut_face(faces[i], inside, next);
    }
    int32_t count = 0;
    for (int32_t i = 0; i < EDGES; i++) {
        if (next[i] < 0) {
            continue;
        }
        /* A fan about the polygon's first corner. */
        int32_t b = next[i], c = next[b];
        next[i] = -1;
        next[b] = -1;
        while (c != i) {
            edges[3 * count] = (uint8_t)i;
            edges[3 * count + 1] = (uint8_t)c;
            edges[3 * count + 2] = (uint8_t)b;
            count++;
            b = c;
            const int32_t after = next[c];
            next[c] = -1;
            c = after;
        }
    }
    return count;
}

/* Cut edges of the voxels of a block: axis * 512 + voxel. */
typedef struct cuts {
    uint64_t bits[WORDS];
    uint32_t before[WORDS]; /* cut edges of all blocks before each word */
} cuts;

/* An edge of the grid: from a voxel of a block along an axis. */
typedef struct cut_edge {
    int32_t block, axis, voxel;
} cut_edge;

typedef struct mesher {
    const map_volume *v;
    const rlf_map *map;
    int32_t min_weight;
    int32_t *order; /* blocks by their keys */
    cuts *cut;      /* by block */
    rlf_map_mesh *mesh;
} mesher;

static int32_t bit_count(uint64_t x)
{
    int32_t n = 0;
    for (; x != 0; x &= x - 1) {
        n++;
    }
    return n;
}

static uint32_t corner_number(const mesher *m, int32_t block, int32_t axis, int32_t voxel)
{
    const int32_t at = axis * MAP_VOXELS + voxel;
    const cuts *c = &m->cut[block];
    const uint64_t below = ((uint64_t)1 << (at & 63)) - 1;
    return c->before[at >> 6] + (uint32_t)bit_count(c->bits[at >> 6] & below);
}

/* The voxel after (x, y, z) of a block along an axis. */
static bool step(const map_volume *v, int32_t block, int32_t voxel, int32_t axis,
                 int32_t *out_block, int32_t *out_voxel)
{
    const int32_t shift = 3 * axis, x = voxel >> shift & 7;
    *out_block = x < 7 ? block : v->after[block][1 << axis];
    *out_voxel = x < 7 ? voxel + (1 << shift) : voxel - (7 << shift);
    return *out_block >= 0;
}

/* Bits of the corners that are inside; 0 when there is no surface or not all is known. */
static uint32_t corners_inside(const mesher *m, const map_cell *cell)
{
    uint32_t inside = 0;
    for (int32_t k = 0; k < 8; k++) {
        if (cell->weight[k] < m->min_weight) {
            return 0;
        }
        inside |= cell->distance[k] > 0.0f ? 0u : 1u << k;
    }
    return inside == 255 ? 0 : inside;
}

/* The edges that triangles of a cell have their corners on. */
static int32_t edges_of(const mesher *m, int32_t block, int32_t voxel, cut_edge *out)
{
    map_cell cell;
    uint8_t edges[3 * TRIANGLES_MOST];
    const int32_t in[3] = {voxel & 7, voxel >> 3 & 7, voxel >> 6};
    if (!map_cell_read(m->v, block, in[0], in[1], in[2], &cell)) {
        return 0;
    }
    const int32_t count = 3 * triangles_of(corners_inside(m, &cell), edges);
    for (int32_t i = 0; i < count; i++) {
        const int32_t axis = edges[i] / 8, corner = edges[i] % 8;
        int32_t beyond = 0;
        for (int32_t k = 0; k < 3; k++) {
            beyond |= ((in[k] + (corner >> k & 1)) >> 3) << k;
        }
        out[i] = (cut_edge){m->v->after[block][beyond], axis, cell.voxel[corner]};
    }
    return count;
}

/* All triangles, block by block: at first they only mark their corners' edges and are counted. */
static size_t visit_cells(const mesher *m, uint32_t *index)
{
    size_t count = 0;
    for (int32_t i = 0; i < m->v->count; i++) {
        const int32_t block = m->order[i];
        const bool has_surface = (m->v->flags[block] & MAP_HAS_SURFACE) != 0;
        for (int32_t voxel = 0; has_surface && voxel < MAP_VOXELS; voxel++) {
            cut_edge edge[3 * TRIANGLES_MOST];
            const int32_t more = edges_of(m, block, voxel, edge);
            for (int32_t k = 0; k < more; k++, count++) {
                const int32_t at = edge[k].axis * MAP_VOXELS + edge[k].voxel;
                if (index != NULL) {
                    index[count] = corner_number(m, edge[k].block, edge[k].axis, edge[k].voxel);
                } else {
                    m->cut[edge[k].block].bits[at >> 6] |= (uint64_t)1 << (at & 63);
                }
            }
        }
    }
    return count;
}

static size_t number_corners(const mesher *m)
{
    size_t count = 0;
    for (int32_t i = 0; i < m->v->count; i++) {
        cuts *c = &m->cut[m->order[i]];
        for (int32_t w = 0; w < WORDS; w++) {
            c->before[w] = (uint32_t)count;
            count += (size_t)bit_count(c->bits[w]);
        }
    }
    return count;
}

static void place_corner(const mesher *m, int32_t block, int32_t axis, int32_t voxel, size_t number)
{
    int32_t next_block, next;
    if (!step(m->v, block, voxel, axis, &next_block, &next)) {
        return;
    }
    const map_block *a = map_block_at(m->v, block), *b = map_block_at(m->v, next_block);
    const double da = a->distance[voxel], db = b->distance[next], t = da / (da - db);
    for (int32_t k = 0; k < 3; k++) {
        const int32_t in = voxel >> (3 * k) & 7;
        const double at = m->v->place[block][k] * MAP_SIDE + in + (k == axis ? t : 0.0);
        m->mesh->position[3 * number + (size_t)k] = (float)(at * m->map->def.voxel_m);
    }
    const bool is_first = t < 0.5;
    map_voxel_color(is_first ? a : b, is_first ? voxel : next, &m->mesh->rgba[4 * number]);
}

static void place_corners(const mesher *m)
{
    for (int32_t i = 0; i < m->v->count; i++) {
        const int32_t block = m->order[i];
        for (int32_t at = 0; at < 3 * MAP_VOXELS; at++) {
            if ((m->cut[block].bits[at >> 6] >> (at & 63) & 1) != 0) {
                const int32_t axis = at / MAP_VOXELS, voxel = at % MAP_VOXELS;
                place_corner(m, block, axis, voxel, corner_number(m, block, axis, voxel));
            }
        }
    }
}

static rlf_vec3 corner_of(const rlf_map_mesh *mesh, uint32_t i)
{
    const float *p = &mesh->position[3 * (size_t)i];
    return rlf_vec3_make((double)p[0], (double)p[1], (double)p[2]);
}

/* Means of the triangles about each corner, weighted by their areas. */
static void fill_normals(rlf_map_mesh *mesh)
{
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *i = &mesh->index[3 * t];
        const rlf_vec3 a = corner_of(mesh, i[0]);
        const rlf_vec3 n =
            rlf_cross(rlf_sub(corner_of(mesh, i[1]), a), rlf_sub(corner_of(mesh, i[2]), a));
        for (int32_t k = 0; k < 3; k++) {
            float *sum = &mesh->normal[3 * (size_t)i[k]];
            sum[0] += (float)(1e6 * n.x); /* square millimetres: far from the least float */
            sum[1] += (float)(1e6 * n.y);
            sum[2] += (float)(1e6 * n.z);
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        float *n = &mesh->normal[3 * i];
        const rlf_vec3 unit =
            rlf_normalize(rlf_vec3_make((double)n[0], (double)n[1], (double)n[2]));
        n[0] = (float)unit.x;
        n[1] = (float)unit.y;
        n[2] = (float)unit.z;
    }
}

static bool build(mesher *m)
{
    rlf_map_mesh *mesh = m->mesh;
    m->order = rlf_alloc_array((size_t)m->v->count + 1, sizeof(int32_t));
    m->cut = rlf_alloc_array((size_t)m->v->high + 1, sizeof(cuts));
    if (m->order == NULL || m->cut == NULL || !map_volume_sorted(m->v, m->order)) {
        return false;
    }
    mesh->triangle_count = visit_cells(m, NULL) / 3;
    mesh->vertex_count = number_corners(m);
    mesh->index = rlf_alloc_array(mesh->triangle_count + 1, 3 * sizeof(uint32_t));
    mesh->position = rlf_alloc_array(mesh->vertex_count + 1, 3 * sizeof(float));
    mesh->normal = rlf_alloc_array(mesh->vertex_count + 1, 3 * sizeof(float));
    mesh->rgba = rlf_alloc_array(mesh->vertex_count + 1, 4);
    if (mesh->index == NULL || mesh->position == NULL || mesh->normal == NULL ||
        mesh->rgba == NULL) {
        return false;
    }
    place_corners(m);
    (void)visit_cells(m, mesh->index);
    fill_normals(mesh);
    return true;
}

rlf_result rlf_map_mesh_create(const rlf_map *map, int32_t min_weight, rlf_map_mesh *out)
{
    if (!RLF_ASSERT(map != NULL && out != NULL) || !RLF_ASSERT(min_weight >= 1)) {
        return RLF_ERROR_INVALID;
    }
    memset(out, 0, sizeof(*out));
    mesher m = {.v = &map->volume, .map = map, .min_weight = min_weight, .mesh = out};
    const bool is_built = build(&m);
    rlf_free(m.order);
    rlf_free(m.cut);
    if (!is_built) {
        rlf_map_mesh_destroy(out);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

void rlf_map_mesh_destroy(rlf_map_mesh *mesh)
{
    if (mesh == NULL) {
        return;
    }
    rlf_free(mesh->position);
    rlf_free(mesh->normal);
    rlf_free(mesh->rgba);
    rlf_free(mesh->index);
    memset(mesh, 0, sizeof(*mesh));
}
