/* Where the camera was, from the files that come with data sets. */
#include "io/folder/folder.h"

#include "io/file.h"
#include "io/calibration/calibration.h"
#include "io/clip/clip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TOKEN_SIZE 64
#define LOG_NUMBERS 19 /* of one pose of a .log: 3 and 16 */
/* Rounding to three digits; more is no rotation. */
#define ROTATION_TOLERANCE 1e-2
#define EXACT_TOLERANCE 1e-14 /* of a square of unit length, in double numbers */

typedef struct cursor {
    const char *at, *end;
} cursor;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == ',';
}

/* Next number of the line; NAN for one that is none. False at the line's end. */
static bool next_in_line(cursor *c, double *out)
{
    while (c->at < c->end && is_blank(*c->at)) {
        c->at++;
    }
    if (c->at == c->end || *c->at == '\n' || *c->at == '#') {
        return false;
    }
    char token[TOKEN_SIZE];
    size_t length = 0;
    for (; c->at < c->end && !is_blank(*c->at) && *c->at != '\n'; c->at++) {
        if (length + 1 < TOKEN_SIZE) {
            token[length++] = *c->at;
        }
    }
    token[length] = '\0';
    if (!io_number_parse(token, out)) {
        *out = NAN;
    }
    return true;
}

static void skip_line(cursor *c)
{
    while (c->at < c->end && *c->at != '\n') {
        c->at++;
    }
    c->at += c->at < c->end ? 1 : 0;
}

/* Next number over line ends. */
static bool next_number(cursor *c, double *out)
{
    while (c->at < c->end) {
        if (next_in_line(c, out)) {
            return true;
        }
        skip_line(c);
    }
    return false;
}

void io_pose_list_free(io_pose_list *list)
{
    rlf_free(list->times);
    rlf_free(list->poses);
    memset(list, 0, sizeof(*list));
}

static rlf_result allocate(io_pose_list *list, int32_t count)
{
    memset(list, 0, sizeof(*list));
    list->times = rlf_alloc_array((size_t)count, sizeof(list->times[0]));
    list->poses = rlf_alloc_array((size_t)count, sizeof(list->poses[0]));
    if (list->times == NULL || list->poses == NULL) {
        io_pose_list_free(list);
        return RLF_ERROR_MEMORY;
    }
    return RLF_OK;
}

/* Half a line of numbers, or one that is none, gives no pose. */
static bool make_pose(const double *n, int count, rlf_pose *out)
{
    double sum = 0.0;
    for (int i = 1; i < 8 && count >= 8; i++) {
        sum += n[i];
    }
    const rlf_quat q = {n[4], n[5], n[6], n[7]};
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    /* Written with a few digits; what is far from unit length is no rotation. */
    if (count < 8 || !isfinite(sum) || fabs(square - 1.0) > 0.1) {
        return false;
    }
    /* What was written with all its digits stays as it is. */
    const bool is_exact = fabs(square - 1.0) < EXACT_TOLERANCE;
    *out = (rlf_pose){rlf_vec3_make(n[1], n[2], n[3]), is_exact ? q : rlf_quat_normalize(q)};
    return true;
}

typedef struct timed_pose {
    double time; /* as it stands in the file */
    rlf_pose pose;
} timed_pose;

static int compare(const void *a, const void *b)
{
    const timed_pose *x = a;
    const timed_pose *y = b;
    return (x->time > y->time) - (x->time < y->time);
}

