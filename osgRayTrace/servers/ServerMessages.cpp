// ServerMessages.cpp - what viewers and render servers say to each other. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/ServerMessages.h"

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/servers/PhotonFields.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace osgRayTrace::engine
{

template <> struct LastEnumerator<IntegratorKind>
{
    static constexpr IntegratorKind value = IntegratorKind::Debug;
};
template <> struct LastEnumerator<LightSampling>
{
    static constexpr LightSampling value = LightSampling::Sobol;
};
template <> struct LastEnumerator<EnvironmentSampling>
{
    static constexpr EnvironmentSampling value = EnvironmentSampling::Uniform;
};
template <> struct LastEnumerator<DebugChannel>
{
    static constexpr DebugChannel value = DebugChannel::Cost;
};
template <> struct LastEnumerator<PhotonUse>
{
    static constexpr PhotonUse value = PhotonUse::Indirect;
};
template <> struct LastEnumerator<RadiusSchedule>
{
    static constexpr RadiusSchedule value = RadiusSchedule::Local;
};

namespace
{

constexpr uint64_t kMagic = 0x7265767265537452; // "RtServer"

template <class Archive> void headOf(Archive& a, TracedTiles& t)
{
    a(t.pass, t.group, t.seconds);
}

template <class Archive> void fieldsOf(Archive& a, PassOrder& o)
{
    HelpedPass& p = o.pass;
    a(o.number, o.scene, o.photons, p.photons.use, p.photons.leastRadius, p.photons.largestRadius,
      p.view.viewFromWorld, p.view.clipFromView, p.view.width, p.view.height, p.pass, p.centred,
      p.wantsDepth, p.wantsSurfaces, p.wantsSamples);
    // The members that images depend on are all that there are.
    const auto member = [&a](const auto& value)
    { a(const_cast<std::remove_const_t<std::remove_reference_t<decltype(value)>>&>(value)); };
    std::apply([&](const auto&... values) { (member(values), ...); }, p.options.restarting());
}

Bytes begin(MessageKind kind, std::size_t size = 0)
{
    Bytes bytes;
    bytes.reserve(size + 64);
    WireWriter out(bytes);
    out(kind);
    return bytes;
}

std::size_t tileBytes(const TracedTiles& t)
{
    return sizeof(int32_t) + sizeof(TileRgba) + sizeof(TileCounts) +
           (t.depth ? sizeof(TracedTile::depth) : 0) +
           (t.surfaces ? sizeof(TracedTile::surfaces) : 0) +
           (t.samples ? kTilePixels * sizeof(SurfaceSample) : 0);
}

/// Returns whether the options are those of a viewer: its settings have closer limits.
bool areUsable(const RenderOptions& options)
{
    constexpr int kMost = 1 << 16;
    return options.lightSamples >= 1 && options.lightSamples <= kMost &&
           options.environmentSamples >= 1 && options.environmentSamples <= kMost &&
           options.maxBounces >= 0 && options.maxBounces <= kMost &&
           std::isfinite(options.aperture) && std::isfinite(options.focus);
}

} // namespace

bool takeKind(WireReader& in, MessageKind& kind)
{
    in(kind);
    return in.good();
}

Bytes messageOf(const Hello& hello)
{
    Bytes bytes = begin(MessageKind::Hello);
    WireWriter out(bytes);
    out(kMagic, hello.number);
    out.text(hello.identity);
    return bytes;
}

Bytes messageOf(const Welcome& welcome)
{
    Bytes bytes = begin(MessageKind::Welcome);
    WireWriter out(bytes);
    out(welcome.number, welcome.threads);
    return bytes;
}

Bytes messageOf(const Refusal& refusal)
{
    Bytes bytes = begin(MessageKind::Refusal);
    WireWriter out(bytes);
    out.text(refusal.reason);
    out(refusal.lasts);
    return bytes;
}

Bytes messageOf(const Ready& ready)
{
    Bytes bytes = begin(MessageKind::Ready);
    WireWriter out(bytes);
    out(ready.scene, ready.seconds);
    return bytes;
}

Bytes messageOf(const PassOrder& order)
{
    Bytes bytes = begin(MessageKind::Pass);
    WireWriter out(bytes);
    fieldsOf(out, const_cast<PassOrder&>(order));
    return bytes;
}

Bytes messageOf(const TileOrders& orders)
{
    Bytes bytes = begin(MessageKind::Tiles);
    WireWriter out(bytes);
    out(orders.pass, orders.group);
    out.array(orders.tiles);
    out(orders.hasPhotons);
    for (const TilePhotons& photons : orders.photons)
        putWanted(out, photons);
    return bytes;
}

Bytes messageOf(const TracedTiles& traced, const TracedTile* results)
{
    Bytes bytes = begin(MessageKind::Traced, traced.tiles.size() * tileBytes(traced));
    WireWriter out(bytes);
    headOf(out, const_cast<TracedTiles&>(traced));
    out(traced.depth, traced.surfaces, traced.samples, traced.photons);
    out.array(traced.tiles);
    for (std::size_t i = 0; i < traced.tiles.size(); ++i)
    {
        const TracedTile& tile = results[i];
        out.append(tile.rgba, sizeof tile.rgba);
        out(tile.counts);
        if (traced.depth) out.append(tile.depth, sizeof tile.depth);
        if (traced.surfaces) out.append(tile.surfaces, sizeof tile.surfaces);
        if (traced.samples) out.append(tile.samples.data(), kTilePixels * sizeof(SurfaceSample));
        if (traced.photons) putFound(out, *tile.photons);
    }
    return bytes;
}

Bytes sceneMessage(uint64_t number, const Bytes& scene)
{
    Bytes bytes = begin(MessageKind::Scene, scene.size());
    WireWriter out(bytes);
    out(number);
    out.append(scene.data(), scene.size());
    return bytes;
}

Bytes photonsMessage(uint64_t number, const HelpedPhotons& photons)
{
    const PhotonMap& map = photons.pass->map;
    Bytes bytes = begin(MessageKind::Photons, map.size() * kPhotonBytes);
    WireWriter out(bytes);
    out(number, photons.cellSize, static_cast<uint64_t>(map.size()));
    for (uint32_t i = 0; i < map.size(); ++i)
    {
        Photon photon = map.photon(i);
        fieldsOf(out, photon);
    }
    return bytes;
}

Bytes dropMessage(uint64_t pass)
{
    Bytes bytes = begin(MessageKind::Drop);
    WireWriter out(bytes);
    out(pass);
    return bytes;
}

Bytes plainMessage(MessageKind kind)
{
    return begin(kind);
}

bool takeMessage(WireReader& in, Hello& hello)
{
    constexpr std::size_t kLongest = 1000;
    uint64_t magic = 0;
    in(magic, hello.number);
    if (magic != kMagic || in.left() > kLongest) return false;
    in.text(hello.identity);
    return in.good();
}

bool takeMessage(WireReader& in, Welcome& welcome)
{
    constexpr uint32_t kMostThreads = 1 << 16;
    in(welcome.number, welcome.threads);
    return in.good() && welcome.threads >= 1 && welcome.threads <= kMostThreads;
}

bool takeMessage(WireReader& in, Refusal& refusal)
{
    constexpr std::size_t kLongest = 1000;
    if (in.left() > kLongest) return false;
    in.text(refusal.reason);
    refusal.lasts = in.left() == 0; // of a build that does not tell, which is another one
    if (in.left() > 0) in(refusal.lasts);
    return in.good();
}

bool takeMessage(WireReader& in, Ready& ready)
{
    in(ready.scene, ready.seconds);
    return in.good() && ready.seconds >= 0.0;
}

bool takeMessage(WireReader& in, PassOrder& order)
{
    fieldsOf(in, order);
    const View& view = order.pass.view;
    return in.good() && in.left() == 0 && order.pass.pass >= 0 && view.width > 0 &&
           view.height > 0 && int64_t(view.width) * view.height <= Film::kMaxPixels &&
           areUsable(order.pass.options);
}

bool takeMessage(WireReader& in, PhotonList& list)
{
    uint64_t count = 0;
    in(list.number, list.cellSize, count);
    if (!in.good() || in.left() != count * kPhotonBytes || count > in.left()) return false;
    list.photons.resize(static_cast<std::size_t>(count));
    bool finite = list.cellSize >= 0.0f;
    for (Photon& photon : list.photons)
    {
        fieldsOf(in, photon);
        const Vec3 sum = photon.position + photon.wi + photon.power + photon.normal;
        constexpr float kLongest = 2.0f; // for squares of normals
        finite = finite && std::isfinite(sum.x + sum.y + sum.z) && photon.edges <= kMostEdges &&
                 glm::dot(photon.normal, photon.normal) < kLongest;
    }
    return in.good() && finite;
}

bool takeMessage(WireReader& in, TileOrders& orders, std::size_t mostTiles)
{
    constexpr std::size_t kMostTiles = 4096; // of a group; results take far more memory
    in(orders.pass, orders.group);
    in.array(orders.tiles);
    in(orders.hasPhotons);
    if (!in.good() || orders.tiles.size() > std::min(kMostTiles, mostTiles)) return false;
    orders.photons.clear();
    for (std::size_t i = 0; orders.hasPhotons && i < orders.tiles.size() && in.good(); ++i)
    {
        orders.photons.emplace_back();
        takeWanted(in, orders.photons.back());
    }
    return in.good() && in.left() == 0;
}

bool takeHead(WireReader& in, TracedTiles& traced)
{
    headOf(in, traced);
    return in.good() && std::isfinite(traced.seconds) && traced.seconds >= 0.0;
}

bool takeMessage(WireReader& in, TracedTiles& traced)
{
    if (!takeHead(in, traced)) return false;
    in(traced.depth, traced.surfaces, traced.samples, traced.photons);
    in.array(traced.tiles);
    const std::size_t each = tileBytes(traced) - sizeof(int32_t);
    return in.good() && in.left() / each >= traced.tiles.size();
}

bool takeTile(WireReader& in, const TracedTiles& traced, TracedTile& tile)
{
    in.copy(tile.rgba, sizeof tile.rgba);
    in(tile.counts);
    if (traced.depth) in.copy(tile.depth, sizeof tile.depth);
    if (traced.surfaces) in.copy(tile.surfaces, sizeof tile.surfaces);
    tile.samples.resize(traced.samples ? std::size_t(kTilePixels) : 0);
    in.copy(tile.samples.data(), tile.samples.size() * sizeof(SurfaceSample));
    if (!traced.photons) return in.good();
    tile.photons = std::make_unique<TilePhotons>();
    takeFound(in, *tile.photons);
    return in.good();
}

} // namespace osgRayTrace::engine
