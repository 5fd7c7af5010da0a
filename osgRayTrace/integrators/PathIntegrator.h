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
///   PhotonUse::Caustics  photons: light S+ D ... eye, looked up at each D of the camera path; path
///                        tracing: all others (light D ..., light S* eye)
///   PhotonUse::Indirect  photons: all that reach the first rough D seen from the eye after one
///                        bounce or more; path tracing: light sampling there, and all up to there
///                        (light (S|glossy)* eye)
///
/// A path from light to eye has at most maxBounces edges beside the camera ray, whoever makes it: photons
/// are stored with the number of theirs, and a lookup admits those that the camera path leaves room for.
///
/// A surface is rough if it has a GGX width from kGatherAlpha on or a Lambert base; its mirror-like
/// part is followed further. Rough glass gathers on both sides: photons carry flux, which an
/// interface does not squeeze into smaller angles, so they are followed with Transport::Importance
/// and looked up with the radiance's f [Veach97, ch. 5].
class PathIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
