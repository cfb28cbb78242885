/* The text files of folders: associations.txt, poses of TUM, .log and 4x4 matrices. Any bytes give
 * lists in order of time with poses of unit length, or an error line. */
#include "fuzz.h"

#include "io/folder/folder.h"

#include <math.h>
#include <stdlib.h>

static const char *const seeds[] = {
    "# depth rgb\n0.1 depth/0.png 0.11 rgb/0.png\n0.2 rgb/1.png 0.21 depth/1.png\r\n",
    "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n",
    "# timestamp tx ty tz qx qy qz qw\n1305031229.5 1 2 3 0 0 0 1\n1305031228 nan 0 0 0 0 0 0\n",
    "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 1 2\n0 -1 0 3\n1 0 0 4\n0 0 1 5\n0 0 0 1\n"};

size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    int count = (int)(sizeof seeds / sizeof seeds[0]);
    return index < count ? fuzz_copy(seeds[index], out, capacity) : 0;
}

static void check_pose(const rlf_pose *pose)
{
    const rlf_quat *q = &pose->q;
    const double square = q->x * q->x + q->y * q->y + q->z * q->z + q->w * q->w;
    if (square != 0.0 && !(fabs(square - 1.0) < 1e-9 && rlf_vec3_is_finite(pose->p))) {
        abort();
    }
}

static void check_poses(io_pose_list *list)
{
    for (int32_t i = 0; i < list->count; i++) {
        check_pose(&list->poses[i]);
        if (i > 0 && list->times[i] < list->times[i - 1]) {
            abort();
        }
    }
    io_pose_list_free(list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const io_bytes file = {"file.txt", data, size};
    io_frame_list depth, color;
    io_pose_list poses;
    bool has_numbers;
    if (io_associations_parse(&file, &depth, &color, &has_numbers) == RLF_OK) {
        if (depth.count != color.count) {
            abort();
        }
        io_frame_list_free(&depth);
        io_frame_list_free(&color);
    }
    if (io_pose_list_tum(&file, 0.0, 1.0, &poses) == RLF_OK) {
        check_poses(&poses);
    }
    if (io_pose_list_log(&file, &poses) == RLF_OK) {
        check_poses(&poses);
    }
    const rlf_pose pose = io_pose_matrix(&file);
    check_pose(&pose);
    return 0;
}
