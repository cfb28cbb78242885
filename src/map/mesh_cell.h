/* The triangles of one cell. */
#ifndef RLF_MAP_MESH_CELL_H
#define RLF_MAP_MESH_CELL_H

#include <stdint.h>

/* Corners of a cell have the bits x = 1, y = 2, z = 4. An edge goes along `axis` from its lower
 * corner; its number is axis * 8 + corner. */
enum { MAP_CELL_EDGES = 24, MAP_CELL_TRIANGLES_MOST = 12 };

/* Edges that triangles have their corners on, three a triangle, counter-clockwise as seen from the
 * corners that are not inside. `inside`: a bit per corner. Returns the number of triangles. */
int32_t map_cell_triangles(uint32_t inside, uint8_t edges[3 * MAP_CELL_TRIANGLES_MOST]);

#endif
