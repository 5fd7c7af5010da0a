// GeometryCache.cpp - fingerprints of geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/GeometryCache.h"

#include "osgRayTrace/bridge/VertexArrays.h"

#include <tuple>

namespace osgRayTrace::engine
{

bool GeometryCache::BufferPrint::operator==(const BufferPrint& other) const
{
    const auto values = [](const BufferPrint& p) {
        return std::make_tuple(p.buffer.get(), p.modified, p.data, p.bytes, p.kind, p.count,
                               p.first);
    };
    return values(*this) == values(other);
}

GeometryCache::BufferPrint GeometryCache::printOf(const osg::BufferData* buffer, unsigned int kind)
{
    BufferPrint print;
    print.buffer = buffer;
    print.kind = kind;
    if (!buffer) return print;
    print.modified = buffer->getModifiedCount();
    print.data = buffer->getDataPointer();
    print.bytes = buffer->getTotalDataSize();
    return print;
}

GeometryCache::Fingerprint GeometryCache::fingerprintOf(const osg::Geometry& geometry)
{
    Fingerprint prints;
    const auto add = [&prints](const osg::BufferData* buffer, unsigned int kind) -> BufferPrint&
    { return prints.emplace_back(printOf(buffer, kind)); };
    for (const osg::Array* array : {positionArray(geometry), geometry.getNormalArray(),
                                    geometry.getColorArray(), geometry.getTexCoordArray(0),
                                    geometry.getTexCoordArray(1)})
        add(array, static_cast<unsigned int>(osg::getBinding(array)));
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
    {
        const osg::PrimitiveSet* set = geometry.getPrimitiveSet(i);
        if (!set) continue;
        BufferPrint& print = add(set, set->getMode());
        if (hasTriangles(*set)) print.count = set->getNumIndices(); // others may lack what they count
        if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(set))
            print.first = static_cast<unsigned int>(arrays->getFirst());
    }
    return prints;
}

std::shared_ptr<const Mesh> GeometryCache::mesh(const osg::Geometry& geometry, uint32_t variant,
                                                const MeshRequest& request, const std::string& path,
                                                ConversionReport& report)
{
    Entry& entry = _entries[{&geometry, variant}];
    Fingerprint fingerprint = fingerprintOf(geometry);
    const bool known = entry.used != 0 && entry.geometry.get() == &geometry &&
                       entry.variance == geometry.getDataVariance() && entry.request == request &&
                       entry.fingerprint == fingerprint;
    if (!known)
    {
        ConvertedMesh converted = convertGeometry(geometry, request);
        if (converted.mesh)
        {
            converted.mesh->name = path;
            converted.mesh->changed = _stamp;
        }
        warnAboutGeometry(path, converted.counts);
        entry = {&geometry, geometry.getDataVariance(), std::move(fingerprint),
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
    const BufferPrint positions = printOf(array, static_cast<unsigned int>(array->getDataType()));
    if (entry.used == 0 || !(entry.positions == positions))
    {
        entry.positions = positions;
        entry.bounds = vertexBounds(*array);
    }
    entry.used = _stamp;
    return entry.bounds;
}

void GeometryCache::end()
{
    for (auto entry = _bounds.begin(); entry != _bounds.end();)
        entry = entry->second.used == _stamp ? std::next(entry) : _bounds.erase(entry);
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.used == _stamp ? std::next(entry) : _entries.erase(entry);
}

} // namespace osgRayTrace::engine
