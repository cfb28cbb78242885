/* The calling thread's error line, for those that make it. */
#ifndef RLF_BASE_ERROR_LINE_H
#define RLF_BASE_ERROR_LINE_H

#define RLF_ERROR_LINE_SIZE 1024 /* with the ending zero */

/* Replaces the line by a copy of text, cut where it is too long, as one line. `text` is not the old
 * line itself. */
void rlf_error_line_set(const char *text);

#endif
