/* Lines for people: the thread's error line, names without control codes, how to get a part. */
#ifndef RLF_BASE_MESSAGES_H
#define RLF_BASE_MESSAGES_H

/* ---- The calling thread's error line, for those that make it. */

#define RLF_ERROR_LINE_SIZE 1024 /* with the ending zero */

/* Replaces the line by a copy of text, cut where it is too long, as one line. `text` is not the old
 * line itself. */
void rlf_error_line_set(const char *text);

/* ---- Lines for people. */

/* Names come from files: what a terminal would obey becomes a question mark, a line's end a blank.
 */
static inline void rlf_line_clean(char *text)
{
    for (; *text != '\0'; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 0x20 || c == 0x7f) {
            *text = c == '\n' || c == '\t' ? ' ' : '?';
        }
    }
}

/* ---- How to get a part that this build was made without: one wording for all of them. */

/* Debian's packages, the command that installs them, and the option of the build. All literals. */
#define RLF_GET_PART(packages, command, option)                                                    \
    "install " packages " (`" command "`), then `cmake --preset release -D" option                 \
    "=ON` and build again"

#endif
