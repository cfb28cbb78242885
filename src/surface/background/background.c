/* The back sheet, by the method that the settings name. */
#include "surface/steps.h"

#include <string.h>

void rlf_background_update(rlf_reconstruct *stage, rlf_slot *slot)
{
    stage->has_components = false;
    switch (stage->def.background_method) {
    case RLF_BACKGROUND_OFF: memset(slot->foreground, 0, (size_t)stage->grid.count); break;
    case RLF_BACKGROUND_AVERAGE: rlf_background_average_update(stage, slot); break;
    case RLF_BACKGROUND_ADAPTIVE: rlf_background_adaptive_update(stage, slot); break;
    }
}
