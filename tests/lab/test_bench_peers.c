/* The clip for other libraries, the quality of a surface by their harness's measures, and the table
 * of their results. */
#define _POSIX_C_SOURCE 200809L

#include "bench/peers.h"
#include "io_support.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define W 40
#define H 30
#define COUNT (W * H)

/* A wall at 3 m whose right half is a person at 2 m. */
typedef struct still {
    uint16_t depth[COUNT];
    float z[COUNT], normal[3 * COUNT];
    uint8_t label[COUNT];
    float found_z[COUNT], found_n[COUNT], zero[COUNT];
    int32_t found_label[COUNT];
    uint8_t foreground[COUNT];
    rlf_region regions[2];
} still;

static void make_still(still *s, bench_clip *clip, rlf_surface *surface)
{
    memset(s, 0, sizeof(*s));
    for (int i = 0; i < COUNT; i++) {
        bool is_person = i % W >= W / 2;
        s->z[i] = s->found_z[i] = is_person ? 2.0f : 3.0f;
        s->depth[i] = (uint16_t)(1000 * s->z[i]);
        s->normal[3 * i + 2] = s->found_n[i] = -1.0f;
        s->label[i] = is_person ? CLIP_LABEL_PERSON : 11;
        s->foreground[i] = is_person;
        s->found_label[i] = is_person ? 7 : 3;
    }
    s->regions[0].label = 3;
    s->regions[1].label = 7;
    *clip = (bench_clip){.rig = {.depth = {.width = W, .height = H}},
                         .frame_count = 1,
                         .pixels = COUNT,
                         .depth = s->depth,
                         .z = s->z,
                         .normal = s->normal,
                         .label = s->label};
    *surface = (rlf_surface){.width = W,
                             .height = H,
                             .scale_factor = 1,
                             .depth = s->found_z,
                             .normal_x = s->zero,
                             .normal_y = s->zero,
                             .normal_z = s->found_n,
                             .label = s->found_label,
                             .foreground = s->foreground,
                             .regions = s->regions,
                             .region_count = 2};
}

TEST_CASE(perfect_surface_is_perfect)
{
    static still s;
    bench_clip clip;
    rlf_surface surface;
    bench_quality q;
    make_still(&s, &clip, &surface);
    bench_quality_measure(&clip, 0, &surface, &q);
    assert_true(q.interior_normals == 100.0 && q.edge_normals == 100.0);
    assert_true(q.interior_median_deg < 1e-6 && q.interior_wrong == 0.0 && q.edge_wrong == 0.0);
    assert_true(q.recall == 100.0 && q.precision == 100.0);
    assert_true(q.regions == 2 && q.big_regions == 2 && q.in_big_regions == 100.0);
    assert_true(q.interior_rmse_mm < 1e-3 && q.edge_wrong_40_mm == 0.0);
    assert_true(isnan(q.holes_filled)); /* there is none */
}

TEST_CASE(errors_fall_into_their_place)
{
    static still s;
    bench_clip clip;
    rlf_surface surface;
    bench_quality q;
    make_still(&s, &clip, &surface);
    s.found_n[10 * W + 8] = 0.0f;     /* interior, lost */
    s.found_n[10 * W + W / 2] = 0.0f; /* edge, lost */
    s.zero[12 * W + W / 2] = 1.0f;    /* edge, turned by 90 degrees (x and y of the normal) */
    s.found_n[12 * W + W / 2] = 0.0f;
    s.depth[14 * W + 8] = 0; /* a hole that was filled */
    s.depth[15 * W + 8] = 0; /* and one that was not */
    s.found_z[15 * W + 8] = 0.0f;
    s.found_z[16 * W + 8] += 0.02f;   /* interior error of 2 cm */
    s.found_z[16 * W + W / 2] = 3.0f; /* wrong side of the edge */
    s.foreground[5 * W + W - 1] = 0;  /* missed */
    s.foreground[5 * W] = 1;          /* invented */
    bench_quality_measure(&clip, 0, &surface, &q);
    double interior = 24.0 * 28, edge = 24.0 * 6; /* 3 pixels off the border and about the edge */
    assert_true(fabs(q.interior_normals - 100.0 * (1 - 1 / (interior - 2))) < 1e-9);
    assert_true(fabs(q.edge_normals - 100.0 * (1 - 1 / edge)) < 1e-9);
    assert_true(fabs(q.edge_wrong - 100.0 / (edge - 1)) < 1e-9);
    assert_true(fabs(q.holes_filled - 50.0) < 1e-9);
    assert_true(fabs(q.interior_rmse_mm - 20.0 / sqrt(interior - 2)) < 1e-3);
    assert_true(fabs(q.edge_wrong_40_mm - 100.0 / edge) < 1e-9);
    assert_true(fabs(q.recall - 100.0 * (COUNT / 2 - 1) / (COUNT / 2)) < 1e-9);
    assert_true(fabs(q.precision - 100.0 * (COUNT / 2 - 1) / (COUNT / 2)) < 1e-9);
}

