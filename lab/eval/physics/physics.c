/* All experiments on bodies. What has no random part is run once, whatever the number of seeds. */
#include "eval/physics/experiments.h"
#include "eval/physics/sheet.h"
#include "eval/sections.h"
#include "eval/table.h"

rlf_result eval_physics_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int profile = 0; profile < EVAL_PROFILES && seed == 1 && result == RLF_OK; profile++) {
        if (profile_mask & (1 << profile)) {
            result = eval_free_run(table, (rlf_profile)profile);
        }
    }
    if (result != RLF_OK || !(profile_mask & (1 << RLF_PROFILE_LIVE))) {
        return result;
    }
    eval_sheet sheet;
    result = eval_sheet_open(&sheet);
    if (result == RLF_OK && seed == 1) {
        result = eval_rest_run(table, &sheet);
    }
    if (result == RLF_OK && seed == 1) {
        result = eval_push_run(table, &sheet);
    }
    if (result == RLF_OK) {
        result = eval_throw_run(table, &sheet, seed);
    }
    eval_sheet_close(&sheet);
    return result;
}
