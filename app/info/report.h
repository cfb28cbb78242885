/* What `relief info` says: on the screen and as JSON. */
#ifndef RELIEF_APP_INFO_REPORT_H
#define RELIEF_APP_INFO_REPORT_H

#include "info/survey.h"

void report_print(const rlf_source_info *info, const survey *s);
rlf_result report_write_json(const rlf_source_info *info, const survey *s, const char *path);

/* Whether colour and depth are said to be one camera's. */
bool report_says_aligned(const rlf_source_info *info, const survey *s);

#endif
