// EmbreeDevice.h - an Embree device that counts errors and memory. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Embree.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

namespace osgRayTrace::engine
{

/// An Embree device that is owned by the scenes that the device built. The class is thread
/// safe.
class EmbreeDevice
{
public:
    /// Creates the device. Throws EngineError(DeviceFailure).
    EmbreeDevice();
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice handle() const { return _device; }

    /// Returns the width of the widest packet that the CPU traces natively: 16, 8, 4 or 1.
    int nativeWidth() const { return _nativeWidth; }

    /// Returns true if rays pass geometries by their masks. Embree can be built without.
    bool masksRays() const
    {
        return rtcGetDeviceProperty(_device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0;
    }

    uint64_t bytes() const { return _bytes.load(); }

    /// Throws EngineError if Embree reported anything since the last call.
    void checkErrors();

private:
    static void onError(void* self, RTCError code, const char* text) noexcept;
    static bool onMemory(void* self, ssize_t bytes, bool post);

    RTCDevice _device = nullptr;
    int _nativeWidth = 1;
    std::atomic<int64_t> _bytes{0};
    std::mutex _mutex;     // guards the members below, for any thread that calls Embree
    char _error[128] = ""; ///< the first error; a std::string may need the memory that is gone
    bool _outOfMemory = false;
};

} // namespace osgRayTrace::engine
