// PhotonFields.h - photons and what look-ups of them read and write, in messages. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/Photon.h"
#include "osgRayTrace/servers/Wire.h"
#include "osgRayTrace/session/TileHelp.h"

namespace osgRayTrace::engine
{

/// The bytes of a photon in a message.
constexpr std::size_t kPhotonBytes = 4 * sizeof(Vec3) + 2 * sizeof(uint32_t) + 1;

template <class Archive> void fieldsOf(Archive& a, Photon& p)
{
    a(p.position, p.wi, p.power, p.normal, p.edges, p.direct, p.bin);
}

// A tile's look-ups: what they begin with, and what they have found.
void putWanted(WireWriter& out, const TilePhotons& photons);
void putFound(WireWriter& out, const TilePhotons& photons);
void takeWanted(WireReader& in, TilePhotons& photons);
void takeFound(WireReader& in, TilePhotons& photons);

} // namespace osgRayTrace::engine
