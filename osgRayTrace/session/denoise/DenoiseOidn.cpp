// DenoiseOidn.cpp - Open Image Denoise in place of the filter: the one file that includes it.
// Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseOidn.h"

#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/base/Parallel.h"

#include <OpenImageDenoise/oidn.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

namespace osgRayTrace::engine
{

namespace
{

/// Pixels of less alpha are almost empty and have no light of their own.
constexpr float kLeastAlpha = 1e-3f;
constexpr float kLargestLight = 1e20f;

struct Release
{
    void operator()(OIDNDevice device) const { oidnReleaseDevice(device); }
    void operator()(OIDNFilter filter) const { oidnReleaseFilter(filter); }
};
using Device = std::unique_ptr<std::remove_pointer_t<OIDNDevice>, Release>;
using Filter = std::unique_ptr<std::remove_pointer_t<OIDNFilter>, Release>;

// Version 2 of the library has other names for these functions.
#if OIDN_VERSION_MAJOR >= 2
void set(OIDNDevice device, const char* name, int value)
{
    oidnSetDeviceInt(device, name, value);
}
void set(OIDNDevice device, const char* name, bool value)
{
    oidnSetDeviceBool(device, name, value);
}
void set(OIDNFilter filter, const char* name, bool value)
{
    oidnSetFilterBool(filter, name, value);
}
#else
void set(OIDNDevice device, const char* name, int value)
{
    oidnSetDevice1i(device, name, value);
}
void set(OIDNDevice device, const char* name, bool value)
{
    oidnSetDevice1b(device, name, value);
}
void set(OIDNFilter filter, const char* name, bool value)
{
    oidnSetFilter1b(filter, name, value);
}
#endif

/// Returns the message of a failure on this thread since the last call; empty: nothing failed. A
/// null device stands for the making of a device.
std::string errorOf(OIDNDevice device)
{
    const char* message = nullptr;
    if (oidnGetDeviceError(device, &message) == OIDN_ERROR_NONE) return {};
    return message && *message ? message : "an error that it does not name";
}

/// Returns false for NaN as well.
bool isLight(const float* rgba)
{
    const float sum = std::fabs(rgba[0]) + std::fabs(rgba[1]) + std::fabs(rgba[2]);
    return sum < kLargestLight && rgba[3] > kLeastAlpha && rgba[3] < 2.0f;
}

float limitedAlbedo(float value)
{
    return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

float limitedNormal(float value)
{
    return value >= -1.0f && value <= 1.0f ? value : 0.0f;
}

void putGuides(const SurfaceSample& surface, float* albedo, float* normal)
{
    const bool hit = surface.object != 0;
    const bool scatters = surface.kind == SurfaceKind::Scattering;
    for (int c = 0; c < 3; ++c)
    {
        albedo[c] = !hit ? 0.0f : scatters ? limitedAlbedo(surface.albedo[c]) : 1.0f;
        normal[c] = hit ? limitedNormal(surface.normal[c]) : 0.0f;
    }
}

} // namespace

struct DenoiseOidn::Implementation
{
    void allocate(int newWidth, int newHeight);
    std::string prepare(int wantedThreads);
    std::string makeFilter();
    std::string run(ResolvedImage& image, const Workers& workers);

    /// Calls body(first, count) for the pixels of each row.
    void forRows(const Workers& workers,
                 const std::function<void(std::size_t, std::size_t)>& body) const
    {
        const auto pixels = static_cast<std::size_t>(width);
        workers.forEach(static_cast<std::size_t>(height),
                        [&](std::size_t y) { body(y * pixels, pixels); });
    }

    int width = 0, height = 0;                ///< size of the arrays
    std::vector<float> light, albedo, normal; ///< RGB or XYZ, rows of pixels

    // The filter, which refers to the arrays, is destroyed before its device.
    Device device;
    int threads = 0; ///< number of the device's threads
    Filter filter;   ///< null: none for arrays of this size

