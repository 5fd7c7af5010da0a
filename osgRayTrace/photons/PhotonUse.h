// PhotonUse.h - which photons an integrator needs. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

/// Which photons a pass stores. Direct light is never among them: it is sampled from the eye's
/// side.
enum class PhotonUse : uint8_t
{
    None,
    Caustics, ///< whose first surface was mirror-like: light, specular+, surface, and on from there
    Indirect, ///< that met any surface before
};

} // namespace osgRayTrace::engine
