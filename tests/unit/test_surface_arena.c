/* The stage's arena: what is taken lies apart, what is lent is shared between owners only. */

#include "base/arena.h"
#include "base/guard.h"
#include "test.h"

enum { COUNT = 5000 };

typedef struct planes {
    rlf_arena arena;
    int32_t rounds;
    uint8_t *taken[2], *first[2], *second;
} planes;

static void take_all(void *context)
{
    planes *p = context;
    p->rounds++;
    p->taken[0] = arena_take(&p->arena, COUNT, 1);
    arena_next_owner(&p->arena);
    p->first[0] = arena_lend(&p->arena, COUNT, 1);
    p->first[1] = arena_lend(&p->arena, COUNT, 1);
    p->taken[1] = arena_take(&p->arena, COUNT, 1);
    arena_next_owner(&p->arena);
    p->second = arena_lend(&p->arena, 3 * COUNT, 1);
}

static bool is_apart(const uint8_t *a, const uint8_t *b)
{
    return a + COUNT <= b || b + COUNT <= a;
}

TEST_CASE(owners_share_and_planes_do_not)
{
    planes p = {.rounds = 0};
    assert_true(arena_create(&p.arena, take_all, &p));
    assert_int_equal(p.rounds, 2); /* to count, to hand out */
    const uint8_t *const apart[] = {p.taken[0], p.taken[1], p.first[0], p.first[1]};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < i; k++) {
            assert_true(is_apart(apart[i], apart[k]));
        }
    }
    for (int k = 0; k < 2; k++) {
        assert_true(p.second + 3 * COUNT <= p.taken[k] || p.taken[k] + COUNT <= p.second);
    }
#ifndef RLF_GUARDS_MEMORY
    assert_true(p.second < p.first[1] + COUNT && p.first[0] < p.second + 3 * COUNT);
#endif
    arena_destroy(&p.arena);
}

TEST_CASE(what_is_lent_is_spoiled_on_demand)
{
    planes p = {.rounds = 0};
    assert_true(arena_create(&p.arena, take_all, &p));
    arena_spoil(&p.arena);
    assert_true(p.first[0][0] == 0 && p.second[3 * COUNT - 1] == 0);
    p.arena.is_spoiled = true;
    arena_spoil(&p.arena);
#ifndef RLF_GUARDS_MEMORY
    assert_true(p.first[0][0] != 0 && p.second[3 * COUNT - 1] != 0);
#endif
    for (int32_t i = 0; i < COUNT; i++) {
        assert_true(p.taken[0][i] == 0 && p.taken[1][i] == 0);
    }
    arena_destroy(&p.arena);
}
