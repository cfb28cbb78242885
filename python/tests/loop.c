/* The loop that `import relief` is measured against: measure.py has the same in Python.
 * loop SOURCE FRAMES: prints the processor's milliseconds per frame, one thread. */
#include "relief/io.h"
#include "relief/pipeline.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static rlf_result run(rlf_source *source, long frames, double *out_ms)
{
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    rlf_pipeline *pipeline = NULL;
    rlf_result result = rlf_pipeline_create(&def, &pipeline);
    clock_t start = clock();
    for (long i = 0; i < frames && result == RLF_OK; i++) {
        rlf_pipeline_output out;
        start = i == 1 ? clock() : start; /* the first frame warms up */
        result = rlf_pipeline_step(pipeline, &out);
    }
    *out_ms = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC / (double)(frames - 1);
    rlf_pipeline_destroy(&pipeline);
    return result;
}

int main(int argc, char **argv)
{
    rlf_source *source = NULL;
    double ms = 0.0;
    if (argc != 3) {
        fprintf(stderr, "usage: loop SOURCE FRAMES\n");
        return 2;
    }
    rlf_result result = rlf_open_source(argv[1], NULL, &source);
    if (result == RLF_OK) {
        result = run(source, strtol(argv[2], NULL, 10), &ms);
    }
    rlf_source_destroy(&source);
    if (result != RLF_OK) {
        fprintf(stderr, "loop: %s\n", rlf_error_text());
        return 1;
    }
    printf("%.4f\n", ms);
    return 0;
}
