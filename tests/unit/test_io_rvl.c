/* RVL: what goes in comes out, the bytes are those of the paper, and damaged ones harm nothing. */
#include "io/picture/pixels.h"
#include "test.h"

#include <stdlib.h>
#include <string.h>

#define COUNT 4099 /* no multiple of anything */

static io_rvl rvl;

static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static int make_tables(void **state)
{
    (void)state;
    io_rvl_init(&rvl);
    return 0;
}

/* Encodes into a block of exactly the bound, decodes from one of exactly the size. */
static void check_round(const uint16_t *depth, size_t count)
{
    uint8_t *bytes = malloc(io_rvl_bound(count));
    const size_t size = io_rvl_encode(&rvl, depth, count, bytes);
    assert_true(size <= io_rvl_bound(count) && size % 4 == 0);
    uint8_t *exact = malloc(size + 1);
    uint16_t *out = malloc(count * sizeof(out[0]) + 1);
    memcpy(exact, bytes, size);
    assert_true(io_rvl_decode(&rvl, exact, size, out, count));
    assert_memory_equal(out, depth, count * sizeof(out[0]));
    free(out);
    free(exact);
    free(bytes);
}

/* Kinds of pictures, from smooth to as bad as can be. */
static void draw(int kind, uint32_t seed, uint16_t *out, size_t count)
{
    uint32_t state = seed * 2654435761u + 1;
    int32_t value = 1500;
    for (size_t i = 0; i < count; i++) {
        const uint32_t r = next_random(&state);
        switch (kind) {
        case 0: value += (int32_t)(r % 7) - 3; break;
        case 1: value = r % 11 == 0 ? 0 : 800 + (int32_t)(r >> 8) % 300; break;
        case 2: value = (int32_t)(r & 65535); break;
        case 3: value = i % 2 == 0 ? 65535 : 1; break;
        case 4: value = i % 2 == 0 ? 0 : 65535; break;
        case 5: value = 0; break;
        default: value = r % 3 == 0 ? 0 : 1 + (int32_t)((r >> 3) % (1u << (1 + r % 16))); break;
        }
        out[i] = (uint16_t)value;
    }
}

TEST_CASE(pictures_come_back_bit_by_bit)
{
    uint16_t depth[COUNT];
    for (int kind = 0; kind < 7; kind++) {
        for (uint32_t seed = 0; seed < 20; seed++) {
            draw(kind, seed, depth, COUNT);
            check_round(depth, COUNT);
        }
        for (size_t count = 0; count < 70; count++) {
            check_round(depth, count);
        }
    }
}

/* By hand: 2 missing, 3 measured: 10 (zigzag 20 = 4 + 8 * 2), +1 (2), -1 (1); 1 missing, 0. */
TEST_CASE(bytes_are_those_of_the_paper)
{
    const uint16_t depth[6] = {0, 0, 10, 11, 10, 0};
    /* Nibbles 2, 3, 12 2, 2, 1, 1, 0: a word from its highest nibble on, little-endian. */
    const uint8_t want[4] = {0x10, 0x21, 0xC2, 0x23};
    uint8_t bytes[128];
    assert_int_equal(io_rvl_encode(&rvl, depth, 6, bytes), 4);
    assert_memory_equal(bytes, want, 4);
}

TEST_CASE(cut_bytes_are_refused)
{
    uint16_t depth[300], out[300];
    draw(1, 3, depth, 300);
    uint8_t bytes[3 * 300 + 64];
    const size_t size = io_rvl_encode(&rvl, depth, 300, bytes);
    for (size_t length = 0; length < size; length++) {
        uint8_t *exact = malloc(length + 1);
        memcpy(exact, bytes, length);
        assert_false(io_rvl_decode(&rvl, exact, length, out, 300));
        free(exact);
    }
    assert_true(io_rvl_decode(&rvl, bytes, size, out, 300));
}

/* Any bytes: an answer, and not one byte outside. */
TEST_CASE(any_bytes_are_survived)
{
    uint32_t random = 7;
    for (int round = 0; round < 5000; round++) {
        const size_t size = next_random(&random) % 200;
        const size_t count = next_random(&random) % 400;
        uint8_t *bytes = malloc(size + 1);
        uint16_t *out = malloc(count * sizeof(out[0]) + 1);
        for (size_t i = 0; i < size; i++) {
            bytes[i] = (uint8_t)next_random(&random);
        }
        (void)io_rvl_decode(&rvl, bytes, size, out, count);
        free(out);
        free(bytes);
    }
}

TEST_GROUP(make_tables, NULL)
