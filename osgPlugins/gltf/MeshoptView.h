// MeshoptView.h - bufferViews of EXT_meshopt_compression, decoded by meshoptimizer. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

namespace osgRayTrace::gltf
{

/// Returns whether the library is built in.
bool readsMeshopt();

/// How a bufferView is compressed, checked: count * stride are the bytes of the view.
struct MeshoptLayout
{
    enum class Mode
    {
        Attributes,
        Triangles,
        Indices
    };
    enum class Filter
    {
        None,
        Octahedral,
        Quaternion,
        Exponential
    };

    Mode mode = Mode::Attributes;
    Filter filter = Filter::None;
    std::size_t count = 0;
    std::size_t stride = 0; ///< [bytes]
};

/// Returns the layout of a bufferView's extension. Throws GltfError if the format does not allow
/// it.
MeshoptLayout meshoptLayout(const JsonPlace& extension, std::uint64_t viewBytes);

/// Returns count * stride bytes. Throws GltfError with the place if the bytes are damaged.
std::string decodeMeshopt(const std::string& compressed, const MeshoptLayout& layout,
                          const JsonPlace& place);

} // namespace osgRayTrace::gltf
