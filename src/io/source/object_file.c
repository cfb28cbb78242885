/* Shared objects, looked at before they are mapped; Windows itself looks whether they are whole. */
#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64
#include "io/source/backends.h"

#include <dlfcn.h>
#ifdef _WIN32
#define fault_of(path) NULL
#else
#include <elf.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#if UINTPTR_MAX > 0xFFFFFFFFu
typedef Elf64_Ehdr elf_header;
typedef Elf64_Phdr elf_segment;
#else
typedef Elf32_Ehdr elf_header;
typedef Elf32_Phdr elf_segment;
#endif

/* The parts that will be mapped lie inside the file. */
static bool has_segments(FILE *file, const elf_header *header, uint64_t size)
{
    if (header->e_phentsize != sizeof(elf_segment) || header->e_phoff > size ||
        fseeko(file, (off_t)header->e_phoff, SEEK_SET) != 0) {
        return false;
    }
    for (int i = 0; i < header->e_phnum; i++) {
        elf_segment segment;
        if (fread(&segment, sizeof(segment), 1, file) != 1 ||
            (segment.p_type == PT_LOAD &&
             (segment.p_offset > size || segment.p_filesz > size - segment.p_offset))) {
            return false;
        }
    }
    return true;
}

/* NULL = the file looks whole; else what is wrong. */
static const char *fault_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return strerror(errno);
    }
    if (!S_ISREG(status.st_mode)) {
        return "it is no file";
    }
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return strerror(errno);
    }
    elf_header header;
    const char *fault = NULL;
    if (fread(&header, sizeof(header), 1, file) != 1 ||
        memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) {
        fault = "it is no shared object";
    } else if (!has_segments(file, &header, (uint64_t)status.st_size)) {
        fault = "it is cut short or for another kind of machine";
    }
    fclose(file);
    return fault;
}

#endif

void *io_object_open(const char *path, const char **out_fault)
{
    *out_fault = strchr(path, '/') != NULL ? fault_of(path) : NULL;
    void *object = *out_fault == NULL ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
    if (object == NULL && *out_fault == NULL) {
        *out_fault = dlerror();
    }
    return object;
}
