// SurfaceReader.h - the state sets of glTF materials. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/GltfSurface.h"
#include "osgPlugins/gltf/MaterialValues.h"

#include <map>
#include <tuple>

namespace osgRayTrace::gltf
{

class SurfaceReader
{
public:
    explicit SurfaceReader(Document& document) : _document(&document), _textures(document) {}

    /// Returns the surface of a material, or of glTF's default material. Primitives that use one
    /// material alike share the state set.
    const Surface& read(std::optional<std::size_t> material, const SurfaceUse& use);

private:
    const MaterialValues& valuesOf(std::optional<std::size_t> material);

    Document* _document;
    TextureReader _textures;
    std::map<std::size_t, MaterialValues> _values; ///< SIZE_MAX: the default material
    std::map<std::tuple<std::size_t, bool, bool>, Surface> _surfaces;
};

} // namespace osgRayTrace::gltf
