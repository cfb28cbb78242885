/* EGL contexts without a display, and adoption of a window's context. */
#include "render/gl/gl_context.h"

#include <stdio.h>
#include <string.h>

enum { DEVICE_MAX = 16 };

static bool has_client_extension(const char *name)
{
    const char *list = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    return list != NULL && epoxy_extension_in_string(list, name);
}

/* Displays worth trying, in order. Returns their number. */
static int32_t find_displays(EGLDisplay out[DEVICE_MAX + 1])
{
    int32_t count = 0;
    if (!has_client_extension("EGL_EXT_platform_base")) {
        return 0;
    }
    if (has_client_extension("EGL_MESA_platform_surfaceless")) {
        out[count++] =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    }
    if (has_client_extension("EGL_EXT_platform_device") &&
        has_client_extension("EGL_EXT_device_enumeration")) {
        EGLDeviceEXT devices[DEVICE_MAX];
        EGLint device_count = 0;
        if (!eglQueryDevicesEXT(DEVICE_MAX, devices, &device_count)) {
            device_count = 0;
        }
        for (EGLint i = 0; i < device_count; i++) {
            out[count++] = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
        }
    }
    return count;
}

/* One that tells when the driver resets it, where that is to be had. */
static EGLContext create_context(EGLDisplay display, EGLConfig config, bool is_es)
{
    const EGLint told[] = {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                           EGL_LOSE_CONTEXT_ON_RESET};
    const EGLint core[] = {
        EGL_CONTEXT_MAJOR_VERSION_KHR,       3,
        EGL_CONTEXT_MINOR_VERSION_KHR,       3,
        EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR};
    const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_CONTEXT_MINOR_VERSION_KHR, 0};
    EGLint attributes[9];
    const size_t count = is_es ? 4 : 6;
    memcpy(attributes, is_es ? es : core, count * sizeof(EGLint));
    memcpy(attributes + count, told, sizeof(told));
    attributes[count + 2] = EGL_NONE;
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) {
        attributes[count] = EGL_NONE;
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    }
    return context;
}

static bool check_version(bool is_es)
{
    return epoxy_gl_version() >= (is_es ? 30 : 33);
}

static void read_facts(gl_context *context)
{
    context->tells_reset = epoxy_has_gl_extension("GL_KHR_robustness") ||
                           epoxy_gl_version() >= (context->is_es ? 32 : 45);
    const char *name = (const char *)glGetString(GL_RENDERER);
    (void)snprintf(context->renderer, sizeof context->renderer, "%s", name != NULL ? name : "?");
}

/* One API on one initialised display; leaves nothing current. */
static bool open_on_display(EGLDisplay display, bool is_es, gl_context *out)
{
    const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                 is_es ? EGL_OPENGL_ES3_BIT_KHR : EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config;
    EGLint config_count = 0;
    if (!eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) ||
        !eglChooseConfig(display, attributes, &config, 1, &config_count) || config_count < 1) {
        return false;
    }
    gl_context made = {.display = display, .is_own = true, .is_es = is_es};
    made.context = create_context(display, config, is_es);
    if (made.context == EGL_NO_CONTEXT) {
        return false;
    }
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
        const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        made.surface = eglCreatePbufferSurface(display, config, size);
    }
    gl_context_saved saved;
    bool is_good = gl_context_enter(&made, &saved);
    if (is_good) {
        is_good = check_version(is_es);
        read_facts(&made);
        gl_context_leave(&made, &saved);
    }
    if (!is_good) {
        gl_context_close(&made);
        return false;
    }
    *out = made;
    return true;
}

static bool is_software(const gl_context *context)
{
    return strstr(context->renderer, "llvmpipe") != NULL ||
           strstr(context->renderer, "softpipe") != NULL ||
           strstr(context->renderer, "SWR") != NULL;
}

