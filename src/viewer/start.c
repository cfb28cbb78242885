/* The window's start page. */
#include "relief/window.h"

#include "relief/gl.h"
#include "relief/pipeline.h"
#include "relief/synthetic.h"
#include "viewer/mouse.h"
#include "viewer/panel.h"
#include "viewer/window.h"

#include <stdio.h>
#include <string.h>

#define WIDTH 480 /* of the picture; the window is twice as large */
#define HEIGHT 270
#define KEY_O 10 /* the view that it is for in the window */
#define WAIT_S 0.05
#define HEAD 1 /* lines over the list */
#define FOOT 1
#define ROWS 22 /* of the list that are shown at a time */
#define LINES_MAX (HEAD + ROWS + FOOT)
#define LINE_SIZE 128
/* The overlay's layout in a picture of this height: where its lines begin, and how far apart. */
#define LINE_START 2.0
#define LINE_PITCH 10.0

typedef struct start_page {
    rlf_window_list_fn list;
    void *context;
    rlf_window_choice choices[RLF_WINDOW_CHOICES_MAX];
    int32_t count, selected, first; /* first of those that are shown */
    int32_t chosen;                 /* -1 = none yet */
    char lines[LINES_MAX][LINE_SIZE];
    viewer_window window;
    viewer_menu *menu; /* NULL = lines of text in the picture */
    rlf_gl_presenter *presenter;
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_pipeline_output frame;
} start_page;

static rlf_result open_room(start_page *page)
{
    rlf_synthetic_def synthetic = rlf_synthetic_def_default();
    synthetic.enable_truth = false;
    synthetic.color_width = WIDTH;
    synthetic.color_height = HEIGHT;
    rlf_result result = rlf_synthetic_create(&synthetic, &page->source);
    if (result != RLF_OK) {
        return result;
    }
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_THESIS, page->source, NULL);
    def.compositor.enable_overlay = true;
    result = rlf_pipeline_create(&def, &page->pipeline);
    return result == RLF_OK ? rlf_pipeline_step(page->pipeline, &page->frame) : result;
}

static void look_again(start_page *page)
{
    page->count = page->list(page->context, page->choices);
    page->selected = page->selected < page->count ? page->selected : 0;
    if (page->menu != NULL) {
        viewer_menu_look(page->menu, page->choices, page->count);
    }
}

/* What is selected is shown. */
static void scroll(start_page *page)
{
    const int32_t most = page->count > ROWS ? page->count - ROWS : 0;
    page->first = page->selected < page->first ? page->selected : page->first;
    page->first = page->selected >= page->first + ROWS ? page->selected - ROWS + 1 : page->first;
    page->first = page->first < most ? page->first : most;
}

static rlf_result draw(start_page *page)
{
    if (page->menu != NULL) {
        return RLF_OK; /* present() draws it over the room */
    }
    scroll(page);
    const char *pointers[LINES_MAX];
    int32_t count = 0;
    (void)snprintf(page->lines[count++], LINE_SIZE,
                   "Relief: choose a camera, a recording or a scene");
    for (int32_t i = page->first; i < page->count && i < page->first + ROWS; i++) {
        char number[4] = " ";
        (void)snprintf(number, sizeof(number), "%d", (int)(i + 1) % 100);
        (void)snprintf(page->lines[count++], LINE_SIZE, "%s %s  %s",
                       i == page->selected ? ">" : " ", i < 9 ? number : " ",
                       page->choices[i].text);
    }
    (void)snprintf(page->lines[count++], LINE_SIZE,
                   "arrows and Enter, number or click   R look again   Q quit%s",
                   page->first + ROWS < page->count ? "   more below" : "");
    for (int32_t i = 0; i < count; i++) {
        pointers[i] = page->lines[i];
    }
    rlf_pipeline_set_overlay(page->pipeline, pointers, count);
    return rlf_pipeline_redraw(page->pipeline, &page->frame);
}

static void choose(start_page *page, int32_t index)
{
    if (index >= 0 && index < page->count) {
        page->selected = index;
        page->chosen = index;
    }
}

