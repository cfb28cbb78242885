/* The `relief` command: what it can do. */
#include "commands.h"
#include "dispatch.h"

#include <stddef.h>

static const subcommand commands[] = {
    {"run", run_main, "show a source with virtual bodies, in a window or headless"},
    {"record", record_main, "record a camera, or turn a recording into another kind"},
    {"place", place_main, "put models of real things where the things are"},
    {"export", export_main, "write arrays of every frame: depth, normals, labels, truth, ..."},
    {"fuse", fuse_main, "fuse the frames of a moving camera into a mesh and a map of the room"},
    {"info", info_main, "tell what a source is"},
    {"calibrate", calibrate_main, "lenses and poses of the cameras, from pictures of a chessboard"},
    {"sources", sources_main, "list cameras, and the kinds of source that this build can open"},
    {"scenes", scenes_main, "list the scenes that come with Relief, for --scene"},
    {"settings", settings_main, "list the settings of the surface stage, for --set"},
    {NULL, NULL, NULL},
};

/* What measures Relief itself does nothing for a user. */
static const moved_command moved[] = {
    {"eval", "relief-lab eval"},
    {"measure", "relief-lab measure"},
    {"bench", "relief-lab bench"},
    {NULL, NULL},
};

int main(int argc, char **argv)
{
    static const program relief = {
        .name = "relief",
        .purpose = "Relief lets virtual things touch the real world that a depth camera sees.",
        .examples =
            "  relief                                         choose a camera, recording or scene\n"
            "  relief run synthetic:room                      a window, no camera needed\n"
            "  relief run synthetic:room --headless --video out.mp4\n"
            "  relief run path/to/clip --scene rain\n",
        .commands = commands,
        .moved = moved,
        .run_alone = run_alone,
    };
    return dispatch(&relief, argc, argv);
}
