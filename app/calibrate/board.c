/* Vector squares, so that a printer draws their edges as sharp as it can. The page is made once as
 * a list of drawing commands in millimetres from the top left, and written in either format. */
#include "calibrate/calibrate.h"

#include "relief/io.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define POINTS_A_MM (72.0 / 25.4)
#define MARGIN_MM 8.0       /* what most printers leave white */
#define FOOT_MM 16.0        /* for the line and the ruler below the board */
#define RULER_MM 100.0      /* whatever is read off it tells the printer's scale */
#define MARK "relief-board" /* before COLUMNSxROWS SQUAREmm in the file */
#define TEXT_MAX (256 * 1024)

typedef struct page {
    char *text;
    size_t length;
    bool is_svg, is_full;
    double width, height; /* mm */
} page;

RLF_PRINTF(2, 3) static void add(page *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int count = vsnprintf(p->text + p->length, TEXT_MAX - p->length, format, arguments);
    va_end(arguments);
    p->is_full = p->is_full || count < 0 || (size_t)count >= TEXT_MAX - p->length;
    p->length += p->is_full ? 0 : (size_t)count;
}

/* Numbers of thousandths, written without the locale's decimal point. */
static void add_number(page *p, double value, const char *end)
{
    const long long n = llround(value * 1000.0);
    const long long size = n < 0 ? -n : n;
    add(p, "%s%lld.%03lld%s", n < 0 ? "-" : "", size / 1000, size % 1000, end);
}

static void add_rectangle(page *p, double x, double y, double width, double height)
{
    if (p->is_svg) {
        add(p, "<rect x=\"");
        add_number(p, x, "\" y=\"");
        add_number(p, y, "\" width=\"");
        add_number(p, width, "\" height=\"");
        add_number(p, height, "\"/>\n");
        return;
    }
    add_number(p, x * POINTS_A_MM, " ");
    add_number(p, (p->height - y - height) * POINTS_A_MM, " ");
    add_number(p, width * POINTS_A_MM, " ");
    add_number(p, height * POINTS_A_MM, " re f\n");
}

/* ASCII without brackets, quotes or backslashes; 3 mm high. */
static void add_text(page *p, double x, double y, const char *text)
{
    if (p->is_svg) {
        add(p, "<text font-family=\"sans-serif\" font-size=\"3\" x=\"");
        add_number(p, x, "\" y=\"");
        add_number(p, y, "\">");
        add(p, "%s</text>\n", text);
        return;
    }
    add(p, "BT /F1 8.5 Tf ");
    add_number(p, x * POINTS_A_MM, " ");
    add_number(p, (p->height - y) * POINTS_A_MM, " Td ");
    add(p, "(%s) Tj ET\n", text);
}

static void draw(page *p, const board_size *b, const char *about)
{
    const double square = 1e3 * b->square_m;
    const double left = 0.5 * (p->width - (b->columns + 1) * square);
    const double top = 0.5 * (p->height - FOOT_MM - (b->rows + 1) * square);
    for (int32_t i = 0; i < (b->columns + 1) * (b->rows + 1); i++) {
        const int32_t x = i % (b->columns + 1), y = i / (b->columns + 1);
        if ((x + y) % 2 == 0) {
            add_rectangle(p, left + x * square, top + y * square, square, square);
        }
    }
    const double foot = p->height - FOOT_MM + 4.0;
    add_rectangle(p, MARGIN_MM, foot, RULER_MM, 0.2);
    for (int mm = 0; mm <= 100; mm += 10) {
        const double high = mm % 50 == 0 ? 3.0 : 2.0;
        add_rectangle(p, MARGIN_MM + mm - 0.1, foot - high, 0.2, high);
    }
    add_text(p, MARGIN_MM + RULER_MM + 3.0, foot, "100 mm: measure it");
    add_text(p, MARGIN_MM, foot + 5.0, about);
}

/* ---- formats -------------------------------------------------------------------------------- */

static void add_svg(page *p, const board_size *b, const char *mark, const char *about)
{
    add(p, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"");
    add_number(p, p->width, "mm\" height=\"");
    add_number(p, p->height, "mm\" viewBox=\"0 0 ");
    add_number(p, p->width, " ");
    add_number(p, p->height, "\">\n");
    add(p, "<metadata>%s</metadata>\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
        mark);
    draw(p, b, about);
    add(p, "</svg>\n");
}

