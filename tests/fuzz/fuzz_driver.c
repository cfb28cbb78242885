/* Runs a harness on seeded mutations of its seeds: fuzz_NAME [ITERATIONS [SEED]], or on files:
 * fuzz_NAME FILE... Batches run in child processes; when one dies, its input is searched for and
 * saved as NAME.crash. */
#define _POSIX_C_SOURCE 200809L
#include "fuzz.h"

#include "relief/base.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define INPUT_MAX (1 << 18)
#define SEEDS_MAX 32
#define BATCH 500
#define BATCH_SECONDS 120 /* a batch that takes longer hangs */

typedef struct input {
    uint8_t data[INPUT_MAX];
    size_t size;
} input;

/* Made once: some take longer than what they are for. */
typedef struct seed_list {
    uint8_t *data[SEEDS_MAX];
    size_t size[SEEDS_MAX];
    size_t count;
} seed_list;

static seed_list seeds;

static void list_seeds(void)
{
    static uint8_t data[INPUT_MAX];
    for (size_t size = 1; size > 0 && seeds.count < SEEDS_MAX;) {
        size = fuzz_seed((int)seeds.count, data, INPUT_MAX);
        uint8_t *copy = size > 0 ? malloc(size) : NULL;
        if (copy != NULL) {
            memcpy(copy, data, size);
            seeds.data[seeds.count] = copy;
            seeds.size[seeds.count++] = size;
        }
    }
}

/* SplitMix64 (Steele, Lea and Flood 2014). */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

static size_t below(uint64_t *state, size_t limit)
{
    return limit > 0 ? (size_t)(next_random(state) % limit) : 0;
}

/* Copies a piece of the input over another place, or cuts it out. */
static void move_piece(input *in, uint64_t *state, bool is_cut)
{
    size_t from = below(state, in->size);
    size_t length = below(state, in->size - from);
    if (is_cut) {
        memmove(in->data + from, in->data + from + length, in->size - from - length);
        in->size -= length;
        return;
    }
    size_t to = below(state, in->size);
    size_t room = INPUT_MAX - to;
    memmove(in->data + to, in->data + from, length < room ? length : room);
    in->size =
        to + length > in->size ? (to + length < INPUT_MAX ? to + length : INPUT_MAX) : in->size;
}

/* Another number in the place of the next one: what holds text stays one that can be parsed. */
static void change_number(input *in, uint64_t *state, size_t place)
{
    static const char *const numbers[] = {
        "0",     "1",     "2",          "3",     "7",          "-1", "64",
        "65535", "65536", "2147483647", "1e300", "4294967295", "40", "999999999999"};
    const char *number = numbers[below(state, sizeof(numbers) / sizeof(numbers[0]))];
    const size_t length = strlen(number);
    size_t begin = place;
    while (begin < in->size && (in->data[begin] < '0' || in->data[begin] > '9')) {
        begin++;
    }
    size_t end = begin;
    while (end < in->size && in->data[end] >= '0' && in->data[end] <= '9') {
        end++;
    }
    if (begin == end || in->size - (end - begin) + length > INPUT_MAX) {
        return;
    }
    memmove(in->data + begin + length, in->data + end, in->size - end);
    memcpy(in->data + begin, number, length);
    in->size = in->size - (end - begin) + length;
}

static void mutate(input *in, uint64_t *state)
{
    static const char *const words[] = {"-1",   "1e308", "1e-308", "99999999999999999999",
                                        "null", "NaN",   "[",      "]",
                                        "{}",   "\"",    "0",      "\n",
                                        "#",    "-0.0",  "true"};
    for (size_t count = 1 + below(state, 4); count > 0 && in->size > 0; count--) {
        size_t place = below(state, in->size);
        switch (below(state, 8)) {
        case 0: in->data[place] ^= (uint8_t)(1u << below(state, 8)); break;
        case 1: in->data[place] = (uint8_t)next_random(state); break;
        case 2: in->size = place; break;
        case 3: move_piece(in, state, true); break;
        case 4: move_piece(in, state, false); break;
        case 5:
        case 6: change_number(in, state, place); break;
        default: {
            const char *word = words[below(state, sizeof(words) / sizeof(words[0]))];
            size_t length = strlen(word);
            if (place + length <= in->size) {
                memcpy(in->data + place, word, length);
            }
            break;
        }
        }
    }
}

/* The same bytes for the same seed and iteration, whatever ran before. */
static void make_input(uint64_t seed, long iteration, input *out)
{
    uint64_t state = seed * UINT64_C(1000003) + (uint64_t)iteration;
    const size_t index = below(&state, seeds.count);
    out->size = seeds.size[index];
    memcpy(out->data, seeds.data[index], out->size);
    mutate(out, &state);
}

static void run_one(const uint8_t *data, size_t size)
{
    /* A copy of exactly this size lets the sanitizer see a read past its end. */
    uint8_t *copy = malloc(size > 0 ? size : 1);
    if (copy != NULL) {
        memcpy(copy, data, size);
        LLVMFuzzerTestOneInput(copy, size);
    }
    free(copy);
}

/* True when iterations begin..end-1 run to their end in a child process. */
static bool run_range(uint64_t seed, long begin, long end)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        alarm(BATCH_SECONDS);
        static input in;
        for (long i = begin; i < end; i++) {
            make_input(seed, i, &in);
            run_one(in.data, in.size);
        }
        exit(0); /* not _exit: the leak check runs at exit */
    }
    int status = 1;
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
           WEXITSTATUS(status) == 0;
}

static void save_culprit(const char *program, uint64_t seed, long begin, long end)
{
    for (long i = begin; i < end; i++) {
        if (run_range(seed, i, i + 1)) {
            continue;
        }
        static input in;
        make_input(seed, i, &in);
        char name[512];
        snprintf(name, sizeof(name), "%s.crash", program);
        FILE *file = fopen(name, "wb");
        if (file != NULL) {
            fwrite(in.data, 1, in.size, file);
            fclose(file);
        }
        fprintf(stderr, "seed %llu, iteration %ld failed; its input is in %s\n",
                (unsigned long long)seed, i, name);
        return;
    }
}

static int run_file(const char *name)
{
    static uint8_t data[1 << 20];
    FILE *file = fopen(name, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s: cannot be opened\n", name);
        return 1;
    }
    size_t size = fread(data, 1, sizeof(data), file);
    fclose(file);
    run_one(data, size);
    return 0;
}

int main(int argc, char **argv)
{
    rlf_set_log(NULL, NULL);
    char *end = NULL;
    long iterations = argc > 1 ? strtol(argv[1], &end, 10) : 10000;
    if (end != NULL && *end != '\0') {
        int failed = 0;
        for (int i = 1; i < argc; i++) {
            failed |= run_file(argv[i]);
        }
        return failed;
    }
    list_seeds();
    uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    for (long begin = 0; begin < iterations; begin += BATCH) {
        long limit = begin + BATCH < iterations ? begin + BATCH : iterations;
        if (!run_range(seed, begin, limit)) {
            save_culprit(argv[0], seed, begin, limit);
            return 1;
        }
    }
    printf("%ld iterations of seed %llu: nothing found\n", iterations, (unsigned long long)seed);
    return 0;
}
