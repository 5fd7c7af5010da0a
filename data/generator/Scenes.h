// Scenes.h - our own scenes; data/README.md says where each comes from. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

#include <string>

namespace osgRayTrace::data
{

enum class CornellVariant
{
    Diffuse,     ///< as published
    MirrorFloor, ///< floor and tall block are mirrors [McCarthy17, fig. 4]
    TallMirror,  ///< the tall block is a mirror
    GlassSphere, ///< a glass sphere in place of both blocks
};

osg::ref_ptr<osg::Group> cornellBox(CornellVariant variant);

/// Lattices between an area light and a floor [McCarthy17, fig. 1-3].
osg::ref_ptr<osg::Group> grids();

/// Three metal rings on a table, their caustics seen directly and in a looking-glass
/// [McCarthy17, fig. 6]. Centimetres, z up.
osg::ref_ptr<osg::Group> rings();

/// A glass sphere and a glass of water in a box, under a small lamp. Centimetres, z up.
osg::ref_ptr<osg::Group> glasses();

/// An upright prism of glass in the beam of a spot light. Centimetres, z up.
osg::ref_ptr<osg::Group> prism();

/// Balls of chrome, glass, plaster and rough gold on a terrace below sky.exr. Metres, z up.
osg::ref_ptr<osg::Group> terrace();

/// The sky of it: 128 x 64 pixels, one of which is the sun, with half of the light. Returns what is
/// wrong, or nothing.
std::string writeSky(const std::string& path);

/// A closed room whose walls all emit 1/2 and reflect 1/2: seen from within, radiance is 1
/// everywhere.
osg::ref_ptr<osg::Group> furnace();

} // namespace osgRayTrace::data
