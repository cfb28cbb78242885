/* Rows of real recordings, and how they are shown. */
#define _POSIX_C_SOURCE 200809L
#include "eval/real/real.h"

#include "eval/table.h"
#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

bool real_join(char path[REAL_PATH_SIZE], const char *folder, const char *name)
{
    int length = snprintf(path, REAL_PATH_SIZE, "%s/%s", folder, name);
    return length > 0 && length < REAL_PATH_SIZE;
}

bool real_is_there(const char *path)
{
    struct stat status;
    bool is_there = stat(path, &status) == 0 && S_ISDIR(status.st_mode);
    if (!is_there) {
        fprintf(stderr, "SKIPPED: there is no folder %s\n", path);
    }
    return is_there;
}

void real_add(real_table *table, const char *part, const real_row *row)
{
    table->is_full = table->is_full || table->count == REAL_ROWS_MAX;
    if (table->count < REAL_ROWS_MAX) {
        real_row *out = &table->rows[table->count++];
        *out = *row;
        (void)snprintf(out->part, sizeof(out->part), "%s", part);
    }
}

void real_add_headlines(const real_table *table, eval_table *out)
{
    static const struct {
        const char *key, *other_key, *title;
    } headlines[] = {
        {"normals_plane_deg", "normals_interior_mean_deg", "normals on large planes, deg"},
        {"normals_plane_over_30_percent", "normals_interior_over_30_percent", "  over 30 deg, %"},
        {"foreground_f", "foreground_f", "foreground: F"},
        {"matte_outline_mean_px", "person_mean_px", "outline of a person: off by, px"},
        {"object_iou", "object_iou", "objects on tables: IoU of the best region"},
        {"up_right_percent", "up_right_percent", "up within 10 deg, any roll, %"},
    };
    for (size_t h = 0; h < sizeof(headlines) / sizeof(headlines[0]); h++) {
        for (int32_t i = 0; i < table->count; i++) {
            const real_row *row = &table->rows[i];
            if (strcmp(row->key, headlines[h].key) == 0 && !isnan(row->relief)) {
                eval_table_add(out, "real", headlines[h].other_key, headlines[h].title,
                               RLF_PROFILE_LIVE, row->relief);
            }
        }
    }
}

static void format(double value, char out[24])
{
    if (isnan(value)) {
        (void)snprintf(out, 24, "-");
    } else {
        (void)snprintf(out, 24, "%.4g", value);
    }
}

static const char *verdict(const real_row *row)
{
    if (isnan(row->goal) || isnan(row->relief)) {
        return "";
    }
    bool is_met = row->relation == '<' ? row->relief <= row->goal : row->relief >= row->goal;
    return is_met ? "goal" : "SHORT of the goal";
}

void real_print(const real_table *table)
{
    if (table->count > 0) {
        printf("%-58s %9s  %-9s %-9s %s\n", "real recordings", "goal", "Relief", "baseline", "");
    }
    const char *part = "";
    for (int32_t i = 0; i < table->count; i++) {
        const real_row *row = &table->rows[i];
        char goal[40] = "", relief[24], baseline[24], number[24];
        if (!isnan(row->goal)) {
            format(row->goal, number);
            (void)snprintf(goal, sizeof(goal), "%s %s", row->relation == '<' ? "<=" : ">=", number);
        }
        if (strcmp(part, row->part) != 0) {
            printf("%s\n", row->part);
            part = row->part;
        }
        format(row->relief, relief);
        format(row->baseline, baseline);
        printf("  %-56s %9s  %-9s %-9s %s%s%s\n", row->title, goal, relief, baseline,
               row->baseline_name, verdict(row)[0] != '\0' ? "; " : "", verdict(row));
    }
}

json_t *real_json(const real_table *table)
{
    json_t *rows = json_array();
    for (int32_t i = 0; i < table->count; i++) {
        const real_row *row = &table->rows[i];
        json_array_append_new(
            rows, json_pack("{s:s, s:s, s:s, s:s, s:o, s:o, s:o, s:s}", "part", row->part, "key",
                            row->key, "title", row->title, "relation",
                            row->relation == '<' ? "<=" : ">=", "goal", json_file_number(row->goal),
                            "relief", json_file_number(row->relief), "baseline",
                            json_file_number(row->baseline), "baseline_name", row->baseline_name));
    }
    return rows;
}
