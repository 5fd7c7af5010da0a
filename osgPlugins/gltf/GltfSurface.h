// GltfSurface.h - what a primitive is drawn with. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateSet>
#include <osg/Vec4>

#include <vector>

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
    bool usesTangents = false; ///< a normal map or anisotropy, which rays follow

    /// The unit of a texture of OpenGL's that is not the unit of its UV set: the geometry puts the
    /// set into this unit, too, in place of a set that the material does not use.
    struct ExtraUnit
    {
        unsigned int unit, set;
    };
    std::vector<ExtraUnit> extraUnits;
};

} // namespace osgRayTrace::gltf
