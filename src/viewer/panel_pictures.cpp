/* Small pictures of what can be chosen. They lie in the texture of the letters, so that no call of OpenGL is needed
 * here. */
#include "viewer/panel_parts.h"

#include <stdio.h>
#include <string.h>

#define WIDTH 128 /* at most, of a picture as it is kept */
#define HEIGHT 72

/* By whole pixels, the nearest: files are about as small already. */
static void shrink(rlf_image_rgba8 *image)
{
    const int by_width = (image->width + WIDTH - 1) / WIDTH, by_height = (image->height + HEIGHT - 1) / HEIGHT;
    const int factor = by_width > by_height ? by_width : by_height;
    const int width = image->width / factor, height = image->height / factor;
    for (int y = 0; factor > 1 && y < height; y++) {
        for (int x = 0; x < width; x++) {
            memcpy(image->data + 4 * (y * width + x), rlf_rgba8_row(image, y * factor) + 4 * x * factor, 4);
        }
    }
    if (factor > 1) {
        *image = {image->data, width, height, 4 * (ptrdiff_t)width};
    }
}

void panel_pictures_free(panel_pictures *p)
{
    for (int i = 0; i < p->count; i++) {
        rlf_free(p->items[i].image.data);
    }
    *p = {};
}

void panel_pictures_load(panel_pictures *p, const rlf_window_choice *choices, int count)
{
    panel_pictures_free(p);
    p->count = count;
    for (int i = 0; i < count; i++) {
        panel_picture *item = &p->items[i];
        const bool is_there = choices[i].picture[0] != '\0' && rlf_picture_read(choices[i].picture, &item->image) == RLF_OK;
        if (!is_there) {
            item->image = {};
        } else {
            shrink(&item->image);
        }
    }
}

void panel_pictures_add(panel_pictures *p)
{
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    unsigned char *pixels;
    int width, height;
    for (int i = 0; i < p->count; i++) {
        const rlf_image_rgba8 *image = &p->items[i].image;
        p->items[i].rect = image->data != nullptr ? atlas->AddCustomRectRegular(image->width, image->height) : -1;
    }
    atlas->GetTexDataAsRGBA32(&pixels, &width, &height);
    for (int i = 0; i < p->count; i++) {
        const rlf_image_rgba8 *image = &p->items[i].image;
        const ImFontAtlasCustomRect *rect = image->data != nullptr ? atlas->GetCustomRectByIndex(p->items[i].rect) : nullptr;
        for (int y = 0; rect != nullptr && rect->IsPacked() && y < image->height; y++) {
            memcpy(pixels + 4 * ((ptrdiff_t)(rect->Y + y) * width + rect->X), rlf_rgba8_row(image, y), 4 * (size_t)image->width);
        }
    }
}

bool panel_pictures_draw(const panel_pictures *p, int index, float height)
{
    const ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    const rlf_image_rgba8 *image = &p->items[index].image;
    ImVec2 from, to;
    if (index >= p->count || image->data == nullptr || p->items[index].rect < 0) {
        return false;
    }
    const ImFontAtlasCustomRect *rect = const_cast<ImFontAtlas *>(atlas)->GetCustomRectByIndex(p->items[index].rect);
    if (!rect->IsPacked()) {
        return false;
    }
    atlas->CalcCustomRectUV(rect, &from, &to);
    ImGui::Image(atlas->TexID, ImVec2(height * WIDTH / HEIGHT, height), from, to);
    return true;
}
