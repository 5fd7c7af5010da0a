// PathIntegrator.h - unidirectional path tracing with light sampling. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// Path tracing with light sampling, multiple importance sampling and Russian roulette: unbiased up
/// to maxBounces. With photons it leaves them a part of the paths, so that each is counted once.
/// With D a surface that is not mirror-like (or the part of one), S a mirror-like reflection or
/// refraction, G the first rough surface that the path meets from the eye:
///
/// PhotonUse::None: all paths.
///
/// PhotonUse::Caustics: photons are those that began light S+. All of them are looked up at G; at
/// glossy surfaces before it only those that met nothing but S. Theirs are so all paths light S+ D
/// ... eye; traced are the others, light D ... and light S* eye. Light that left glass or a mirror
/// also lights the room from there on: a path would have to find the bright spot by chance.
///
/// PhotonUse::Indirect: photons are all that met a surface before, looked up at G. Traced are
/// light sampling there, and all up to there: light (S|glossy)* eye.
///
/// A path from light to eye has at most maxBounces edges beside the camera ray, whoever makes it:
/// photons are stored with the number of theirs, and a lookup admits those that the camera path
/// leaves room for.
///
/// A surface is rough if it has a GGX width from kGatherAlpha on or a Lambert base; its mirror-like
/// part is followed further. Rough glass gathers on both sides: photons carry flux, which an
/// interface does not squeeze into smaller angles, so they are followed with Transport::Importance
/// and looked up with the radiance's f [Veach97, ch. 5].
///
/// Pixels of a tile share paths (PathReuse.h), so their errors depend on each other: the
/// error of a pixel is estimated rightly by the film, that of a mean over a tile is greater than if
/// they were independent. Tiles are independent.
class PathIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
