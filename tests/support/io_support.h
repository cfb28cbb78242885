/* Temporary folders and files for tests of librelief_io. Include after cmocka.h. */
#ifndef RLF_TEST_IO_SUPPORT_H
#define RLF_TEST_IO_SUPPORT_H

#include "test.h"
#include "relief/base.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TEST_PATH_MAX 512

static char test_folder[64];

/* Makes an empty folder below the working directory; its name is in test_folder. */
static inline int test_folder_make(void **state)
{
    (void)state;
    strcpy(test_folder, "io-test-XXXXXX");
    return mkdtemp(test_folder) != NULL ? 0 : -1;
}

static inline void test_remove_tree(const char *path)
{
    DIR *folder = opendir(path);
    if (folder == NULL) {
        remove(path);
        return;
    }
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            char child[TEST_PATH_MAX + 260];
            int length = snprintf(child, sizeof(child), "%s/%s", path, entry->d_name);
            if (length > 0 && (size_t)length < sizeof(child)) {
                test_remove_tree(child);
            }
        }
    }
    closedir(folder);
    rmdir(path);
}

static inline int test_folder_remove(void **state)
{
    (void)state;
    test_remove_tree(test_folder);
    return 0;
}

/* test_folder/name; one of four buffers in turn. */
static inline const char *test_path(const char *name)
{
    static char paths[4][TEST_PATH_MAX];
    static int turn;
    char *path = paths[turn++ % 4];
    snprintf(path, TEST_PATH_MAX, "%s/%s", test_folder, name);
    return path;
}

static inline void test_write(const char *name, const void *data, size_t size)
{
    (void)remove(test_path(name)); /* some file systems wait for the disk where one is truncated */
    FILE *file = fopen(test_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static inline void test_write_text(const char *name, const char *text)
{
    test_write(name, text, strlen(text));
}

/* Content of a file, with a zero behind it; free() it. */
static inline char *test_read(const char *path, size_t *out_size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    long size = ftell(file);
    rewind(file);
    char *data = calloc(1, (size_t)size + 1);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, (size_t)size, file), size);
    fclose(file);
    *out_size = (size_t)size;
    return data;
}

static inline bool test_exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

/* The call failed as expected with one line that holds all of the texts (NULL ones are skipped). */
static inline void test_expect_error(rlf_result got, rlf_result wanted, const char *file,
                                     const char *part, const char *cure)
{
    const char *line = rlf_error_text();
    const char *const texts[3] = {file, part, cure};
    if (got != wanted) {
        print_error("got %s, not %s: %s\n", rlf_result_name(got), rlf_result_name(wanted), line);
    }
    assert_int_equal(got, wanted);
    assert_null(strchr(line, '\n'));
    for (int i = 0; i < 3; i++) {
        if (texts[i] != NULL && strstr(line, texts[i]) == NULL) {
            fail_msg("\"%s\" does not mention \"%s\"", line, texts[i]);
        }
    }
}

/* Counts log lines and keeps the last one. */
typedef struct test_log {
    int count;
    char last[512];
} test_log;

static inline void test_log_line(void *context, rlf_log_level level, const char *line)
{
    (void)level;
    test_log *log = context;
    log->count++;
    snprintf(log->last, sizeof(log->last), "%s", line);
}

#endif
