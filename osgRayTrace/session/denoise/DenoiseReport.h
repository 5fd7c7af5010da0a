// DenoiseReport.h - the kinds of denoiser, and which one an image went through. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace osgRayTrace::engine
{

enum class DenoiseKind : uint8_t
{
    Off,
    Filter, ///< own filter: DenoiseFilter.h
    Oidn,   ///< Open Image Denoise, if the build found it: DenoiseOidn.h
};

/// Tells which denoiser the last image went through.
struct DenoiseReport
{
    DenoiseKind by = DenoiseKind::Off;
    std::string note; ///< reason in one sentence if the denoiser is not the one that was asked for
};

} // namespace osgRayTrace::engine
