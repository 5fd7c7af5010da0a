// GeometryCache.cpp - compares signatures of geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/GeometryCache.h"

#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/BufferHashes.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Names the order of the buffers in a signature.
enum : std::size_t
{
    kPositions,
    kNormals,
    kColors,
    kUvs,
    kUvs1,
    kTangents,
    kPrimitives, ///< the primitive sets begin here, and then come texture coordinates of other
                 ///< units
};

/// Shares the triangle array of equal meshes, because a BVH that can be refitted is known by it.
void shareTriangles(Mesh& mesh, const Mesh& before)
{
    if (mesh.positions.size() == before.positions.size() &&
        mesh.triangles.size() == before.triangles.size() &&
        std::equal(mesh.triangles.begin(), mesh.triangles.end(), before.triangles.begin()))
        mesh.triangles = before.triangles;
}

} // namespace

bool GeometryCache::BufferSignature::operator==(const BufferSignature& other) const
{
    const auto values = [](const BufferSignature& p) {
        return std::make_tuple(p.buffer.get(), p.modified, p.data, p.bytes, p.kind, p.count,
                               p.ranges);
    };
    return values(*this) == values(other);
}

/// Returns whether two signatures are equal. If only the modified count or the address of the data
/// differs, the values decide; a hash of the compared values is remembered in both signatures.
bool GeometryCache::isSame(BufferSignature& then, BufferSignature& now)
{
    if (then == now)
    {
        now.contents = then.contents;
        return true;
    }
    BufferSignature values = now;
    values.modified = then.modified;
    values.data = then.data;
    if (!(values == then)) return false;
    if (!now.contents) now.contents = contentsHash(*now.buffer);
    if (then.contents != now.contents) return false;
    then = now;
    return true;
}

/// Compares all buffers, including those behind the first difference, so that the contents of all
/// modified buffers are known the next time.
bool GeometryCache::isSame(GeometrySignature& then, GeometrySignature& now)
{
    if (then.size() != now.size()) return false;
    bool same = true;
    for (std::size_t i = 0; i < then.size(); ++i)
        same &= isSame(then[i], now[i]);
    return same;
}

GeometryCache::BufferSignature GeometryCache::signatureOf(const osg::BufferData* buffer,
                                                          unsigned int kind)
{
    BufferSignature bufferSignature;
    bufferSignature.buffer = buffer;
    bufferSignature.kind = kind;
    if (!buffer) return bufferSignature;
    bufferSignature.modified = buffer->getModifiedCount();
    bufferSignature.data = buffer->getDataPointer();
    bufferSignature.bytes = buffer->getTotalDataSize();
    return bufferSignature;
}

GeometryCache::GeometrySignature GeometryCache::signatureOf(const osg::Geometry& geometry)
{
    GeometrySignature signature;
    signature.reserve(kPrimitives + geometry.getNumPrimitiveSets());
    const auto add = [&signature](const osg::BufferData* buffer,
                                  unsigned int kind) -> BufferSignature&
    { return signature.emplace_back(signatureOf(buffer, kind)); };
    // The order is that of the indices above.
    for (const osg::Array* array :
         {positionArray(geometry), geometry.getNormalArray(), geometry.getColorArray(),
          geometry.getTexCoordArray(0), geometry.getTexCoordArray(1), tangentArray(geometry)})
        add(array, static_cast<unsigned int>(osg::getBinding(array)));
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
    {
        const osg::PrimitiveSet* set = geometry.getPrimitiveSet(i);
        if (!set) continue;
        BufferSignature& bufferSignature = add(set, set->getMode());
        // Sets without triangles may lack the indices that they count.
        if (hasTriangles(*set)) bufferSignature.count = set->getNumIndices();
        bufferSignature.ranges = rangesHash(*set);
    }
    const unsigned int units = std::min(geometry.getNumTexCoordArrays(), kUvSets);
    for (unsigned int unit = kFirstMoreUvs; unit < units; ++unit)
        add(geometry.getTexCoordArray(unit),
            static_cast<unsigned int>(osg::getBinding(geometry.getTexCoordArray(unit))));
    return signature;
}

const GeometryCache::Entry* GeometryCache::find(const osg::Geometry& geometry) const
{
    const auto found = _entries.find({&geometry, kOwnVariant});
    if (found == _entries.end()) return nullptr;
    return found->second.geometry.get() == &geometry ? &found->second : nullptr;
}

GeometryCache::Entry* GeometryCache::find(const osg::Geometry& geometry)
{
    return const_cast<Entry*>(std::as_const(*this).find(geometry));
}

const MeshRequest* GeometryCache::lastRequest(const osg::Geometry& geometry) const
{
    const Entry* entry = find(geometry);
    return entry ? &entry->request : nullptr;
}

const ConversionCounts& GeometryCache::lastCounts(const osg::Geometry& geometry) const
{
    static const NeverDestroyed<ConversionCounts> none;
    const Entry* entry = find(geometry);
    return entry ? entry->counts : *none;
}

bool GeometryCache::hasSameArrays(const osg::Geometry& geometry)
{
    Entry* entry = find(geometry);
    if (!entry) return false;
    GeometrySignature now = signatureOf(geometry);
    if (!isSame(entry->signature, now)) return false;
    entry->same = _stamp;
    return true;
}

bool GeometryCache::isCurrent(const osg::Geometry& geometry)
{
    const Entry* entry = find(geometry);
    return entry && entry->variance == geometry.getDataVariance() && hasSameArrays(geometry);
}

