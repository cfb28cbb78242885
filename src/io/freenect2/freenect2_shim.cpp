// libfreenect2 as C functions. The only C++ of Relief; built where libfreenect2 is found.
#include "io/freenect2/freenect2_shim.h"

#include <libfreenect2/libfreenect2.hpp>
#include <libfreenect2/logger.h>
#include <libfreenect2/registration.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

using libfreenect2::Frame;
using libfreenect2::Freenect2;
using libfreenect2::Freenect2Device;
using clock_type = std::chrono::steady_clock;

namespace
{

// Colour this much older than depth, in units of 0.125 ms, is one picture behind: half a period.
constexpr int32_t behind_max = 133;
// How long depth waits for its colour, whose JPEG is decoded at the same time.
constexpr std::chrono::milliseconds color_wait(25);

// Keeps the newest picture of each kind. libfreenect2's own listener waits for one of each, which
// loses every other depth picture when the colour camera slows down in the dark.
class Newest : public libfreenect2::FrameListener
{
  public:
    bool onNewFrame(Frame::Type type, Frame *frame) override
    {
        if (frame->status != 0 || frame->format == Frame::Raw) {
            return false;
        }
        std::lock_guard<std::mutex> lock(mutex);
        if (type == Frame::Depth) {
            depth.reset(frame);
            depth_arrival = clock_type::now();
        } else if (type == Frame::Color) {
            color.reset(frame);
        } else {
            return false;
        }
        changed.notify_one();
        return true;
    }

    // Takes a depth picture, and a colour picture that has not been taken before, if there is one.
    bool take(int timeout_ms, std::unique_ptr<Frame> &out_depth, std::unique_ptr<Frame> &out_color)
    {
        std::unique_lock<std::mutex> lock(mutex);
        const auto end = clock_type::now() + std::chrono::milliseconds(timeout_ms);
        if (!changed.wait_until(lock, end, [this] { return depth != nullptr; })) {
            return false;
        }
        changed.wait_until(lock, depth_arrival + color_wait, [this] { return color_fits(); });
        out_depth = std::move(depth);
        if (color != nullptr) {
            out_color = std::move(color);
        }
        return true;
    }

  private:
    bool color_fits() const
    {
        return color != nullptr &&
               static_cast<int32_t>(depth->timestamp - color->timestamp) < behind_max;
    }

    std::mutex mutex;
    std::condition_variable changed;
    std::unique_ptr<Frame> depth, color;
    clock_type::time_point depth_arrival;
};

// libfreenect2 tells much on the standard output, which belongs to the program.
void be_quiet()
{
    static std::once_flag once;
    std::call_once(once, [] {
        libfreenect2::setGlobalLogger(
            libfreenect2::createConsoleLogger(libfreenect2::Logger::Warning));
    });
}

} // namespace

struct relief_freenect2 {
    Freenect2 library;
    Newest newest;
    std::unique_ptr<Freenect2Device> device;
    std::unique_ptr<libfreenect2::Registration> registration;
    std::unique_ptr<Frame> depth, color; // given last
};

extern "C" {

int relief_freenect2_version(void)
{
    return RELIEF_FREENECT2_VERSION;
}

int relief_freenect2_count(void)
{
    be_quiet();
    Freenect2 library;
    return library.enumerateDevices();
}

int relief_freenect2_serial(int index, char *out, size_t size)
{
    be_quiet();
    Freenect2 library;
    if (index < 0 || index >= library.enumerateDevices()) {
        return 0;
    }
    snprintf(out, size, "%s", library.getDeviceSerialNumber(index).c_str());
    return 1;
}

relief_freenect2 *relief_freenect2_open(const char *serial, char *out_cause, size_t size)
try {
    be_quiet();
    std::unique_ptr<relief_freenect2> self(new relief_freenect2);
    if (self->library.enumerateDevices() < 1) {
        snprintf(out_cause, size, "no Kinect v2 is plugged in");
        return nullptr;
    }
    const std::string wanted =
        serial[0] != '\0' ? serial : self->library.getDefaultDeviceSerialNumber();
    self->device.reset(self->library.openDevice(wanted));
    if (self->device == nullptr) {
        snprintf(out_cause, size, "the Kinect v2 %s cannot be opened", wanted.c_str());
        return nullptr;
    }
    self->device->setColorFrameListener(&self->newest);
    self->device->setIrAndDepthFrameListener(&self->newest);
    if (!self->device->start()) {
        self->device->close();
        snprintf(out_cause, size, "the Kinect v2 %s does not start", wanted.c_str());
        return nullptr;
    }
    self->registration.reset(new libfreenect2::Registration(self->device->getIrCameraParams(),
                                                            self->device->getColorCameraParams()));
    return self.release();
} catch (const std::exception &error) {
    snprintf(out_cause, size, "%s", error.what());
    return nullptr;
}

void relief_freenect2_get_calibration(relief_freenect2 *self, relief_freenect2_calibration *out)
{
    const Freenect2Device::IrCameraParams ir = self->device->getIrCameraParams();
    const Freenect2Device::ColorCameraParams color = self->device->getColorCameraParams();
    static_assert(sizeof(ir) == sizeof(out->ir) && sizeof(color) == sizeof(out->color),
                  "libfreenect2 has other calibration numbers");
    memcpy(out->ir, &ir, sizeof(ir));
    memcpy(out->color, &color, sizeof(color));
}

int relief_freenect2_wait(relief_freenect2 *self, int timeout_ms, relief_freenect2_frame *out)
{
    std::unique_ptr<Frame> depth;
    if (!self->newest.take(timeout_ms, depth, self->color)) {
        return 0;
    }
    self->depth = std::move(depth);
    *out = relief_freenect2_frame();
    out->depth = reinterpret_cast<const float *>(self->depth->data);
    out->depth_sequence = self->depth->sequence;
    out->depth_time = self->depth->timestamp;
    if (self->color != nullptr) {
        out->color = self->color->data;
        out->color_time = self->color->timestamp;
        out->color_is_rgbx = self->color->format == Frame::RGBX ? 1 : 0;
    }
    return 1;
}

void relief_freenect2_registration(relief_freenect2 *self, float *out_depth, uint32_t *out_color)
{
    Frame depth(512, 424, 4, reinterpret_cast<unsigned char *>(out_depth));
    Frame color(512, 424, 4, reinterpret_cast<unsigned char *>(out_color));
    self->registration->apply(self->color.get(), self->depth.get(), &depth, &color);
}

void relief_freenect2_close(relief_freenect2 *self)
{
    self->device->stop();
    self->device->close();
    delete self;
}

} // extern "C"
