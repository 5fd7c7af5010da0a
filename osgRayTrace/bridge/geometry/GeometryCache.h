// GeometryCache.h - the meshes of unchanged geometry, kept between snapshots. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/geometry/GeometryConverter.h"

#include <osg/observer_ptr>

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// What a geometry has done since it first came.
enum class Mobility : uint8_t
{
    Static,
    Dynamic,
    Deforming, ///< its arrays change, and maybe its place
};

/// A geometry is taken as unchanged while its arrays and primitive sets are the same objects with
/// the same modified counts, sizes and addresses, or the same values where these differ: call
/// dirty() on an array whose values were changed.
class GeometryCache
{
public:
    /// Of mesh(): the mesh that all uses share. The use number n that cannot is n + 1.
    static constexpr uint32_t kOwnVariant = 0;

    /// Begins a snapshot. stamp is that of meshes converted now.
    void begin(Stamp stamp) { _stamp = stamp; }

    /// The mesh, null if there is nothing to trace, from the last snapshot if it is the same. path
    /// is the name of a new mesh. variant tells several meshes of one geometry apart.
    std::shared_ptr<const Mesh> mesh(const osg::Geometry& geometry, uint32_t variant,
                                     const MeshRequest& request, const std::string& path,
                                     ConversionReport& report);

    /// Null: it was not asked for in the last snapshot. The request of its shared mesh, and what it
    /// gave.
    const MeshRequest* lastRequest(const osg::Geometry& geometry) const;
    const ConversionCounts& lastCounts(const osg::Geometry& geometry) const;

    /// Whether its arrays are those of its last mesh. It was asked for in the last snapshot.
    bool hasSameArrays(const osg::Geometry& geometry);

    Mobility mobility(const osg::Geometry& geometry) const;

    /// Never takes anything back: what has moved once will move again.
    void recordMobility(const osg::Geometry& geometry, Mobility mobility);

    /// Meshes that were made from arrays, ever.
    uint64_t converted() const { return _converted; }

    /// Of the geometry's positions, from the last snapshot if they are the same. Valid until end().
    const VertexBounds& bounds(const osg::Geometry& geometry);

    /// Forgets a geometry.
    void drop(const osg::Geometry* geometry);

    /// Ends the snapshot: forgets geometry that was not asked for in it.
    void end();

private:
    /// References keep the objects alive, so that a new one cannot pass for an old one at its
    /// address.
    struct BufferSignature
    {
        osg::ref_ptr<const osg::BufferData> buffer;
        unsigned int modified = 0;
        const void* data = nullptr;
        std::size_t bytes = 0;
        unsigned int kind = 0;            // binding of an array, mode of a primitive set
        unsigned int count = 0;           // vertices of a primitive set
        uint64_t ranges = 0;              // see rangesHash
        std::optional<uint64_t> contents; // of one that was found modified: see contentsHash

        bool operator==(const BufferSignature& other) const; ///< but for contents
    };
    using GeometrySignature = std::vector<BufferSignature>;

    struct Entry
    {
        osg::observer_ptr<const osg::Geometry> geometry;
        osg::Object::DataVariance variance = osg::Object::UNSPECIFIED;
        GeometrySignature signature;
        MeshRequest request;
        std::shared_ptr<const Mesh> mesh;
        ConversionCounts counts;
        Stamp used = 0;
        Stamp same = 0; ///< arrays were found to be the same in this snapshot
    };
    using Key = std::pair<const osg::Geometry*, uint32_t>;
    struct KeyHash
    {
        std::size_t operator()(const Key& key) const
        {
            return std::hash<const void*>()(key.first) +
                   key.second * std::size_t(0x9e3779b97f4a7c15);
        }
    };

    struct MobilityEntry
    {
        ObjectName geometry;
        Mobility mobility = Mobility::Static;
    };

    struct BoundsEntry
    {
        BufferSignature positions; ///< its reference keeps the array's address its own
        VertexBounds bounds;
        Stamp used = 0;
    };

    static BufferSignature signatureOf(const osg::BufferData* buffer, unsigned int kind);
    static GeometrySignature signatureOf(const osg::Geometry& geometry);
    static bool isSame(BufferSignature& then, BufferSignature& now);
    static bool isSame(GeometrySignature& then, GeometrySignature& now);

    const Entry* find(const osg::Geometry& geometry) const;
    Entry* find(const osg::Geometry& geometry);
    void dropBounds(const BufferSignature& positions);
    static KeptArrays keptArrays(Entry& before, GeometrySignature& now);

    std::unordered_map<Key, Entry, KeyHash> _entries;
    std::unordered_map<const osg::Geometry*, MobilityEntry>
        _mobility; ///< those that are not static
    uint64_t _converted = 0;
    std::unordered_map<const osg::Array*, BoundsEntry> _bounds;
    Stamp _stamp = 0;
};

} // namespace osgRayTrace::engine