Mobility GeometryCache::mobility(const osg::Geometry& geometry) const
{
    const auto found = _mobility.find(&geometry);
    if (found == _mobility.end() || found->second.geometry != &geometry) return Mobility::Static;
    return found->second.mobility;
}

void GeometryCache::recordMobility(const osg::Geometry& geometry, Mobility mobility)
{
    if (mobility == Mobility::Static) return;
    MobilityEntry& known = _mobility[&geometry];
    if (known.geometry != &geometry) known = {&geometry, Mobility::Static};
    known.mobility = std::max(known.mobility, mobility);
}

/// Returns the arrays of the last mesh that can be kept, because as a rule positions alone have
/// changed. Nothing is kept if values were repaired, which may have been by positions, or if
/// vertices were split, which is by primitive sets: counts or sizes show both.
KeptArrays GeometryCache::keptArrays(Entry& before, GeometrySignature& now)
{
    KeptArrays kept;
    GeometrySignature& then = before.signature;
    if (!before.counts.empty() || then.size() != now.size()) return kept;
    for (std::size_t i = kPrimitives; i < then.size(); ++i)
        if (!isSame(then[i], now[i])) return kept;
    kept.moreUvs = before.mesh->moreUvs;
    if (isSame(then[kNormals], now[kNormals])) kept.normals = before.mesh->normals;
    if (isSame(then[kColors], now[kColors])) kept.colors = before.mesh->colors;
    if (isSame(then[kUvs], now[kUvs]))
    {
        kept.uvs = before.mesh->uvs;
        kept.rs = before.mesh->rs;
    }
    if (isSame(then[kUvs1], now[kUvs1]))
    {
        kept.uvs1 = before.mesh->uvs1;
        kept.rs1 = before.mesh->rs1;
    }
    return kept;
}

std::shared_ptr<const Mesh> GeometryCache::mesh(const osg::Geometry& geometry, uint32_t variant,
                                                const MeshRequest& request, const std::string& path,
                                                ConversionReport& report)
{
    Entry& entry = _entries[{&geometry, variant}];
    const bool had = entry.used != 0 && entry.geometry.get() == &geometry;
    GeometrySignature signature;
    bool sameArrays = had && entry.same == _stamp;
    if (!sameArrays)
    {
        signature = signatureOf(geometry);
        sameArrays = had && isSame(entry.signature, signature);
    }
    const bool known =
        sameArrays && entry.variance == geometry.getDataVariance() && entry.request == request;
    if (!known)
    {
        if (signature.empty()) signature = entry.signature;
        const bool other = had && !sameArrays;
        const bool kept = other && entry.mesh && entry.request == request && request.copies;
        ConvertedMesh converted =
            convertGeometry(geometry, request, kept ? keptArrays(entry, signature) : KeptArrays());
        if (converted.mesh)
        {
            converted.mesh->name = path;
            converted.mesh->changed = _stamp;
            converted.mesh->deforms = request.copies;
            if (other && entry.mesh && request.copies && entry.request.copies)
                shareTriangles(*converted.mesh, *entry.mesh);
        }
        if (other && entry.signature[kPositions].buffer != signature[kPositions].buffer)
            dropBounds(entry.signature[kPositions]);
        ++_converted;
        warnAboutGeometry(path, converted.counts);
        entry = {&geometry, geometry.getDataVariance(), std::move(signature),
                 request,   std::move(converted.mesh),  std::move(converted.counts),
                 0};
    }
    entry.used = _stamp;
    report.add(entry.counts);
    return entry.mesh;
}

const VertexBounds& GeometryCache::bounds(const osg::Geometry& geometry)
{
    static const VertexBounds none;
    const osg::Array* array = positionArray(geometry);
    if (!isReadable(array)) return none;

    BoundsEntry& entry = _bounds[array];
    const BufferSignature positions =
        signatureOf(array, static_cast<unsigned int>(array->getDataType()));
    if (entry.used == 0 || !(entry.positions == positions))
    {
        entry.positions = positions;
        entry.bounds = vertexBounds(*array);
    }
    entry.used = _stamp;
    return entry.bounds;
}

/// Drops the bounds of an array that was exchanged. Other geometries that have the array get its
/// bounds again. Bounds that this snapshot has used stay, as references to them may be in use.
void GeometryCache::dropBounds(const BufferSignature& positions)
{
    if (!positions.buffer) return;
    const auto known = _bounds.find(positions.buffer->asArray());
    if (known != _bounds.end() && known->second.used != _stamp) _bounds.erase(known);
}

/// Drops the geometry's shared mesh. No use of the geometry has a variant of its own when this is
/// called, or such variants are forgotten with the next conversion.
void GeometryCache::drop(const osg::Geometry* geometry)
{
    const auto entry = _entries.find({geometry, kOwnVariant});
    if (entry != _entries.end())
    {
        if (!entry->second.signature.empty())
        {
            const osg::BufferData* positions = entry->second.signature[kPositions].buffer.get();
            if (positions) _bounds.erase(positions->asArray());
        }
        _entries.erase(entry);
    }
    _mobility.erase(geometry);
}

void GeometryCache::end()
{
    for (auto entry = _bounds.begin(); entry != _bounds.end();)
        entry = entry->second.used == _stamp ? std::next(entry) : _bounds.erase(entry);
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.used == _stamp ? std::next(entry) : _entries.erase(entry);
    for (auto live = _mobility.begin(); live != _mobility.end();)
        live = _entries.count({live->first, kOwnVariant}) ? std::next(live) : _mobility.erase(live);
}

} // namespace osgRayTrace::engine
