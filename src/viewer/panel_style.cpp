/* Dear ImGui in a window, and its looks: its typeface, its colours, and how large they are on this monitor. */
#include "viewer/panel_parts.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <math.h>
#include <stdio.h>

#define LETTER_PX 15.0f /* at 100 % scale: what desktops give to text of 11 points */
#define WINDOW_ROWS 1000 /* a window this high has text at 100 % */
#define SCALE_STEP 0.25f /* a font is made anew at each */

/* Sans-serif faces as systems install them, the first that is there: Debian, Fedora, Arch, Windows. */
static const char *const typefaces[] = {
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
    "/usr/share/fonts/google-noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "C:\\Windows\\Fonts\\segoeui.ttf"};

static bool is_readable(const char *path)
{
    FILE *file = fopen(path, "rb");
    return file != nullptr && fclose(file) == 0;
}

/* The built-in face has one size; a scale of the context enlarges it. */
static void load_typeface(float scale)
{
    ImGuiIO &io = ImGui::GetIO();
    io.Fonts->Clear();
    io.FontGlobalScale = 1.0f;
    for (const char *path : typefaces) {
        const float px = floorf(LETTER_PX * scale + 0.5f);
        if (is_readable(path) && io.Fonts->AddFontFromFileTTF(path, px) != nullptr) {
            return;
        }
    }
    io.Fonts->AddFontDefault();
    io.FontGlobalScale = scale;
}

static void set_colours(bool is_light)
{
    const struct {
        ImVec4 window, frame, text, quiet, header;
    } dark = {{0.09f, 0.09f, 0.10f, 1}, {0.18f, 0.18f, 0.20f, 1}, {0.92f, 0.92f, 0.90f, 1},
              {0.60f, 0.60f, 0.60f, 1}, {0.14f, 0.14f, 0.16f, 1}},
      light = {{0.96f, 0.96f, 0.95f, 1}, {0.86f, 0.86f, 0.85f, 1}, {0.10f, 0.10f, 0.10f, 1},
               {0.38f, 0.38f, 0.38f, 1}, {0.90f, 0.90f, 0.89f, 1}},
      &now = is_light ? light : dark;
    const ImVec4 accent = is_light ? ImVec4(0.72f, 0.44f, 0.02f, 1) : ImVec4(0.98f, 0.74f, 0.27f, 1);
    const auto faded = [&accent](float share) {
        return ImVec4(accent.x, accent.y, accent.z, share);
    };
    is_light ? ImGui::StyleColorsLight() : ImGui::StyleColorsDark();
    ImVec4 *colours = ImGui::GetStyle().Colors;
    colours[ImGuiCol_WindowBg] = colours[ImGuiCol_PopupBg] = now.window;
    colours[ImGuiCol_FrameBg] = colours[ImGuiCol_Button] = now.frame;
    colours[ImGuiCol_FrameBgHovered] = colours[ImGuiCol_ButtonHovered] = faded(0.30f);
    colours[ImGuiCol_FrameBgActive] = colours[ImGuiCol_ButtonActive] = faded(0.45f);
    colours[ImGuiCol_Text] = now.text;
    colours[ImGuiCol_TextDisabled] = now.quiet;
    colours[ImGuiCol_Header] = now.header;
    colours[ImGuiCol_HeaderHovered] = faded(0.30f);
    colours[ImGuiCol_HeaderActive] = faded(0.45f);
    colours[ImGuiCol_CheckMark] = colours[ImGuiCol_SliderGrab] = accent;
    colours[ImGuiCol_SliderGrabActive] = colours[ImGuiCol_PlotLines] = accent;
    colours[ImGuiCol_NavHighlight] = accent;
}

static void set_measures(float scale)
{
    ImGuiStyle &style = ImGui::GetStyle();
    style = ImGuiStyle();
    style.WindowPadding = ImVec2(12, 10);
    style.FramePadding = ImVec2(8, 3);
    style.ItemSpacing = ImVec2(8, 5);
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
    style.WindowRounding = style.WindowBorderSize = 0;
    style.ScrollbarSize = 10;
    style.ScaleAllSizes(scale);
}

/* That of the desktop, or more where the window is so high that its user sits far from it. */
static float wanted_scale(GLFWwindow *window)
{
    float desktop = 1.0f, desktop_y = 1.0f;
    int width = 0, height = 0;
    glfwGetWindowContentScale(window, &desktop, &desktop_y);
    glfwGetWindowSize(window, &width, &height);
    const float high = SCALE_STEP * floorf((float)height / (WINDOW_ROWS * SCALE_STEP));
    return rlf_clamp(desktop > high ? desktop : high, 1.0, 4.0);
}

bool panel_context_open(GLFWwindow *window)
{
    if (glfwGetWindowAttrib(window, GLFW_CLIENT_API) != GLFW_OPENGL_API) {
        return false; /* imgui's loader knows desktop OpenGL alone */
    }
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; /* nothing is written where the user works */
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange; /* screen.c hides it */
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    if (!ImGui_ImplOpenGL3_Init("#version 330")) {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
        return false;
    }
    return true;
}

void panel_context_close(void)
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void panel_set_style(panel_style *style, GLFWwindow *window, bool is_light, panel_pictures *pictures)
{
    const float scale = wanted_scale(window);
    if (scale == style->scale && style->is_light == is_light) {
        return;
    }
    if (scale != style->scale) {
        load_typeface(scale);
        if (pictures != nullptr) {
            panel_pictures_add(pictures);
        }
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    set_measures(scale);
    set_colours(is_light);
    *style = {scale, is_light};
}

void panel_label(const char *name, const char *tip)
{
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    panel_tip(tip);
    ImGui::SameLine(0.36f * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1.0f);
}

void panel_tip(const char *text)
{
    if (text == nullptr || !ImGui::IsItemHovered()) {
        return;
    }
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}
