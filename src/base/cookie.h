/* Every def made by a _default function carries this cookie; a zeroed or stray struct does not. */
#ifndef RLF_BASE_COOKIE_H
#define RLF_BASE_COOKIE_H

#define RLF_DEF_COOKIE 0x52454c46u /* "RELF" */

#endif
