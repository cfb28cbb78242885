/* The run over all parts. */
#include "eval/real/run.h"

#include "command.h"
#include "eval/real/parts.h"

#include <stdio.h>

rlf_result real_run(real_table *table, const real_options *options)
{
    typedef rlf_result (*part_fn)(real_table *, const real_options *);
    static const struct {
        const char *name;
        part_fn run;
    } parts[] = {
        {"still clips", real_still_run},
        {"silhouettes", real_silhouettes_run},
        {"moving cameras", real_moving_run},
        {"standing cameras", real_standing_run},
    };
    if (!real_is_there(options->folder)) {
        printf("real clips: SKIPPED, there is no folder %s\n", options->folder);
        return RLF_OK;
    }
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < sizeof(parts) / sizeof(parts[0]) && result == RLF_OK; i++) {
        if (!command_interrupted) {
            fprintf(stderr, "real: %s\n", parts[i].name);
            result = parts[i].run(table, options);
        }
    }
    return result;
}
