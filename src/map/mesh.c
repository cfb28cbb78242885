/* Triangles of the zero level. Corners of triangles are numbered block by block, in the order of
 * the blocks' places: each edge of the grid that the surface cuts is a bit, its rank the number. */
#include "map/mesh_cell.h"
#include "map/volume.h"

#include <string.h>

enum { WORDS = 3 * MAP_VOXELS / 64 };

/* Cut edges of the voxels of a block: axis * 512 + voxel. */
typedef struct cuts {
    uint64_t bits[WORDS];
    uint32_t before[WORDS]; /* cut edges of all blocks before each word */
} cuts;

typedef struct mesher {
    const map_volume *v;
    const rlf_map *map;
    int32_t min_weight;
    int32_t *order; /* blocks by their keys */
    cuts *cut;      /* by block */
    rlf_map_mesh *mesh;
    size_t index_count, index_capacity;
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

static bool is_cut(const mesher *m, int32_t block, int32_t voxel, int32_t axis)
{
    int32_t next_block, next;
    const map_block *a = map_block_at(m->v, block);
    if (a->weight[voxel] < m->min_weight || !step(m->v, block, voxel, axis, &next_block, &next)) {
        return false;
    }
    const map_block *b = map_block_at(m->v, next_block);
    return b->weight[next] >= m->min_weight && (a->distance[voxel] > 0) != (b->distance[next] > 0);
}

static size_t find_cuts(mesher *m)
{
    size_t count = 0;
    for (int32_t i = 0; i < m->v->count; i++) {
        const int32_t block = m->order[i];
        cuts *c = &m->cut[block];
        for (int32_t at = 0; at < 3 * MAP_VOXELS; at++) {
            if (is_cut(m, block, at % MAP_VOXELS, at / MAP_VOXELS)) {
                c->bits[at >> 6] |= (uint64_t)1 << (at & 63);
            }
        }
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
    if (m->mesh->rgba != NULL) {
        const bool is_first = t < 0.5;
        map_voxel_color(is_first ? a : b, is_first ? voxel : next, &m->mesh->rgba[4 * number]);
    }
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

static bool reserve_indices(mesher *m, size_t more)
{
    if (m->index_count + more <= m->index_capacity) {
        return true;
    }
    const size_t capacity = 2 * m->index_capacity + 65536;
    uint32_t *larger = rlf_alloc_array(capacity, sizeof(uint32_t));
    if (larger == NULL) {
        return false;
    }
    if (m->mesh->index != NULL) {
        memcpy(larger, m->mesh->index, m->index_count * sizeof(uint32_t));
    }
    rlf_free(m->mesh->index);
    m->mesh->index = larger;
    m->index_capacity = capacity;
    return true;
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

static bool add_cell(mesher *m, int32_t block, int32_t voxel)
{
    map_cell cell;
    if (!map_cell_read(m->v, block, voxel & 7, voxel >> 3 & 7, voxel >> 6, &cell)) {
        return true;
    }
    uint8_t edges[3 * MAP_CELL_TRIANGLES_MOST];
    const int32_t count = map_cell_triangles(corners_inside(m, &cell), edges);
    if (!reserve_indices(m, 3 * (size_t)count)) {
        return false;
    }
    for (int32_t i = 0; i < 3 * count; i++) {
        const int32_t axis = edges[i] / 8, corner = edges[i] % 8;
        const int32_t x = (voxel & 7) + (corner & 1), y = (voxel >> 3 & 7) + (corner >> 1 & 1);
        const int32_t z = (voxel >> 6) + (corner >> 2);
        const int32_t owner = m->v->after[block][(x >> 3) | (y >> 3) << 1 | (z >> 3) << 2];
        m->mesh->index[m->index_count++] = corner_number(m, owner, axis, cell.voxel[corner]);
    }
    return true;
}

static bool add_cells(mesher *m)
{
    for (int32_t i = 0; i < m->v->count; i++) {
        const int32_t block = m->order[i];
        bool has_surface = (m->v->flags[block] & MAP_HAS_SURFACE) != 0;
        for (int32_t voxel = 0; has_surface && voxel < MAP_VOXELS; voxel++) {
            if (!add_cell(m, block, voxel)) {
                return false;
            }
        }
    }
    m->mesh->triangle_count = m->index_count / 3;
    return true;
}

/* Leaves out corners that no triangle has. */
static bool compact(rlf_map_mesh *mesh)
{
    uint32_t *number = rlf_alloc_array(mesh->vertex_count + 1, sizeof(uint32_t));
    if (number == NULL) {
        return false;
    }
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        number[mesh->index[i]] = 1;
    }
    size_t count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        if (number[i] == 0) {
            continue;
        }
        number[i] = (uint32_t)count;
        memmove(&mesh->position[3 * count], &mesh->position[3 * i], 3 * sizeof(float));
        if (mesh->rgba != NULL) {
            memmove(&mesh->rgba[4 * count], &mesh->rgba[4 * i], 4);
        }
        count++;
    }
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        mesh->index[i] = number[mesh->index[i]];
    }
    mesh->vertex_count = count;
    rlf_free(number);
    return true;
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
    mesh->vertex_count = find_cuts(m);
    mesh->position = rlf_alloc_array(mesh->vertex_count + 1, 3 * sizeof(float));
    mesh->normal = rlf_alloc_array(mesh->vertex_count + 1, 3 * sizeof(float));
    if (mesh->position == NULL || mesh->normal == NULL) {
        return false;
    }
    if (m->map->def.keep_color) {
        mesh->rgba = rlf_alloc_array(mesh->vertex_count + 1, 4);
        if (mesh->rgba == NULL) {
            return false;
        }
    }
    place_corners(m);
    if (!add_cells(m) || !compact(mesh)) {
        return false;
    }
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
