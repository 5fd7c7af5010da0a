// MeshoptView.cpp - calls meshoptimizer's decoders. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/MeshoptView.h"

#include <meshoptimizer.h>

namespace osgRayTrace::gltf
{

namespace
{

/// Returns whether the bytes could be decoded.
bool decode(const std::string& compressed, const MeshoptLayout& layout, std::string& to)
{
    const auto* from = reinterpret_cast<const unsigned char*>(compressed.data());
    const std::size_t size = compressed.size();
    switch (layout.mode)
    {
    case MeshoptLayout::Mode::Attributes:
        return meshopt_decodeVertexBuffer(to.data(), layout.count, layout.stride, from, size) == 0;
    case MeshoptLayout::Mode::Triangles:
        return meshopt_decodeIndexBuffer(to.data(), layout.count, layout.stride, from, size) == 0;
    case MeshoptLayout::Mode::Indices:
        return meshopt_decodeIndexSequence(to.data(), layout.count, layout.stride, from, size) == 0;
    }
    return false;
}

void undoFilter(const MeshoptLayout& layout, std::string& bytes)
{
    switch (layout.filter)
    {
    case MeshoptLayout::Filter::None:
        return;
    case MeshoptLayout::Filter::Octahedral:
        return meshopt_decodeFilterOct(bytes.data(), layout.count, layout.stride);
    case MeshoptLayout::Filter::Quaternion:
        return meshopt_decodeFilterQuat(bytes.data(), layout.count, layout.stride);
    case MeshoptLayout::Filter::Exponential:
        return meshopt_decodeFilterExp(bytes.data(), layout.count, layout.stride);
    }
}

} // namespace

bool readsMeshopt()
{
    return true;
}

std::string decodeMeshopt(const std::string& compressed, const MeshoptLayout& layout,
                          const JsonPlace& place)
{
    std::string bytes(layout.count * layout.stride, '\0');
    if (layout.count == 0) return bytes;
    if (!decode(compressed, layout, bytes)) place.refuse("is damaged: it cannot be decoded");
    undoFilter(layout, bytes);
    return bytes;
}

} // namespace osgRayTrace::gltf
