/* How to get a part that this build was made without: one wording for all of them. */
#ifndef RLF_BASE_PART_H
#define RLF_BASE_PART_H

/* Debian's packages, the command that installs them, and the option of the build. All literals. */
#define RLF_GET_PART(packages, command, option)                                                    \
    "install " packages " (`" command "`), then `cmake --preset release -D" option                 \
    "=ON` and build again"

#endif
