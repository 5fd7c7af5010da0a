// DenoiseReport.h - which denoiser there is, and which one an image went through. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace osgRayTrace::engine
{

enum class DenoiseKind : uint8_t
{
    Off,
    Filter, ///< ours: DenoiseFilter.h
    Oidn,   ///< Open Image Denoise, where it was found: DenoiseOidn.h
};

/// Of the last image.
struct DenoiseReport
{
    DenoiseKind by = DenoiseKind::Off;
    std::string note; ///< one sentence if that is not the one that was asked for
};

} // namespace osgRayTrace::engine
