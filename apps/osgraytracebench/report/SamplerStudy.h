// SamplerStudy.h - error against the number of light samples, strategy by strategy. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include "osgRayTrace/base/Parallel.h"

#include <memory>

namespace osgRayTrace::bench
{

/// Studies the four strategies of WHITTED below an open light, an edge, a turned edge and a disc,
/// at receivers whose pixels are a millionth wide: the pixel's filter adds no visible error. There
/// is one pass of N light samples; each pixel of a receiver's 16 x 16 is an independent run. Behind
/// occluders the ratio estimator of [HeitzHill18] is studied as well: the formula's open light
/// times the share of the sampled light that arrives.
std::vector<SamplerLine> studySamplers(int receivers, int mostSamples,
                                       const std::shared_ptr<engine::Workers>& workers);

} // namespace osgRayTrace::bench
