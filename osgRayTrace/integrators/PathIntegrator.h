// PathIntegrator.h - unidirectional path tracing with light sampling. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/Integrator.h"

namespace osgRayTrace::engine
{

/// Path tracing with light sampling, multiple importance sampling and Russian roulette: unbiased up
/// to maxBounces. With photons it leaves them a part of the paths, so that each is counted once.
/// With D a surface that is not mirror-like (or the part of one), S a mirror-like reflection or
/// refraction:
///
///   PhotonUse::None      all paths
///   PhotonUse::Caustics  photons: light S+ D ... eye, looked up at each D of the camera path that
///   does not
///                        transmit; path tracing: all others (light D ..., light S* eye)
///   PhotonUse::Indirect  photons: all that reach the first rough D seen from the eye after one
///   bounce or
///                        more; path tracing: light sampling there, and all up to there (light
///                        (S|glossy)* eye)
///
/// Pixels of a tile lend each other paths (PathReuse.h), so their errors depend on each other: the error
/// of a pixel is estimated rightly by the film, that of a mean over a tile is greater than if they were
/// independent. Tiles are independent.
///
/// A surface is rough if it does not transmit and has a GGX width from kGatherAlpha on or a Lambert
/// base; its mirror-like part is followed further.
class PathIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