/* Sorted; those that are no times in the file's unit are left out. */
static void set_times(const char *file, timed_pose *poses, int32_t count, double first_s,
                      double last_s, io_pose_list *out)
{
    qsort(poses, (size_t)count, sizeof(poses[0]), compare);
    const int64_t unit =
        count > 0 ? io_time_unit_beside(poses[0].time, poses[count - 1].time, first_s, last_s) : 1;
    for (int32_t i = 0; i < count; i++) {
        const double seconds = poses[i].time / (double)unit;
        if (fabs(seconds) < IO_SECONDS_MAX) {
            out->times[out->count] = (int64_t)(seconds * 1e9);
            out->poses[out->count++] = poses[i].pose;
        }
    }
    io_time_unit_tell(file, unit);
    if (out->count < count) {
        rlf_log(RLF_LOG_WARNING,
                "%s: %d of its %d poses have times of more than %.0f seconds and are left out: "
                "write seconds",
                file, (int)(count - out->count), (int)count, IO_SECONDS_MAX);
    }
}

rlf_result io_pose_list_tum(const io_bytes *file, double first_s, double last_s, io_pose_list *out)
{
    const int32_t lines = (int32_t)io_bytes_lines(file);
    timed_pose *poses = rlf_alloc_array((size_t)lines, sizeof(poses[0]));
    rlf_result result = poses != NULL ? allocate(out, lines) : RLF_ERROR_MEMORY;
    int32_t count = 0;
    cursor c = {(const char *)file->data, (const char *)file->data + file->size};
    while (result == RLF_OK && c.at < c.end) {
        double n[8] = {0};
        int found = 0;
        while (found < 8 && next_in_line(&c, &n[found])) {
            found++;
        }
        skip_line(&c);
        if (make_pose(n, found, &poses[count].pose) && isfinite(n[0])) {
            poses[count++].time = n[0];
        }
    }
    if (result == RLF_OK) {
        set_times(file->name, poses, count, first_s, last_s, out);
    }
    rlf_free(poses);
    return result;
}

/* Rows of a 4x4 matrix; zero where they are no pose. */
static rlf_pose pose_of_matrix(const double *m)
{
    const double rows[9] = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    rlf_pose pose = {.p = rlf_vec3_make(m[3], m[7], m[11])};
    const bool is_one =
        io_rotation_read(rows, ROTATION_TOLERANCE, &pose.q) && rlf_vec3_is_finite(pose.p);
    return is_one ? pose : (rlf_pose){0};
}

rlf_result io_pose_list_log(const io_bytes *file, io_pose_list *out)
{
    const int32_t most = (int32_t)io_bytes_lines(file) / 5 + 1;
    rlf_result result = allocate(out, most);
    cursor c = {(const char *)file->data, (const char *)file->data + file->size};
    for (int32_t i = 0; result == RLF_OK && i < most; i++) {
        double n[LOG_NUMBERS];
        int found = 0;
        while (found < LOG_NUMBERS && next_number(&c, &n[found])) {
            found++;
        }
        if (found < LOG_NUMBERS) {
            break;
        }
        out->times[i] = i;
        out->poses[i] = pose_of_matrix(n + 3);
        out->count = i + 1;
    }
    return result;
}

rlf_pose io_pose_matrix(const io_bytes *file)
{
    cursor c = {(const char *)file->data, (const char *)file->data + file->size};
    double m[16];
    for (int i = 0; i < 16; i++) {
        if (!next_number(&c, &m[i])) {
            return (rlf_pose){0};
        }
    }
    return pose_of_matrix(m);
}

rlf_pose io_pose_list_at(const io_pose_list *list, int64_t time_ns, int64_t gap_ns)
{
    const io_times known = {list->times, sizeof(list->times[0]), list->count};
    const int32_t nearest = io_time_nearest(&known, time_ns, gap_ns);
    return nearest >= 0 ? list->poses[nearest] : (rlf_pose){0};
}

/* S R S and S t with S = diag(1, -1, 1): rotations about x and z turn the other way. */
rlf_pose io_pose_flip_y(const rlf_pose *pose)
{
    const rlf_quat q = {-pose->q.x, pose->q.y, -pose->q.z, pose->q.w};
    return (rlf_pose){rlf_vec3_make(pose->p.x, -pose->p.y, pose->p.z), q};
}
