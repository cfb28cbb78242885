/* Settings of the surface stage by name, as `--set NAME=VALUE` gives them. */
#ifndef RELIEF_APP_SETTINGS_H
#define RELIEF_APP_SETTINGS_H

#include "relief/reconstruct.h"

#define SETTINGS_MAX 32

typedef struct setting_list {
    const char *texts[SETTINGS_MAX]; /* "NAME=VALUE", borrowed; later ones win */
    int32_t count;
} setting_list;

/* Keeps "NAME=VALUE". RLF_ERROR_INVALID when there is no such setting, when it cannot have that
 * value, or when there are too many. */
rlf_result settings_add(setting_list *s, const char *text);

/* Puts what was kept into a def. Numbers out of range are found by rlf_reconstruct_create. */
void settings_apply(const setting_list *s, rlf_reconstruct_def *def);

/* What "NAME=VALUE", as it was kept, needs to have an effect and a def lacks; NULL when it has one.
 */
const char *settings_need(const char *text, const rlf_reconstruct_def *def);

/* One line for each that has no effect with a def to which they were applied. */
void settings_warn(const setting_list *s, const rlf_reconstruct_def *def);

/* A setting for people: its name, what it means, what it may be and what it is in a def. */
typedef struct setting_view {
    const char *name, *meaning;
    const char *const *words; /* ends with NULL; a switch has "off" and "on". NULL = a number */
    bool is_switch;
    char value[32];   /* as `--set` takes it */
    const char *need; /* what the def lacks for it to have an effect; NULL = nothing */
} setting_view;

int32_t settings_count(void);
/* `index` from 0 to settings_count() - 1, in the order of `relief list settings`. */
void settings_look(int32_t index, const rlf_reconstruct_def *def, setting_view *out);

/* Prints settings with the values of both profiles for a camera: those that a user chooses, or all:
 * also the steps that the laboratory turns off to measure what each brings. */
void settings_print(const rlf_rig *rig, bool prints_all);

#endif
