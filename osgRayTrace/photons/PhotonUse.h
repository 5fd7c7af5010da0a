// PhotonUse.h - which photons an integrator needs. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

/// Tells which photons a pass stores. Direct light is never among them: it is sampled from the
/// eye's side.
enum class PhotonUse : uint8_t
{
    None,
    Caustics, ///< photons that the first surface sent on by a mirror-like lobe, or that any lobe of
              ///< a surface sent on that is glossy: Bsdf::isGlossy
    Indirect, ///< photons that have met any surface before
};

} // namespace osgRayTrace::engine
