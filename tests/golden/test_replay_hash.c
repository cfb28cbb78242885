/* Replays the synthetic room and compares hashes with those written down here. The same bits must
 * come out of every compiler, optimisation level, instruction set and worker count; a change of
 * method changes them, and then the new ones are written down in the same commit. */

#include "golden_hash.h"
#include "test.h"

#define FRAMES 90
#define EVERY 15

static const golden goldens[] = {
    {RLF_PROFILE_LIVE, 0x482db5ba0c052fa6u, 0x3f2d38e3ffacc66fu, 0xf567e4c00d7c0a5du},
    {RLF_PROFILE_THESIS, 0x661dc320eb5b2361u, 0xd84652fb54683851u, 0xc064b44391e1e990u},
};

TEST_CASE(live_profile_replays_exactly)
{
    golden_check(&goldens[0], 1, FRAMES, EVERY);
    golden_check(&goldens[0], 3, FRAMES, EVERY);
}

TEST_CASE(thesis_profile_replays_exactly)
{
    golden_check(&goldens[1], 1, FRAMES, EVERY);
    golden_check(&goldens[1], 3, FRAMES, EVERY);
}
