// SurfaceReader.h - the state sets of glTF materials. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/MaterialValues.h"

#include <osg/StateSet>

#include <map>
#include <tuple>

namespace osgRayTrace::gltf
{

/// What a primitive has, on which its state depends.
struct SurfaceUse
{
    bool colors = false;  ///< colours of vertices
    bool normals = false; ///< without normals it is not lit
};

/// A material as state, for the rasterizer and the ray tracer.
struct Surface
{
    osg::ref_ptr<osg::StateSet> states;
    osg::Vec4 color{1.0f, 1.0f, 1.0f, 1.0f}; ///< linear factor of what is not lit
    bool lit = true;

    /// The unit of a texture whose UV set is in the unit of another texture: the geometry puts the
    /// set into this unit, too.
    struct ExtraUnit
    {
        unsigned int unit, set;
    };
    std::optional<ExtraUnit> extraUnit;
};

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
