/* Control of the stub libk4a. */
#ifndef RLF_TEST_STUB_K4A_H
#define RLF_TEST_STUB_K4A_H

#include "stub_camera.h"

typedef struct stub_k4a {
    stub_fault fault;
    int lens_type;        /* of both cameras; 4 = Brown-Conrady */
    bool gives_raw;       /* colour as BGRA whatever was asked for */
    int configuration[5]; /* that the camera was started with: format, resolution, mode, rate, sync
                           */
} stub_k4a;

stub_k4a *stub_k4a_get(void);

#endif
