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

/// Tells how a geometry has changed since it first came.
enum class Mobility : uint8_t
{
    Static,
    Dynamic,
    Deforming, ///< the arrays change, and maybe the place
};

/// Keeps the meshes of geometries. A geometry is taken as unchanged while its arrays and primitive
/// sets are the same objects with the same modified counts, sizes and addresses, or with the same
/// values if counts or addresses differ. Whoever changes an array's values must call dirty() on the
/// array.
class GeometryCache
{
public:
    /// Variant of the mesh that all uses share, for mesh(). A use that cannot share it has its
    /// number + 1 as variant.
    static constexpr uint32_t kOwnVariant = 0;

    /// Begins a snapshot. stamp becomes the stamp of meshes that are converted from now on.
    void begin(Stamp stamp) { _stamp = stamp; }

    /// Returns the mesh, which is that of the last snapshot if nothing has changed; null if there
    /// is nothing to trace. path is the name of a new mesh. variant tells several meshes of one
    /// geometry apart.
    std::shared_ptr<const Mesh> mesh(const osg::Geometry& geometry, uint32_t variant,
                                     const MeshRequest& request, const std::string& path,
                                     ConversionReport& report);

    /// Returns the request of the geometry's shared mesh; null if the last snapshot did not ask for
    /// it. lastCounts returns the counts of that mesh.
    const MeshRequest* lastRequest(const osg::Geometry& geometry) const;
    const ConversionCounts& lastCounts(const osg::Geometry& geometry) const;

    /// Returns whether the geometry's arrays are those of its last mesh. The last snapshot must
    /// have asked for the geometry.
    bool hasSameArrays(const osg::Geometry& geometry);

    /// Returns whether the geometry's last mesh was made from its arrays as they are, with its data
    /// variance.
    bool isCurrent(const osg::Geometry& geometry);

    Mobility mobility(const osg::Geometry& geometry) const;

    /// Records a mobility, which never decreases: a geometry that has moved once will move again.
    void recordMobility(const osg::Geometry& geometry, Mobility mobility);

    /// Returns the number of meshes that were ever made from arrays.
    uint64_t converted() const { return _converted; }

    /// Returns the bounds of the geometry's positions, from the last snapshot if the positions have
    /// not changed. The reference is valid until end().
    const VertexBounds& bounds(const osg::Geometry& geometry);

    /// Forgets a geometry.
    void drop(const osg::Geometry* geometry);

    /// Ends the snapshot: forgets geometry for which it did not ask.
    void end();

private:
    /// Identifies a buffer. Its reference keeps the object alive, so that a new object at the same
    /// address cannot pass for the old one.
    struct BufferSignature
    {
        osg::ref_ptr<const osg::BufferData> buffer;
        unsigned int modified = 0;
        const void* data = nullptr;
        std::size_t bytes = 0;
        unsigned int kind = 0;            // binding of an array, mode of a primitive set
        unsigned int count = 0;           // number of vertices of a primitive set
        uint64_t ranges = 0;              // see rangesHash
        std::optional<uint64_t> contents; // set if the buffer was found modified: see contentsHash

        bool operator==(const BufferSignature& other) const; ///< ignores contents
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
        Stamp same = 0; ///< snapshot in which the arrays were last found unchanged
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
        BufferSignature positions; ///< its reference keeps the address of the array unique
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
        _mobility; ///< mobility of geometries that are not static
    uint64_t _converted = 0;
    std::unordered_map<const osg::Array*, BoundsEntry> _bounds;
    Stamp _stamp = 0;
};

} // namespace osgRayTrace::engine
