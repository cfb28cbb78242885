/* The `relief-lab` command: what Relief is worth, measured. */
#include "dispatch.h"
#include "lab_commands.h"

#include <stddef.h>

static const subcommand commands[] = {
    {"eval", eval_main, "accuracy where the truth is known, against goals and bounds"},
    {"bench", bench_main, "time and memory of every stage, and how they grow"},
    {NULL, NULL, NULL},
};

int main(int argc, char **argv)
{
    static const program lab = {
        .name = "relief-lab",
        .purpose = "Relief's laboratory measures Relief itself: accuracy, time and memory.",
        .examples = "  relief-lab eval --scene room --seeds 1     one scene, seconds\n"
                    "  relief-lab eval                            every figure, minutes\n"
                    "  relief-lab bench --source synthetic:room   milliseconds of every stage\n",
        .commands = commands,
    };
    return dispatch(&lab, argc, argv);
}