TEST_CASE_WITH(clip_is_written_as_it_is, test_folder_make, test_folder_remove)
{
    static still s;
    bench_clip clip;
    rlf_surface surface;
    make_still(&s, &clip, &surface);
    clip.rig.depth.fx = 30.5;
    assert_int_equal(bench_clip_write(&clip, test_path("clip.raw")), RLF_OK);
    size_t size, truth_size;
    char *raw = test_read(test_path("clip.raw"), &size);
    char *truth = test_read(test_path("clip.raw.gt"), &truth_size);
    const char *head = "40 30 1 30.5 0 0 0\n";
    assert_memory_equal(raw, head, strlen(head));
    assert_int_equal(size, strlen(head) + sizeof(s.depth));
    assert_memory_equal(raw + strlen(head), s.depth, sizeof(s.depth));
    assert_int_equal(truth_size, sizeof(s.z) + sizeof(s.normal) + sizeof(s.label));
    assert_memory_equal(truth, s.z, sizeof(s.z));
    assert_memory_equal(truth + sizeof(s.z) + sizeof(s.normal), s.label, sizeof(s.label));
    free(raw);
    free(truth);
    assert_int_equal(bench_clip_write(&clip, test_path("no/folder/clip.raw")), RLF_ERROR_IO);
}

TEST_CASE_WITH(results_stand_beside_ours, test_folder_make, test_folder_remove)
{
    static bench_table table;
    test_write_text("results.txt",
                    "# a comment\n"
                    "opencv B_normals_FALS_w5 512 424 1 1000 900 1000 30\n"
                    "Q opencv B_normals_FALS_w5 512 424 1 interior_normals_pct 99.5\n"
                    "opencv A_depthTo3d_u16 512 424 1 0.2 0.2 0.2 30\n"
                    "pcl C_occ 512 424 1 2000 900 1000 30\n");
    bench_options o = {.peers_path = test_path("results.txt")};
    json_t *json = NULL;
    assert_int_equal(bench_peers_run(&o, &table, &json), RLF_OK);
    json_t *normals = json_array_get(json, 0);
    json_t *rows = json_object_get(normals, "rows");
    assert_int_equal(json_array_size(rows), 3); /* ours twice, and faster */
    json_t *last = json_array_get(rows, 2);
    assert_string_equal(json_string_value(json_object_get(last, "peer")), "opencv");
    assert_true(json_real_value(json_object_get(last, "least")) == 900.0);
    json_t *values = json_object_get(last, "values");
    assert_int_equal(json_array_size(values), json_array_size(json_object_get(normals, "heads")));
    assert_true(json_real_value(json_array_get(values, 0)) == 99.5);
    assert_true(json_is_null(json_array_get(values, 1)));
    json_decref(json);
    assert_int_equal(table.count, 6 + 2); /* ours of 4 + 2 stages; deprojection is of none */
    const bench_row *fals = bench_find(&table, "peers", "opencv normals_FALS_w5");
    assert_non_null(fals);
    assert_true(fals->median == 1000.0 && fals->ratio > 1.0);
    const bench_row *ours = bench_find(&table, "peers", "relief segment");
    assert_non_null(ours);
    assert_true(ours->ratio == 1.0 && ours->median > 0.0);
    test_write_text("nothing.txt", "# nothing\n");
    o.peers_path = test_path("nothing.txt");
    assert_int_equal(bench_peers_check(o.peers_path), RLF_ERROR_FORMAT);
    assert_int_equal(bench_peers_run(&o, &table, &json), RLF_ERROR_FORMAT);
}