/* The best context of one API. */
static bool open_api(const EGLDisplay *displays, int32_t display_count, bool is_es, gl_context *out)
{
    bool found = false;
    for (int32_t i = 0; i < display_count; i++) {
        gl_context candidate;
        EGLint major;
        EGLint minor;
        /* Displays are never terminated: EGL shares one per device within a process, and ending
         * it would take the contexts of everyone else's compositors with it. */
        if (displays[i] == EGL_NO_DISPLAY || !eglInitialize(displays[i], &major, &minor) ||
            !open_on_display(displays[i], is_es, &candidate)) {
            continue;
        }
        if (found && is_software(&candidate)) {
            gl_context_close(&candidate);
            continue;
        }
        if (found) {
            gl_context_close(out);
        }
        *out = candidate;
        found = true;
        if (!is_software(out)) {
            break;
        }
    }
    return found;
}

rlf_result gl_context_open(gl_api api, gl_context *out)
{
    if (!epoxy_has_egl()) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: no EGL library on this machine: install libegl1 and a driver "
                        "(libegl-mesa0, libgl1-mesa-dri), or use --renderer soft");
    }
    EGLDisplay displays[DEVICE_MAX + 1];
    int32_t count = find_displays(displays);
    EGLenum api_before = eglQueryAPI();
    bool is_open = (api != CONTEXT_API_ES_30 && open_api(displays, count, false, out)) ||
                   (api != CONTEXT_API_CORE_33 && open_api(displays, count, true, out));
    (void)eglBindAPI(api_before);
    if (!is_open) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: EGL offers no %s without a display (%d displays tried): install "
                        "a driver (libegl-mesa0, libgl1-mesa-dri), or use --renderer soft",
                        api == CONTEXT_API_ES_30     ? "ES 3.0"
                        : api == CONTEXT_API_CORE_33 ? "OpenGL 3.3"
                                                     : "OpenGL 3.3 or ES 3.0",
                        (int)count);
    }
    return RLF_OK;
}

rlf_result gl_context_adopt(gl_context *out)
{
    gl_context adopted = {.display = EGL_NO_DISPLAY};
    const char *version = (const char *)glGetString(GL_VERSION);
    if (version == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE, "OpenGL: the calling thread has no current context: make "
                                          "the window's context current first");
    }
    adopted.is_es = !epoxy_is_desktop_gl();
    if (!check_version(adopted.is_es)) {
        return rlf_fail(RLF_ERROR_DEVICE,
                        "OpenGL: the window's context is %s: 3.3 or ES 3.0 is needed, use "
                        "--renderer soft",
                        version);
    }
    read_facts(&adopted);
    *out = adopted;
    return RLF_OK;
}

void gl_context_close(gl_context *context)
{
    if (!context->is_own) {
        return;
    }
    if (eglGetCurrentContext() == context->context) {
        (void)eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (context->surface != EGL_NO_SURFACE) {
        (void)eglDestroySurface(context->display, context->surface);
    }
    (void)eglDestroyContext(context->display, context->context);
    context->is_own = false;
}

bool gl_context_enter(const gl_context *context, gl_context_saved *out_saved)
{
    if (!context->is_own) {
        return true;
    }
    out_saved->api = eglQueryAPI();
    (void)eglBindAPI(context->is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    out_saved->display = eglGetCurrentDisplay();
    out_saved->context = eglGetCurrentContext();
    out_saved->draw = eglGetCurrentSurface(EGL_DRAW);
    out_saved->read = eglGetCurrentSurface(EGL_READ);
    return eglMakeCurrent(context->display, context->surface, context->surface, context->context);
}

void gl_context_leave(const gl_context *context, const gl_context_saved *saved)
{
    if (!context->is_own) {
        return;
    }
    if (saved->context != EGL_NO_CONTEXT) {
        (void)eglMakeCurrent(saved->display, saved->draw, saved->read, saved->context);
    } else {
        (void)eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    (void)eglBindAPI(saved->api);
}

bool gl_context_is_lost(const gl_context *context)
{
    return context->tells_reset && glGetGraphicsResetStatus() != GL_NO_ERROR;
}
