// ServerMessages.h - what viewers and render servers say to each other. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/Photon.h"
#include "osgRayTrace/servers/Wire.h"
#include "osgRayTrace/session/TileHelp.h"

#include <cstdint>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// The first byte of a message. A viewer says Hello, until a server answers with Welcome or
/// Refusal; then it sends Scene, Photons, Pass, Tiles, and Drop for a pass that it no longer wants.
/// A server answers Scene with Ready and Tiles with Traced, in the order in which they came, and
/// what it does not understand with Refusal. It says Stranger to whoever has not said Hello to it.
enum class MessageKind : uint8_t
{
    Hello,
    Welcome,
    Refusal,
    Scene,
    Ready,
    Pass,
    Tiles,
    Traced,
    Drop,
    Bye,
    Stranger,
    Photons,
};
template <> struct LastEnumerator<MessageKind>
{
    static constexpr MessageKind value = MessageKind::Photons;
};

/// Returns the kind of a message, and false if it has none.
bool takeKind(WireReader& in, MessageKind& kind);

struct Hello
{
    uint64_t number = 0;  ///< counts the hellos of a viewer
    std::string identity; ///< see buildIdentity()
};

struct Welcome
{
    uint64_t number = 0; ///< of the hello
    uint32_t threads = 1;
};

struct Refusal
{
    std::string reason;
    bool lasts = false; ///< whether asking again is of no use: the builds differ
};

/// The bytes of a SceneSender follow.
struct SceneNumber
{
    uint64_t number = 0;
};

struct Ready
{
    uint64_t scene = 0;
    double seconds = 0.0; ///< time to prepare the scene
};

/// The photons of a pass, in the order of its map.
struct PhotonList
{
    uint64_t number = 0;
    float cellSize = 0.0f;
    std::vector<Photon> photons;
};

/// A pass with its scene and its photons by number; 0: none.
struct PassOrder
{
    uint64_t number = 0;
    uint64_t scene = 0;
    uint64_t photons = 0;
    HelpedPass pass;
};

struct TileOrders
{
    uint64_t pass = 0;
    uint64_t group = 0; ///< counts the groups of tiles of a viewer
    std::vector<int32_t> tiles;
    bool hasPhotons = false; ///< whether the pass has photons
    std::vector<TilePhotons> photons;
};

/// The tiles themselves follow.
struct TracedTiles
{
    uint64_t pass = 0;
    uint64_t group = 0;
    double seconds = 0.0; ///< wall time in which the tiles were traced
    bool depth = false, surfaces = false, samples = false, photons = false;
    std::vector<int32_t> tiles; ///< fewer than wanted if the pass was dropped
};

Bytes messageOf(const Hello& hello);
Bytes messageOf(const Welcome& welcome);
Bytes messageOf(const Refusal& refusal);
Bytes messageOf(const Ready& ready);
Bytes messageOf(const PassOrder& order);
Bytes photonsMessage(uint64_t number, const HelpedPhotons& photons);
Bytes messageOf(const TileOrders& orders);
Bytes messageOf(const TracedTiles& traced, const TracedTile* results);
Bytes sceneMessage(uint64_t number, const Bytes& scene);
Bytes dropMessage(uint64_t pass);
Bytes plainMessage(MessageKind kind); ///< Bye, Stranger

// These functions read what follows the kind. They return false if the message is damaged, or asks
// for what no viewer would.
bool takeMessage(WireReader& in, Hello& hello);
bool takeMessage(WireReader& in, Welcome& welcome);
bool takeMessage(WireReader& in, Refusal& refusal);
bool takeMessage(WireReader& in, Ready& ready);
bool takeMessage(WireReader& in, PassOrder& order);
bool takeMessage(WireReader& in, PhotonList& list);
bool takeMessage(WireReader& in, TileOrders& orders, std::size_t mostTiles);
bool takeMessage(WireReader& in, TracedTiles& traced);

/// Reads the next tile of such a message.
bool takeTile(WireReader& in, const TracedTiles& traced, TracedTile& tile);

/// Reads what traced tiles belong to, and nothing more.
bool takeHead(WireReader& in, TracedTiles& traced);

} // namespace osgRayTrace::engine
