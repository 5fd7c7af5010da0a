// StandIn.cpp - stands in for Open Image Denoise in tests.
// SPDX-License-Identifier: MIT
#include "tests/oidn/StandIn.h"

#include <OpenImageDenoise/oidn.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>

using namespace osgRayTrace::engine::test;

namespace
{

StandIn state;

struct Image
{
    float* pixels = nullptr;
    std::size_t width = 0, height = 0;
};

/// Errors are kept for each thread, and the first of them stays, as in the library.
struct Errors
{
    std::map<std::thread::id, std::string> first;
    std::string told; ///< stays valid until the next error is asked for
};

Errors globalErrors;

void fail(Errors& errors, const std::string& message)
{
    errors.first.emplace(std::this_thread::get_id(), message);
}

} // namespace

struct OIDNDeviceImpl
{
    std::map<std::string, int> values{{"numThreads", 0}, {"setAffinity", 1}};
    bool committed = false;
    Errors errors;
};

struct OIDNFilterImpl
{
    OIDNDevice device;
    std::map<std::string, Image> images;
    std::map<std::string, bool> values{{"hdr", false}, {"srgb", false}, {"cleanAux", false}};
    bool committed = false;
};

namespace
{

/// Records a mistake of the caller for the test, and reports it to the caller as the library would.
void mistake(OIDNDevice device, const std::string& message)
{
    state.mistakes.push_back(message);
    fail(device ? device->errors : globalErrors, message);
}

void setValue(OIDNDevice device, const std::string& name, int value)
{
    if (device->committed) return mistake(device, name + " of a committed device");
    if (!device->values.count(name)) return mistake(device, "unknown device parameter " + name);
    device->values[name] = value;
}

void setValue(OIDNFilter filter, const std::string& name, bool value)
{
    filter->committed = false;
    if (!filter->values.count(name))
        return mistake(filter->device, "unknown filter parameter " + name);
    filter->values[name] = value;
}

/// Returns whether all values of the pixels are in [low, high]; the first other value is recorded
/// as a mistake.
bool areWithin(OIDNFilter filter, const std::string& name, float low, float high)
{
    const Image& image = filter->images[name];
    for (std::size_t i = 0; i < 3 * image.width * image.height; ++i)
    {
        const float value = image.pixels[i];
        if (std::isfinite(value) && value >= low && value <= high) continue;
        mistake(filter->device, name + " of " + std::to_string(value));
        return false;
    }
    return true;
}

std::vector<float> valuesOf(const Image& image)
{
    return std::vector<float>(image.pixels, image.pixels + 3 * image.width * image.height);
}

void meanOfNeighbours(const std::vector<float>& light, const Image& output)
{
    const int width = static_cast<int>(output.width), height = static_cast<int>(output.height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
            {
                float sum = 0.0f, count = 0.0f;
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
                    {
                        sum += light[static_cast<std::size_t>(3 * (v * width + u) + c)];
                        count += 1.0f;
                    }
                output.pixels[3 * (y * width + x) + c] = sum / count;
            }
}

} // namespace

namespace osgRayTrace::engine::test
{

int StandIn::times(const std::string& call) const
{
    return static_cast<int>(std::count(calls.begin(), calls.end(), call));
}

StandIn& standIn()
{
    return state;
}

StandIn& beginStandIn(Fault fault)
{
    const int devices = state.devices, filters = state.filters;
    state = StandIn();
    state.fault = fault;
    state.devices = devices;
    state.filters = filters;
    return state;
}

} // namespace osgRayTrace::engine::test

extern "C"
{

    OIDNDevice oidnNewDevice(OIDNDeviceType type)
    {
        state.calls.push_back("new device");
        if (type != OIDN_DEVICE_TYPE_CPU) state.mistakes.push_back("not the CPU device");
        if (state.fault == Fault::NewDevice)
        {
            fail(globalErrors, "no such device");
            return nullptr;
        }
        ++state.devices;
        return new OIDNDeviceImpl;
    }

    void oidnReleaseDevice(OIDNDevice device)
    {
        if (state.filters > 0 && state.devices == 1)
            state.mistakes.push_back("a device released before its filter");
        --state.devices;
        delete device;
    }

    void oidnCommitDevice(OIDNDevice device)
    {
        if (device->committed) return mistake(device, "a device committed twice");
        state.calls.push_back("device, threads " + std::to_string(device->values["numThreads"]) +
                              (device->values["setAffinity"] ? ", pinned" : ""));
        if (state.fault == Fault::CommitDevice) return fail(device->errors, "the device will not");
        device->committed = true;
    }

    OIDNError oidnGetDeviceError(OIDNDevice device, const char** message)
    {
        Errors& errors = device ? device->errors : globalErrors;
        const auto found = errors.first.find(std::this_thread::get_id());
        if (found == errors.first.end())
        {
            if (message) *message = nullptr;
            return OIDN_ERROR_NONE;
        }
        errors.told = found->second;
        errors.first.erase(found);
        if (message) *message = errors.told.c_str();
        return OIDN_ERROR_UNKNOWN;
    }

    OIDNFilter oidnNewFilter(OIDNDevice device, const char* type)
    {
        state.calls.push_back(std::string("new ") + type);
        if (!device->committed) mistake(device, "a filter of a device that is not committed");
        if (state.fault == Fault::NewFilter)
        {
            fail(device->errors, "no such filter");
            return nullptr;
        }
        ++state.filters;
        return new OIDNFilterImpl{device, {}};
    }

    void oidnReleaseFilter(OIDNFilter filter)
    {
        --state.filters;
        delete filter;
    }

    void oidnSetSharedFilterImage(OIDNFilter filter, const char* name, void* pixels,
                                  OIDNFormat format, std::size_t width, std::size_t height,
                                  std::size_t byteOffset, std::size_t pixelByteStride,
                                  std::size_t rowByteStride)
    {
        filter->committed = false;
        if (!pixels || format != OIDN_FORMAT_FLOAT3 || width == 0 || height == 0 || byteOffset != 0)
            return mistake(filter->device, std::string("no image for ") + name);
        if ((pixelByteStride != 0 && pixelByteStride != 12) ||
            (rowByteStride != 0 && rowByteStride != 12 * width))
            return mistake(filter->device, std::string("gaps between the pixels of ") + name);
        filter->images[name] = {static_cast<float*>(pixels), width, height};
    }

    void oidnCommitFilter(OIDNFilter filter)
    {
        const Image output = filter->images["output"];
        for (const char* name : {"color", "albedo", "normal", "output"})
        {
            const Image& image = filter->images[name];
            if (!image.pixels || image.width != output.width || image.height != output.height)
                return mistake(filter->device, std::string("another size, or no image: ") + name);
        }
        if (filter->images.size() != 4)
            return mistake(filter->device, "an image that it does not know");
        std::string call =
            "filter " + std::to_string(output.width) + "x" + std::to_string(output.height);
        for (const auto& value : filter->values)
            if (value.second) call += " " + value.first;
        state.calls.push_back(call);
        if (state.fault == Fault::CommitFilter)
            return fail(filter->device->errors, "the filter will not");
        filter->committed = true;
    }

    void oidnExecuteFilter(OIDNFilter filter)
    {
        state.calls.push_back("execute");
        if (!filter->committed) return mistake(filter->device, "a filter that is not committed");
        if (!areWithin(filter, "color", 0.0f, 3e38f) || !areWithin(filter, "albedo", 0.0f, 1.0f) ||
            !areWithin(filter, "normal", -1.0f, 1.0f))
            return;
        state.light = valuesOf(filter->images["color"]);
        state.albedo = valuesOf(filter->images["albedo"]);
        state.normal = valuesOf(filter->images["normal"]);
        if (state.fault == Fault::Execute)
        {
            const Image& output = filter->images["output"]; // its contents are undefined then
            std::fill_n(output.pixels, 3 * output.width * output.height, NAN);
            return fail(filter->device->errors, "out of luck");
        }
        meanOfNeighbours(state.light, filter->images["output"]);
    }

#if OIDN_VERSION_MAJOR >= 2
    void oidnSetDeviceInt(OIDNDevice d, const char* name, int value)
    {
        setValue(d, name, value);
    }
    void oidnSetDeviceBool(OIDNDevice d, const char* name, bool value)
    {
        setValue(d, name, int(value));
    }
    void oidnSetFilterBool(OIDNFilter f, const char* name, bool value)
    {
        setValue(f, name, value);
    }
#else
    void oidnSetDevice1i(OIDNDevice d, const char* name, int value)
    {
        setValue(d, name, value);
    }
    void oidnSetDevice1b(OIDNDevice d, const char* name, bool value)
    {
        setValue(d, name, int(value));
    }
    void oidnSetFilter1b(OIDNFilter f, const char* name, bool value)
    {
        setValue(f, name, value);
    }
#endif
}
