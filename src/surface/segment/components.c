/* Connected components of linked pixels, run by run, with union-find (Rosenfeld and Pfaltz 1966;
 * runs: He, Chao and Suzuki 2008). O(pixels), whatever their number and shape. */
#include "surface/steps.h"

#include "kernel/kernel.h"

static int32_t root_of(int32_t *parent, int32_t a)
{
    while (parent[a] != a) {
        parent[a] = parent[parent[a]]; /* path halving */
        a = parent[a];
    }
    return a;
}

/* The smaller root wins, so that a component is known by its first run in raster order. */
static void join(int32_t *parent, int32_t a, int32_t b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    parent[a < b ? b : a] = a < b ? a : b;
}

static int32_t find_runs(const uint8_t *links, rlf_span span, rlf_run *runs, int32_t count)
{
    int32_t x = rlf_kernel_next_mark(links, span.x0, span.x1);
    while (x < span.x1) {
        int32_t begin = x++;
        while (x < span.x1 && (links[x] & RLF_LINK_LEFT) != 0) {
            x++;
        }
        runs[count++] = (rlf_run){begin, x, 0};
        x = rlf_kernel_next_mark(links, x, span.x1);
    }
    return count;
}

/* Joins run r to the runs above that its pixels are linked to; *above is the first that can touch
 * it, and only moves on. Pixels under one and the same run say the same, but for its ends. */
static void join_run(const rlf_work *work, const uint8_t *links, int32_t r, int32_t end,
                     int32_t *above)
{
    const rlf_run *runs = work->runs.run;
    int32_t a = *above, x = runs[r].x0;
    while (x < runs[r].x1) {
        while (a < end && runs[a].x1 < x) {
            a++;
        }
        if (a == end) {
            break;
        }
        int32_t next = x + 1;
        if (links[x] & RLF_LINK_UP) {
            int32_t over = runs[a].x1 <= x ? a + 1 : a;
            join(work->parent, r, over);
            next = runs[over].x1 - 1 > next ? runs[over].x1 - 1 : next;
        }
        x = next;
    }
    *above = a;
}

int32_t rlf_components_find(const rlf_reconstruct *stage, const rlf_span *spans)
{
    const rlf_work *work = &stage->work;
    int32_t width = stage->grid.width, height = stage->grid.height;
    const rlf_span whole = {0, width};
    int32_t count = 0;
    for (int32_t y = 0; y < height; y++) {
        const uint8_t *links = work->links + (ptrdiff_t)y * width;
        int32_t above = y > 0 ? work->runs.first[y - 1] : 0, end = count;
        work->runs.first[y] = count;
        count = find_runs(links, spans != NULL ? spans[y] : whole, work->runs.run, count);
        for (int32_t r = end; r < count; r++) {
            work->parent[r] = r;
            join_run(work, links, r, end, &above);
        }
    }
    work->runs.first[height] = count;
    int32_t components = 0;
    for (int32_t r = 0; r < count; r++) {
        rlf_run *run = &work->runs.run[r];
        int32_t root = root_of(work->parent, r);
        if (root == r) {
            run->component = ++components;
            work->size[components] = 0;
        }
        run->component = work->runs.run[root].component;
        work->size[run->component] += run->x1 - run->x0;
    }
    return components;
}

void rlf_runs_find(rlf_reconstruct *stage, const int32_t *number)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t width = stage->grid.width, count = 0;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const int32_t *row = number + (ptrdiff_t)y * width;
        runs->first[y] = count;
        for (int32_t x = 0; x < width; x++) {
            if (row[x] == 0) {
                continue;
            }
            if (x > 0 && row[x] == row[x - 1]) {
                runs->run[count - 1].x1 = x + 1;
            } else {
                runs->run[count++] = (rlf_run){x, x + 1, row[x]};
            }
        }
    }
    runs->first[stage->grid.height] = count;
}
