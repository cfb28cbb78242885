/* One block of memory, large enough for large pages. */
#include "base/arena.h"

#include "base/guard.h"

#include <string.h>

/* Blocks begin on pages of their own, each some lines of cache further into its page than the one
 * before: planes are read side by side, and the same place of all of them must not meet the same
 * few sets of the first cache. */
#define PAGE 4096
#define LINE 64
#define LINES_APART 5

/* Where the next block begins after so many bytes. */
static size_t next_begin(rlf_arena *arena, size_t used)
{
    return (used + PAGE - 1) / PAGE * PAGE +
           (size_t)(arena->blocks++ * LINES_APART) % (PAGE / LINE) * LINE;
}

void *arena_take(rlf_arena *arena, size_t count, size_t size)
{
    size_t before = arena->used, begin = next_begin(arena, before);
    size_t end = begin + (count * size + LINE - 1) / LINE * LINE;
    arena->used = end + LINE;
    if (arena->memory == NULL) {
        return NULL;
    }
    rlf_guard(arena->memory + before, begin - before);
    rlf_guard(arena->memory + end, LINE);
    return arena->memory + begin;
}

void arena_next_owner(rlf_arena *arena)
{
    arena->shared_used = 0;
}

void *arena_lend(rlf_arena *arena, size_t count, size_t size)
{
#ifdef RLF_GUARDS_MEMORY
    return arena_take(arena, count, size);
#else
    size_t begin = next_begin(arena, arena->shared_used);
    arena->shared_used = begin + (count * size + LINE - 1) / LINE * LINE + LINE;
    if (arena->memory == NULL) {
        arena->shared_size =
            arena->shared_size > arena->shared_used ? arena->shared_size : arena->shared_used;
        return NULL;
    }
    return arena->shared + begin;
#endif
}

bool arena_create(rlf_arena *arena, void (*take_all)(void *context), void *context)
{
    *arena = (rlf_arena){.memory = NULL};
    take_all(context);
    const rlf_arena counted = *arena;
    arena_take(arena, arena->shared_size, 1);
    arena->memory = rlf_alloc(arena->used);
    if (arena->memory == NULL) {
        return false;
    }
    /* What is shared lies behind all else, where its place is known from the first round. */
    arena->used = counted.used;
    arena->blocks = counted.blocks;
    arena->shared = arena_take(arena, arena->shared_size, 1);
    arena->used = 0;
    arena->blocks = 0;
    take_all(context);
    return true;
}

void arena_destroy(rlf_arena *arena)
{
    if (arena->memory != NULL) {
        rlf_unguard(arena->memory, arena->used);
    }
    rlf_free(arena->memory);
    arena->memory = NULL;
}

void arena_spoil(const rlf_arena *arena)
{
    if (arena->is_spoiled && arena->shared != NULL) {
        memset(arena->shared, 0xa5, arena->shared_size);
    }
}
