// PathIntegrator.h - unidirectional path tracing with light sampling. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// A PathIntegrator traces paths with light sampling, multiple importance sampling and Russian
/// roulette, and is unbiased up to maxBounces. Photons take over a part of the paths, so that each
/// path is counted once. The letter D stands for a surface, or the part of a surface, that is not
/// mirror-like, S for a mirror-like reflection or refraction, N for a glossy surface, all of whose
/// lobes are narrow (Bsdf::isGlossy), and G for the first rough surface that the path meets from
/// the eye.
///
/// PhotonUse::None: the integrator traces all paths.
///
/// PhotonUse::Caustics: photons are stored if their paths began with light S or light N. All
/// photons are looked up at G; glossy surfaces before G look up only photons that met nothing but
/// S. Photons so make up all paths light (S|N) ... G ... eye and light S+ N ... eye. The integrator
/// traces the others: those whose first surface from the light is neither S nor N, and those that
/// meet nothing but S and N and do not begin with light S+ N. So behind G a path takes no light
/// sample on N, and light that it meets by chance next counts for nothing. Light that left glass or
/// metal also lights the room by way of photons: a path would have to find the bright spot by
/// chance.
///
/// PhotonUse::Indirect: photons are stored if they met a surface before, and are looked up at G.
/// The integrator samples lights at G and traces all paths up to G: light (S|glossy)* eye.
///
/// In scenes with volumes a collision is no G: paths go on there, and look up the photons within
/// media that met nothing but S, before they come to G. Photons so make up all paths light S+
/// (collision) (collision|S)* eye as well, and light that a path meets from a collision by S+
/// counts for nothing.
///
/// A path from light to eye has at most maxBounces edges beside the camera ray, with photons as
/// well as without them: a photon is stored with the number of its edges, and a look-up admits the
/// photons for which the camera path leaves enough edges.
///
/// A surface is rough if its GGX width is kRoughAlpha or more or if it has a Lambert base; paths
/// go on by the mirror-like part of a rough surface. Rough glass gathers on both sides: photons
/// carry flux, which an interface does not squeeze into smaller angles, so photons are followed
/// with Transport::Importance and looked up with the radiance's f [Veach97, ch. 5].
///
/// Pixels of a tile share paths (PathReuse.h), so the errors of these pixels depend on each other.
/// The film estimates the error of a pixel rightly, but the error of a mean over a tile is greater
/// than that of independent pixels. Tiles are independent.
class PathIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
