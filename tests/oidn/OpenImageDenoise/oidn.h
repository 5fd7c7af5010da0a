// oidn.h - not Open Image Denoise: a stand-in for tests that declares what DenoiseOidn.cpp calls,
// as the library's documentation describes it. CMake gives OIDN_VERSION_MAJOR, 1 or 2, on which the
// names of setters depend. StandIn.h describes what the stand-in does.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

extern "C"
{
    typedef struct OIDNDeviceImpl* OIDNDevice;
    typedef struct OIDNFilterImpl* OIDNFilter;

    enum OIDNDeviceType
    {
        OIDN_DEVICE_TYPE_DEFAULT = 0,
        OIDN_DEVICE_TYPE_CPU = 1
    };
    enum OIDNError
    {
        OIDN_ERROR_NONE = 0,
        OIDN_ERROR_UNKNOWN = 1,
        OIDN_ERROR_INVALID_ARGUMENT = 2,
        OIDN_ERROR_INVALID_OPERATION = 3
    };
    enum OIDNFormat
    {
        OIDN_FORMAT_FLOAT = 1,
        OIDN_FORMAT_FLOAT3 = 3
    };

    OIDNDevice oidnNewDevice(OIDNDeviceType type);
    void oidnReleaseDevice(OIDNDevice device);
    void oidnCommitDevice(OIDNDevice device);
    OIDNError oidnGetDeviceError(OIDNDevice device, const char** message);

    OIDNFilter oidnNewFilter(OIDNDevice device, const char* type);
    void oidnReleaseFilter(OIDNFilter filter);
    void oidnSetSharedFilterImage(OIDNFilter filter, const char* name, void* pixels,
                                  OIDNFormat format, std::size_t width, std::size_t height,
                                  std::size_t byteOffset, std::size_t pixelByteStride,
                                  std::size_t rowByteStride);
    void oidnCommitFilter(OIDNFilter filter);
    void oidnExecuteFilter(OIDNFilter filter);

#if OIDN_VERSION_MAJOR >= 2
    void oidnSetDeviceInt(OIDNDevice device, const char* name, int value);
    void oidnSetDeviceBool(OIDNDevice device, const char* name, bool value);
    void oidnSetFilterBool(OIDNFilter filter, const char* name, bool value);
#else
    void oidnSetDevice1i(OIDNDevice device, const char* name, int value);
    void oidnSetDevice1b(OIDNDevice device, const char* name, bool value);
    void oidnSetFilter1b(OIDNFilter filter, const char* name, bool value);
#endif
}
