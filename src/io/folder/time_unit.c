/* Units of times. */
#include "io/folder/folder.h"

#include <stdlib.h>

#define NS_PER_S INT64_C(1000000000)
#define YEAR_2000_S 946684800.0
#define YEAR_2100_S 4102444800.0
#define APART_MIN_S 1e-3
#define APART_MAX_S 10.0
#define APART_MAX_UNIX_S 3600.0 /* a camera that takes a picture an hour says when */
#define MARGIN_S 0.02           /* of a single picture, and of two clocks */
#define SHARE_MIN 0.5

static const int64_t units[4] = {1, 1000, 1000000, NS_PER_S};

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Middle one of the gaps between times that differ; 0 when none do. */
static double median_gap(const double *times, int32_t count, double *scratch)
{
    int32_t gaps = 0;
    for (int32_t i = 1; i < count; i++) {
        if (times[i] > times[i - 1]) {
            scratch[gaps++] = times[i] - times[i - 1];
        }
    }
    qsort(scratch, (size_t)gaps, sizeof(scratch[0]), compare);
    return gaps > 0 ? scratch[(gaps - 1) / 2] : 0.0;
}

static bool is_unix(double first, double last, double unit)
{
    return first >= YEAR_2000_S * unit && last <= YEAR_2100_S * unit;
}

int64_t io_time_unit(const double *times, int32_t count, double *scratch)
{
    const double first = count > 0 ? times[0] : 0.0;
    const double last = count > 0 ? times[count - 1] : 0.0;
    const double gap = median_gap(times, count, scratch);
    const double most = is_unix(first, last, 1.0) ? APART_MAX_UNIX_S : APART_MAX_S;
    if (last <= IO_SECONDS_MAX && gap <= most) {
        return 1;
    }
    int64_t fitting = 0, fitting_unix = 0;
    int32_t fits = 0, fits_unix = 0;
    for (int i = 1; i < 4; i++) {
        const double unit = (double)units[i];
        const bool is_near = gap >= APART_MIN_S * unit && gap <= APART_MAX_S * unit;
        if (is_near && last <= IO_SECONDS_MAX * unit) {
            fitting = units[i];
            fits++;
            const bool is_date = is_unix(first, last, unit);
            fitting_unix = is_date ? units[i] : fitting_unix;
            fits_unix += is_date ? 1 : 0;
        }
    }
    return fits == 1 ? fitting : fits_unix == 1 ? fitting_unix : 0;
}

/* How much of both spans together is in both: 0 to 1. */
static double cover(double from, double to, double first, double last)
{
    const double low = from > first ? from : first, high = to < last ? to : last;
    const double begin = from < first ? from : first, end = to > last ? to : last;
    return high > low ? (high - low) / (end - begin) : 0.0;
}

int64_t io_time_unit_beside(double from, double to, double first_s, double last_s)
{
    int64_t best = 1;
    double seconds = 0.0, best_share = 0.0;
    int32_t meets = 0;
    for (int i = 0; i < 4; i++) {
        const double unit = (double)units[i];
        const double share = cover(from / unit - MARGIN_S, to / unit + MARGIN_S, first_s - MARGIN_S,
                                   last_s + MARGIN_S);
        seconds = i == 0 ? share : seconds;
        meets += share > 0.0 ? 1 : 0;
        best = share > best_share ? units[i] : best;
        best_share = share > best_share ? share : best_share;
    }
    const bool is_only = seconds <= 0.0 && meets == 1;
    const bool is_better = best_share >= SHARE_MIN && best_share > 2.0 * seconds;
    return is_only || is_better ? best : 1;
}

void io_time_unit_tell(const char *file, int64_t unit)
{
    if (unit > 1) {
        rlf_log(RLF_LOG_WARNING, "%s: its times are no seconds: they are taken as %s", file,
                unit == 1000      ? "milliseconds"
                : unit == 1000000 ? "microseconds"
                                  : "nanoseconds");
    }
}

int64_t io_time_in_ns(int64_t whole, int64_t billionths, int64_t unit)
{
    return whole * (NS_PER_S / unit) + billionths / unit;
}
