/* Lines for people. */
#ifndef RLF_BASE_LINE_H
#define RLF_BASE_LINE_H

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

#endif
