// DenoiseMode.h - the share of the error that denoising takes away, and its time. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures the relMSE against a converged picture at one and four passes, without and with the
/// filter, on a diffuse, a glossy and a textured box. Further rows tell the filter's time at 1920 x
/// 1080.
void measureDenoise(Rows& rows);

} // namespace osgRayTrace::bench
