/* A stranger's program: drops a ball onto nothing for a second and opens the synthetic room. It has
 * functions of its own whose names Relief uses inside: neither library may call the other's. */
#include "relief/relief.h"
#ifdef WITH_SIM
#include "relief/synthetic.h"
#endif
#ifdef WITH_IO
#include "relief/io.h"
#endif
#ifdef WITH_GL
#include "relief/gl.h"
#endif
#ifdef WITH_WINDOW
#include "relief/window.h"
#endif

#include <stdio.h>

static int stolen_calls;

void grid_collide(void);
void io_file_read(void);
void grid_collide(void)
{
    stolen_calls++;
}
void io_file_read(void)
{
    stolen_calls++;
}

static double height_after_one_second(void)
{
    rlf_world_def world_def = rlf_world_def_default();
    rlf_body_def body_def = rlf_body_def_default();
    rlf_body_id id;
    rlf_world *world = NULL;
    double y = 0.0;
    if (rlf_world_create(&world_def, &world) == RLF_OK &&
        rlf_world_add_body(world, &body_def, &id) == RLF_OK) {
        rlf_world_advance(world, NULL, 1.0);
        y = rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.y;
    }
    rlf_world_destroy(&world);
    return y;
}

int main(void)
{
    rlf_source *source = NULL;
    double y = height_after_one_second();
    rlf_result opened = RLF_OK;
#if defined(WITH_IO)
    opened = rlf_open_source("synthetic:empty", NULL, &source);
#elif defined(WITH_SIM)
    rlf_synthetic_def def = rlf_synthetic_def_default();
    opened = rlf_synthetic_create(&def, &source);
#endif
#ifdef WITH_WINDOW
    rlf_window_def window = rlf_window_def_default();
    opened = window.use_gl ? opened : RLF_ERROR_INVALID;
#endif
#ifdef WITH_GL
    rlf_gl_presenter_destroy(NULL);
#endif
    rlf_source_destroy(&source);
    printf("Relief %s: fell %.2f m\n", rlf_version(), y);
    return opened == RLF_OK && y > 4.8 && y < 5.0 && stolen_calls == 0 ? 0 : 1;
}
