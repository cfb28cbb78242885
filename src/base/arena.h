/* Memory of a thing whose size is known when it is made: one block, handed out plane by plane. */
#ifndef RLF_BASE_ARENA_H
#define RLF_BASE_ARENA_H

#include "relief/base.h"

typedef struct rlf_arena {
    unsigned char *memory; /* NULL = what is asked for is only counted */
    size_t used;           /* bytes */
    int32_t blocks;        /* handed out so far */
    unsigned char *shared; /* what owners of scratch planes share */
    size_t shared_used, shared_size;
    bool is_spoiled; /* for tests: see arena_spoil */
} rlf_arena;

/* `count` things of `size` bytes, all 0, on a page of their own. Without memory yet, only counts
 * them and returns NULL. What lies between two blocks is guarded. */
void *arena_take(rlf_arena *arena, size_t count, size_t size);

/* Scratch planes: an owner, a module that runs by itself, has what it lends until the next owner
 * runs, and nothing in it holds longer. arena_next_owner begins the planes of the next one, in the
 * same memory. Where memory is guarded each owner has its own. */
void arena_next_owner(rlf_arena *arena);
void *arena_lend(rlf_arena *arena, size_t count, size_t size);

/* Makes the arena by calling `take_all` twice: to count, and to hand out. False when memory is
 * short. */
bool arena_create(rlf_arena *arena, void (*take_all)(void *context), void *context);
void arena_destroy(rlf_arena *arena);

/* Between two owners: overwrites what they share, if `is_spoiled`. */
void arena_spoil(const rlf_arena *arena);

#endif
