// MeshoptLayout.cpp - checks how a bufferView says that it is compressed. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/MeshoptView.h"

namespace osgRayTrace::gltf
{

namespace
{

using Mode = MeshoptLayout::Mode;
using Filter = MeshoptLayout::Filter;

constexpr std::uint64_t kMostCount = std::uint64_t(1) << 31;
constexpr std::uint64_t kLargestStride = 256;

Mode modeOf(const JsonPlace& place)
{
    const std::string& mode = place.text();
    if (mode == "ATTRIBUTES") return Mode::Attributes;
    if (mode == "TRIANGLES") return Mode::Triangles;
    if (mode == "INDICES") return Mode::Indices;
    place.refuse("is '" + mode + "'; ATTRIBUTES, TRIANGLES and INDICES are read");
}

Filter filterOf(const JsonPlace& extension)
{
    const std::string filter = extension.textOr("filter", "NONE");
    if (filter == "NONE") return Filter::None;
    if (filter == "OCTAHEDRAL") return Filter::Octahedral;
    if (filter == "QUATERNION") return Filter::Quaternion;
    if (filter == "EXPONENTIAL") return Filter::Exponential;
    extension.at("filter").refuse("is '" + filter + "', which is no filter of this extension");
}

/// Returns whether the extension allows elements of so many bytes.
bool allows(Mode mode, Filter filter, std::uint64_t stride)
{
    if (mode != Mode::Attributes) return filter == Filter::None && (stride == 2 || stride == 4);
    if (filter == Filter::Octahedral) return stride == 4 || stride == 8;
    if (filter == Filter::Quaternion) return stride == 8;
    return stride > 0 && stride <= kLargestStride && stride % 4 == 0;
}

} // namespace

MeshoptLayout meshoptLayout(const JsonPlace& extension, std::uint64_t viewBytes)
{
    MeshoptLayout layout;
    layout.mode = modeOf(extension.at("mode"));
    layout.filter = filterOf(extension);
    const std::uint64_t count = extension.at("count").whole();
    const std::uint64_t stride = extension.at("byteStride").whole();
    if (count > kMostCount) extension.at("count").refuse("is above 2^31");
    if (!allows(layout.mode, layout.filter, stride))
        extension.at("byteStride")
            .refuse("is " + std::to_string(stride) + ", which its mode and filter do not allow");
    if (layout.mode == Mode::Triangles && count % 3 != 0)
        extension.at("count").refuse("is no multiple of 3");
    if (count * stride != viewBytes)
        extension.at("count").refuse("makes " + std::to_string(count * stride) +
                                     " bytes, and the view has " + std::to_string(viewBytes));
    layout.count = static_cast<std::size_t>(count);
    layout.stride = static_cast<std::size_t>(stride);
    return layout;
}

} // namespace osgRayTrace::gltf
