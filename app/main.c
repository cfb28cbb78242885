/* The `relief` command: what it can do. */
#include "command.h"
#include "dispatch.h"

#include <stddef.h>

static const subcommand commands[] = {
    {"run", run_main, "show a source with virtual bodies, in a window or headless"},
    {"record", record_main, "record a camera, or turn a recording into another kind"},
    {"place", place_main, "put models of real things where the things are"},
    {"export", export_main, "write arrays of every frame: depth, normals, labels, truth, ..."},
    {"info", info_main, "tell what a source is"},
    {"calibrate", calibrate_main, "lenses and poses of the cameras, from pictures of a chessboard"},
    {"list", list_main, "list sources, scenes or settings"},
    {NULL, NULL, NULL},
};

/* Words of earlier versions. */
static const moved_word moved[] = {
    {"eval", NULL, "relief-lab eval"},
    {"measure", NULL, "relief-lab measure, or relief info SOURCE --noise or --up"},
    {"bench", NULL, "relief-lab bench"},
    {"sources", NULL, "relief list sources"},
    {"scenes", NULL, "relief list scenes"},
    {"settings", NULL, "relief list settings"},
    {"fuse", NULL, "relief run SOURCE --headless --mesh ROOM.ply"},
    {"run", "picture-every", "--pictures DIR?every=N"},
    {"run", "picture-at", "--pictures DIR?at=N+N"},
    {"run", "picture-shrink", "--pictures DIR?shrink=N"},
    {"run", "record-bodies", "--record FILE.mcap?bodies"},
    {"run", "codec", "--record FILE.mcap?codec=NAME"},
    {"run", "jpeg-quality", "--record FILE.mcap?jpeg-quality=N"},
    {"run", "lossless", "--record FILE.mcap?lossless=color"},
    {"run", "compression", "--record FILE.mcap?compression=NAME"},
    {"run", "fullscreen", "--window full"},
    {"run", "monitor", "--window full=N"},
    {"run", "mirror", "--window mirror"},
    {"run", "overlay", "--window text=on, off or full"},
    {"run", "no-panel", "--window panel=off"},
    {"run", "end", "--window end=NAME"},
    {"run", "poses", "--camera source, or --camera moving for tracked ones"},
    {"run", "grab", "--hands grab"},
    {"run", "match-light", "--light auto"},
    {"run", "no-match-light", "--light scene"},
    {"run", "legend", "--view 'NAME?legend'"},
    {"run", "no-real-shade", "--shade near"},
    {"run", "no-real-ambient", "--shade cast"},
    {NULL, NULL, NULL},
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