    std::string failure;
};

void DenoiseOidn::Implementation::allocate(int newWidth, int newHeight)
{
    if (width == newWidth && height == newHeight) return;
    filter.reset();
    width = height = 0; // no size is valid if memory runs out below
    const std::size_t pixels =
        static_cast<std::size_t>(newWidth) * static_cast<std::size_t>(newHeight);
    for (std::vector<float>* values : {&light, &albedo, &normal})
        allocateLarge(*values, 3 * pixels);
    width = newWidth;
    height = newHeight;
}

/// Makes a device and a filter for the arrays. Returns the message of a failure; empty: nothing
/// failed.
std::string DenoiseOidn::Implementation::prepare(int wantedThreads)
{
    if (device && threads == wantedThreads) return filter ? std::string() : makeFilter();
    filter.reset();
    device.reset(oidnNewDevice(OIDN_DEVICE_TYPE_CPU));
    if (!device)
    {
        const std::string error = errorOf(nullptr);
        return error.empty() ? "there is no CPU device" : error;
    }
    set(device.get(), "numThreads", wantedThreads);
    set(device.get(), "setAffinity", false);
    oidnCommitDevice(device.get());
    threads = wantedThreads;
    const std::string error = errorOf(device.get());
    return error.empty() ? makeFilter() : error;
}

std::string DenoiseOidn::Implementation::makeFilter()
{
    filter.reset(oidnNewFilter(device.get(), "RT"));
    if (filter)
    {
        const auto setImage = [this](const char* name, std::vector<float>& values)
        {
            oidnSetSharedFilterImage(filter.get(), name, values.data(), OIDN_FORMAT_FLOAT3,
                                     static_cast<std::size_t>(width),
                                     static_cast<std::size_t>(height), 0, 0, 0);
        };
        setImage("color", light);
        setImage("albedo", albedo);
        setImage("normal", normal);
        setImage("output", light);
        set(filter.get(), "hdr", true);
        set(filter.get(), "cleanAux", true);
        oidnCommitFilter(filter.get());
    }
    const std::string error = errorOf(device.get());
    return error.empty() && !filter ? "there is no filter for ray traced images" : error;
}

std::string DenoiseOidn::Implementation::run(ResolvedImage& image, const Workers& workers)
{
    const std::string notReady = prepare(workers.threads());
    if (!notReady.empty()) return notReady;
    forRows(workers,
            [&](std::size_t first, std::size_t count)
            {
                for (std::size_t i = first; i < first + count; ++i)
                {
                    const float* rgba = &image.radiance[4 * i];
                    const float scale = isLight(rgba) ? 1.0f / rgba[3] : 0.0f;
                    for (std::size_t c = 0; c < 3; ++c)
                        light[3 * i + c] = scale > 0.0f ? std::max(0.0f, scale * rgba[c]) : 0.0f;
                }
            });
    // The error is read on this thread, as the library keeps errors for each thread.
    oidnExecuteFilter(filter.get());
    const std::string error = errorOf(device.get());
    if (!error.empty()) return error;
    forRows(workers,
            [&](std::size_t first, std::size_t count)
            {
                for (std::size_t i = first; i < first + count; ++i)
                {
                    float* rgba = &image.radiance[4 * i];
                    const float* rgb = &light[3 * i];
                    const bool known =
                        std::fabs(rgb[0]) + std::fabs(rgb[1]) + std::fabs(rgb[2]) < kLargestLight;
                    if (!known || !isLight(rgba)) continue;
                    for (std::size_t c = 0; c < 3; ++c)
                        rgba[c] = rgba[3] * rgb[c];
                }
            });
    return {};
}

bool DenoiseOidn::isBuiltIn()
{
    return true;
}

DenoiseOidn::DenoiseOidn() : _implementation(std::make_unique<Implementation>()) {}
DenoiseOidn::~DenoiseOidn() = default;

void DenoiseOidn::setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                              const Workers& workers)
{
    Implementation& self = *_implementation;
    self.allocate(width, height);
    self.forRows(workers,
                 [&](std::size_t first, std::size_t count)
                 {
                     for (std::size_t i = first; i < first + count; ++i)
                         putGuides(surfaces[i], &self.albedo[3 * i], &self.normal[3 * i]);
                 });
}

void DenoiseOidn::filter(ResolvedImage& image, const Workers& workers)
{
    Implementation& self = *_implementation;
    if (image.width != self.width || image.height != self.height || self.width == 0) return;
    if (!self.failure.empty()) return;
    const std::string error = self.run(image, workers);
    if (error.empty()) return;
    self.filter.reset();
    self.device.reset();
    self.failure = "Open Image Denoise failed (" + error + ")";
}

const std::string& DenoiseOidn::failure() const
{
    return _implementation->failure;
}

} // namespace osgRayTrace::engine
