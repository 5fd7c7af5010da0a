// EmbreeDevice.cpp - an Embree device that counts errors and memory. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/EmbreeDevice.h"

#include "osgRayTrace/base/Status.h"

#include <cstdio>
#include <string>

namespace osgRayTrace::engine
{

EmbreeDevice::EmbreeDevice()
{
    // Without "threads" Embree leaves TBB's own settings alone, and so the host's settings.
    _device = rtcNewDevice(nullptr);
    if (!_device) throw EngineError(StatusCode::DeviceFailure, "Embree could not be initialized");
    rtcSetDeviceErrorFunction(_device, &EmbreeDevice::onError, this);
    rtcSetDeviceMemoryMonitorFunction(_device, &EmbreeDevice::onMemory, this);
    if (rtcGetDeviceProperty(_device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        _nativeWidth = 16;
    else if (rtcGetDeviceProperty(_device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
        _nativeWidth = 8;
    else if (rtcGetDeviceProperty(_device, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED))
        _nativeWidth = 4;
}

EmbreeDevice::~EmbreeDevice()
{
    rtcReleaseDevice(_device);
}

void EmbreeDevice::checkErrors()
{
    std::lock_guard<std::mutex> lock(_mutex);
    if (!*_error) return;
    const EngineError error(_outOfMemory ? StatusCode::OutOfMemory : StatusCode::DeviceFailure,
                            std::string("Embree: ") + _error);
    *_error = 0;
    _outOfMemory = false;
    throw error;
}

/// Keeps the first error. Embree calls onError, and no exception may pass through Embree.
void EmbreeDevice::onError(void* self, RTCError code, const char* text) noexcept
{
    auto* device = static_cast<EmbreeDevice*>(self);
    std::lock_guard<std::mutex> lock(device->_mutex);
    device->_outOfMemory |= code == RTC_ERROR_OUT_OF_MEMORY;
    if (*device->_error) return; // later errors follow from the first and say less
    std::snprintf(device->_error, sizeof(device->_error), "%s",
                  text && *text ? text : "unknown error");
}

bool EmbreeDevice::onMemory(void* self, ssize_t bytes, bool)
{
    static_cast<EmbreeDevice*>(self)->_bytes += bytes;
    return true;
}

} // namespace osgRayTrace::engine