static void present(start_page *page)
{
    int32_t width;
    int32_t height;
    viewer_window_get_framebuffer_size(&page->window, &width, &height);
    if (width > 0 && height > 0) {
        rlf_gl_presenter_draw(page->presenter, &page->frame.render.image, width, height);
        if (page->menu != NULL) {
            const int32_t clicked =
                viewer_menu_draw(page->menu, page->choices, page->count, page->selected);
            page->count += clicked == page->count ? 1 : 0;
            choose(page, clicked);
        }
        viewer_window_swap(&page->window);
    }
}

static void click(start_page *page, double x, double y)
{
    int32_t width;
    int32_t height;
    double u, v;
    viewer_window_get_size(&page->window, &width, &height);
    const viewer_fit fit = {width, height, WIDTH, HEIGHT, false, NULL};
    if (width > 0 && height > 0 && viewer_fit_pick(&fit, x, y, &u, &v) && v >= LINE_START) {
        const int32_t row = (int32_t)((v - LINE_START) / LINE_PITCH) - HEAD;
        choose(page, row >= 0 && row < ROWS ? page->first + row : -1);
    }
}

/* True when the page looks otherwise now. */
static bool run_commands(start_page *page)
{
    const viewer_commands commands = page->window.commands;
    page->window.commands = (viewer_commands){.view = -1};
    if (commands.restart) {
        look_again(page);
    }
    if (page->menu != NULL && (commands.open_files || commands.view == KEY_O)) {
        viewer_menu_open_files(page->menu);
    } else {
        choose(page, commands.view);
    }
    if (commands.leave) {
        viewer_window_leave(&page->window);
    }
    const int32_t turned = page->menu == NULL ? (int32_t)commands.zoom : 0;
    const int32_t step = commands.nudge_y - turned;
    const int32_t selected = page->selected + step;
    page->selected = (int32_t)rlf_clamp(selected, 0, page->count - 1);
    if (commands.solve_points) {
        choose(page, page->selected);
    }
    if (commands.throw_body && page->menu == NULL) {
        click(page, commands.throw_x, commands.throw_y);
    }
    return commands.restart || commands.refresh || step != 0;
}

static rlf_result run(start_page *page, const volatile sig_atomic_t *interrupted)
{
    rlf_result result = draw(page);
    int32_t presents = 2; /* the list shows what it was told one picture later */
    while (result == RLF_OK && page->chosen < 0) {
        if (viewer_window_should_close(&page->window) ||
            (interrupted != NULL && *interrupted != 0)) {
            return RLF_END;
        }
        if (presents > 0) {
            present(page);
            presents--;
        }
        viewer_window_poll(&page->window, presents > 0 ? 0.0 : WAIT_S);
        if (run_commands(page)) {
            presents = 2;
            result = draw(page);
        }
    }
    return result;
}

rlf_result rlf_window_choose(rlf_window_list_fn list, void *context,
                             const volatile sig_atomic_t *interrupted, rlf_window_choice *out)
{
    static start_page page; /* large: the window's callbacks and all lines */
    if (!RLF_ASSERT(list != NULL && out != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_window_choose: NULL");
    }
    memset(&page, 0, sizeof(page));
    page.list = list;
    page.context = context;
    page.chosen = -1;
    const viewer_window_size size = {.width = 2 * WIDTH, .height = 2 * HEIGHT};
    rlf_result result = viewer_window_open("Relief", &size, &page.window);
    if (result != RLF_OK) {
        return result;
    }
    result = rlf_gl_presenter_create(&page.presenter);
    result = result == RLF_OK ? open_room(&page) : result;
    if (result == RLF_OK) {
        page.menu = viewer_menu_create(&page.window);
        look_again(&page);
        result = run(&page, interrupted);
        viewer_menu_destroy(&page.menu);
    }
    if (result == RLF_OK) {
        *out = page.choices[page.chosen];
    }
    rlf_pipeline_destroy(&page.pipeline);
    rlf_source_destroy(&page.source);
    rlf_gl_presenter_destroy(&page.presenter);
    viewer_window_close(&page.window);
    return result;
}
