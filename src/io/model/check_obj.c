/* The same for OBJ and MTL, whose lines assimp turns into large structures. */
#include "io/model/import.h"

#include <string.h>

#define CORNERS_MAX 1024 /* of a face: cutting it into triangles takes their square */
#define GROUPS_MAX 65536 /* lines that begin an object, a group or a material */
#define HASHES (4 * RLF_MODEL_PARTS_MAX)

typedef struct counts {
    const char *name;
    int64_t triangles, groups, materials, corners_most;
    uint64_t hashes[HASHES]; /* of the materials' names; 0 = free */
} counts;

/* A line, which goes on where a backslash ends it. */
typedef struct line {
    const uint8_t *data;
    size_t size;
} line;

static line next_line(const io_bytes *file, size_t *at)
{
    const size_t begin = *at;
    size_t end = begin;
    while (end < file->size &&
           (file->data[end] != '\n' || (end > begin && file->data[end - 1] == '\\'))) {
        end++;
    }
    *at = end + 1;
    return (line){file->data + begin, end - begin};
}

static bool is_blank(uint8_t c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\\';
}

/* The line behind its first word, when that is `word`. */
static bool has_word(const line *l, const char *word, line *out_rest)
{
    size_t at = 0;
    while (at < l->size && is_blank(l->data[at])) {
        at++;
    }
    const size_t length = strlen(word);
    if (l->size - at <= length || memcmp(l->data + at, word, length) != 0 ||
        !is_blank(l->data[at + length])) {
        return false;
    }
    at += length;
    *out_rest = (line){l->data + at, l->size - at};
    return true;
}

static int64_t count_words(const line *l)
{
    int64_t count = 0;
    for (size_t i = 0; i < l->size; i++) {
        count += !is_blank(l->data[i]) && (i == 0 || is_blank(l->data[i - 1])) ? 1 : 0;
    }
    return count;
}

/* Counts names that are new. FNV-1a (Fowler, Noll, Vo). */
static void note_material(counts *c, const line *name)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < name->size; i++) {
        if (!is_blank(name->data[i])) {
            hash = (hash ^ name->data[i]) * UINT64_C(1099511628211);
        }
    }
    hash += hash == 0 ? 1 : 0;
    size_t slot = hash % HASHES;
    while (c->hashes[slot] != 0 && c->hashes[slot] != hash) {
        slot = (slot + 1) % HASHES;
    }
    c->materials += c->hashes[slot] == 0 ? 1 : 0;
    c->hashes[slot] = hash;
}

static void take_line(counts *c, const line *l)
{
    line rest;
    if (has_word(l, "f", &rest) || has_word(l, "l", &rest) || has_word(l, "p", &rest)) {
        const int64_t corners = count_words(&rest);
        c->triangles += corners > 3 ? corners - 2 : 1;
        c->corners_most = corners > c->corners_most ? corners : c->corners_most;
    } else if (has_word(l, "usemtl", &rest) || has_word(l, "newmtl", &rest)) {
        c->groups++;
        note_material(c, &rest);
    } else if (has_word(l, "o", &rest) || has_word(l, "g", &rest) || has_word(l, "mtllib", &rest)) {
        c->groups++;
    }
}

static rlf_result check_counts(const counts *c)
{
    if (c->triangles > RLF_MODEL_TRIANGLES_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the model has %lld triangles, at most %d are drawn: simplify it",
                        c->name, (long long)c->triangles, RLF_MODEL_TRIANGLES_MAX);
    }
    if (c->corners_most > CORNERS_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: a face has %lld corners, at most %d: export it as triangles", c->name,
                        (long long)c->corners_most, CORNERS_MAX);
    }
    if (c->materials > RLF_MODEL_PARTS_MAX) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: has more than %d materials: join some", c->name,
                        RLF_MODEL_PARTS_MAX);
    }
    return c->groups <= GROUPS_MAX ? RLF_OK
                                   : rlf_fail(RLF_ERROR_FORMAT,
                                              "%s: has more than %d objects, groups and uses of "
                                              "materials: join some",
                                              c->name, GROUPS_MAX);
}

rlf_result io_model_check_obj(const io_bytes *file)
{
    counts *c = rlf_alloc(sizeof(*c));
    if (c == NULL) {
        return RLF_ERROR_MEMORY;
    }
    c->name = file->name;
    /* The table of names is never full: behind the largest number of materials nothing is noted. */
    for (size_t at = 0; at < file->size && c->materials <= RLF_MODEL_PARTS_MAX;) {
        const line l = next_line(file, &at);
        take_line(c, &l);
    }
    rlf_result result = check_counts(c);
    rlf_free(c);
    return result;
}