/* PDF 1.4 with one page, Helvetica (which every reader has), and the mark as its subject. */
static void add_pdf(page *p, const board_size *b, const char *mark, const char *about)
{
    size_t at[6];
    add(p, "%%PDF-1.4\n");
    at[1] = p->length;
    add(p, "1 0 obj\n<< /Type /Catalog /Pages 2 0 R\n/ViewerPreferences << /PrintScaling /None >> "
           ">>\nendobj\n");
    at[2] = p->length;
    add(p, "2 0 obj\n<< /Type /Pages /Kids [3 0 R] /Count 1 >>\nendobj\n");
    at[3] = p->length;
    add(p, "3 0 obj\n<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ");
    add_number(p, p->width * POINTS_A_MM, " ");
    add_number(p, p->height * POINTS_A_MM, "]\n");
    add(p, "/Resources << /Font << /F1 << /Type /Font /Subtype /Type1 /BaseFont /Helvetica >> >> "
           ">>\n/Contents 4 0 R >>\nendobj\n");
    at[4] = p->length;
    add(p, "4 0 obj\n<< /Length ");
    const size_t length_at = p->length;
    add(p, "          >>\nstream\n");
    const size_t begin = p->length;
    draw(p, b, about);
    char length[11];
    snprintf(length, sizeof(length), "%-9zu ", p->length - begin);
    if (!p->is_full) {
        memcpy(p->text + length_at, length, 10);
    }
    add(p, "endstream\nendobj\n");
    at[5] = p->length;
    add(p, "5 0 obj\n<< /Title (Chessboard) /Subject (%s) >>\nendobj\n", mark);
    const size_t table = p->length;
    add(p, "xref\n0 6\n0000000000 65535 f \n");
    for (int i = 1; i < 6; i++) {
        add(p, "%010zu 00000 n \n", at[i]);
    }
    add(p, "trailer\n<< /Size 6 /Root 1 0 R /Info 5 0 R >>\nstartxref\n%zu\n%%%%EOF\n", table);
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* Turns the page if the board only fits across; false = in neither way. */
static bool fit(page *p, const board_size *b, bool is_letter)
{
    const double width = 1e3 * b->square_m * (b->columns + 1);
    const double height = 1e3 * b->square_m * (b->rows + 1);
    const double small = is_letter ? 215.9 : 210.0, large = is_letter ? 279.4 : 297.0;
    for (int turn = 0; turn < 2; turn++) {
        p->width = turn == 0 ? small : large;
        p->height = turn == 0 ? large : small;
        if (width <= p->width - 2 * MARGIN_MM && height <= p->height - FOOT_MM - 2 * MARGIN_MM) {
            return true;
        }
    }
    return false;
}

rlf_result board_print(const char *path, const board_size *b, bool is_letter)
{
    page p = {.is_svg = ends_with(path, ".svg")};
    if (!fit(&p, b, is_letter)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "a board of %d x %d squares of %g mm does not fit on %s: use smaller "
                        "squares or fewer",
                        (int)b->columns + 1, (int)b->rows + 1, 1e3 * b->square_m,
                        is_letter ? "Letter" : "A4");
    }
    p.text = rlf_alloc(TEXT_MAX);
    if (p.text == NULL) {
        return RLF_ERROR_MEMORY;
    }
    char mark[80], about[160];
    const long long um = llround(1e6 * b->square_m);
    snprintf(mark, sizeof(mark), MARK " %dx%d %lldum", (int)b->columns, (int)b->rows, um);
    snprintf(about, sizeof(about),
             "Print at 100 %%. Chessboard %dx%d inner corners, squares %lld.%03lld mm.",
             (int)b->columns, (int)b->rows, um / 1000, um % 1000);
    (p.is_svg ? add_svg : add_pdf)(&p, b, mark, about);
    rlf_result result = p.is_full ? rlf_fail(RLF_ERROR_INVALID, "%s: too many squares", path)
                                  : rlf_file_write(path, p.text, p.length);
    rlf_free(p.text);
    return result;
}

/* ---- back ----------------------------------------------------------------------------------- */

static bool find_mark(const char *text, size_t length, board_size *out)
{
    const size_t mark = sizeof(MARK) - 1;
    for (size_t i = 0; i + mark < length; i++) {
        int columns, rows;
        long long um;
        if (memcmp(text + i, MARK, mark) == 0 &&
            sscanf(text + i + mark, " %5dx%5d %9lldum", &columns, &rows, &um) == 3 && um > 0) {
            *out = (board_size){columns, rows, 1e-6 * (double)um};
            return true;
        }
    }
    return false;
}

rlf_result board_read(const char *path, board_size *out)
{
    FILE *file = fopen(path, "rb");
    char *text = rlf_alloc(TEXT_MAX + 1);
    size_t length = 0;
    if (file != NULL && text != NULL) {
        length = fread(text, 1, TEXT_MAX, file);
        text[length] = '\0';
    }
    const bool is_found = length > 0 && find_mark(text, length, out);
    rlf_result result = RLF_OK;
    if (file == NULL) {
        result = rlf_fail(RLF_ERROR_IO,
                          "%s: cannot be opened: give the file that --print-board "
                          "wrote, or COLUMNSxROWS",
                          path);
    } else if (!is_found) {
        result = rlf_fail(RLF_ERROR_FORMAT,
                          "%s: says nothing about a board: give the file that --print-board wrote, "
                          "or COLUMNSxROWS",
                          path);
    }
    if (file != NULL) {
        fclose(file);
    }
    rlf_free(text);
    return result;
}
