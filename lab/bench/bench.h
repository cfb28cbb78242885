/* What `relief-lab bench` has measured, as flat rows, and what measures them. */
#ifndef RELIEF_APP_BENCH_H
#define RELIEF_APP_BENCH_H

#include "session.h"
#include "timing.h"

#include <jansson.h>

#define BENCH_ROWS_MAX 512
#define BENCH_NAME 40

/* One quantity of one group, e.g. ("live_1", "surface", "ms"). */
typedef struct bench_row {
    char group[BENCH_NAME], name[BENCH_NAME], unit[12];
    double median, p95;
    double ratio; /* to what the group compares with; NAN = nothing */
} bench_row;

typedef struct bench_table {
    bench_row rows[BENCH_ROWS_MAX];
    int32_t count;
} bench_table;

void bench_add(bench_table *table, const char *group, const char *name, const char *unit,
               double median, double p95, double ratio);
/* Median and 95th percentile of a series. */
void bench_add_series(bench_table *table, const char *group, const char *name,
                      const timing_series *series, double ratio);
/* NULL when there is none. */
const bench_row *bench_find(const bench_table *table, const char *group, const char *name);

/* ---- floor.c ------------------------------------------------------------------------------- */

/* Bytes per pixel that the floor reads (the 16-bit depth) and writes (what a surface tells about a
 * frame: depth, normal, velocity, thickness, label, reason, foreground). */
#define BENCH_FLOOR_READ 2
#define BENCH_FLOOR_WRITTEN 38

/* Reading one frame and writing one surface in a plain loop, out of cache: each repeat takes the
 * set of buffers that has not been touched for longest, and all sets together are larger than the
 * caches. */
typedef struct bench_floor {
    size_t pixels;
    int32_t set_count, next;
    unsigned char *memory;
    timing_series times;
} bench_floor;

rlf_result bench_floor_open(int32_t width, int32_t height, bench_floor *out);
void bench_floor_close(bench_floor *f);
/* One repeat. */
void bench_floor_run(bench_floor *f);

/* ---- memory.c ------------------------------------------------------------------------------ */

/* From now on all memory of the library is counted. Before anything is allocated. */
void bench_memory_start(void);
/* Bytes that are allocated now. */
int64_t bench_memory_now(void);

/* ---- source.c: an analytic room of any size ------------------------------------------------- */

typedef struct bench_room {
    int32_t width, height;
    int32_t people;    /* walking about */
    int32_t plates;    /* squares before the wall, one region each; their area together is fixed */
    bool side_by_side; /* the farther off the more there are, and none hides another: the same
                          pixels together */
} bench_room;

/* The first BENCH_EMPTY_FRAMES show the empty room. Endless, 30 frames a second. */
#define BENCH_EMPTY_FRAMES 6
rlf_result bench_source_create(const bench_room *room, rlf_source **out);

/* ---- what is measured ------------------------------------------------------------------------ */

typedef struct bench_options {
    const char *source;
    const char *json_path, *compare_path;
    int64_t frames;
    int32_t threads;
    const char *clip_path;  /* write the peers' clip, nothing else */
    const char *peers_path; /* results of the peers' harness; NULL = none */
    bool is_live;           /* the live loop alone */
    bool is_quick;          /* no sweeps */
} bench_options;

/* cases.c: every stage of both profiles at scale factors 1 and 8, beside the floor; the steps
 * of the surface stage; memory. */
rlf_result bench_cases_run(const bench_options *o, bench_table *table);
void bench_cases_print(const bench_options *o, const bench_table *table);

/* sweep.c: cost against resolution, regions, people and bodies. */
rlf_result bench_sweeps_run(const bench_options *o, bench_table *table);
void bench_sweeps_print(const bench_table *table);

/* json.c: the rows, and `peers` (taken over; NULL = none were asked for). */
rlf_result bench_write_json(const bench_options *o, const bench_table *table, json_t *peers);
/* Whether a file is one that can be compared with. */
rlf_result bench_compare_check(const char *path);
/* Prints each row beside that of an earlier run, old / new. */
rlf_result bench_compare(const bench_options *o, const bench_table *table);

#endif
