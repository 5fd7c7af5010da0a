// Scenes.h - our own scenes, whose sources data/README.md names. Part of the scene generator.
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
    Fog,         ///< as published, in fog through which half of the light crosses the box
};

osg::ref_ptr<osg::Group> cornellBox(CornellVariant variant);

/// Returns lattices between an area light and a floor [McCarthy17, fig. 1-3].
osg::ref_ptr<osg::Group> grids();

/// Returns three metal rings on a table, with caustics seen directly and in a looking-glass
/// [McCarthy17, fig. 6]. Lengths are centimetres, z is up. roughness: of the rings.
osg::ref_ptr<osg::Group> rings(double roughness = 0.0);

/// Returns a glass sphere and a glass of water in a box, under a small lamp. Lengths are
/// centimetres, z is up.
osg::ref_ptr<osg::Group> glasses();

/// Returns glasses of thin milk and of a golden drink, and a piece of wax, under a large lamp. The
/// drinks reach into the walls of their glasses, whose priority is higher. Lengths are centimetres,
/// z is up.
osg::ref_ptr<osg::Group> drinks();

/// Returns a column of smoke above a table in the light of a low sun: a tile of osgVolume whose
/// voxels are densities. Lengths are metres.
osg::ref_ptr<osg::Group> smoke();

/// Returns a bust of wax, light that enters its diffuse surface, with a lamp behind it. Lengths are
/// centimetres, z is up.
osg::ref_ptr<osg::Group> waxBust();

/// Returns a dark room full of haze, into which a low sun shines through a window of coloured
/// panes. Lengths are metres, z is up.
osg::ref_ptr<osg::Group> hazeWindow();

/// Returns a valley with a church in it, and fog that thins out with height in the light of a low
/// sun. Lengths are metres, z is up.
osg::ref_ptr<osg::Group> valleyFog();

/// Returns a glass ball in fog, in the cone of a spot light that it gathers behind itself. Lengths
/// are metres, z is up.
osg::ref_ptr<osg::Group> glassBallFog();

/// Returns an upright prism of glass in the beam of a spot light. Lengths are centimetres, z is up.
osg::ref_ptr<osg::Group> prism();

/// Returns balls of chrome, glass, plaster and rough gold on a terrace below sky.exr. Lengths are
/// metres, z is up.
osg::ref_ptr<osg::Group> terrace();

/// Writes the sky of the terrace: 128 x 64 pixels, one of which is the sun, with half of the light.
/// Returns what is wrong; empty: nothing.
std::string writeSky(const std::string& path);

/// Returns a closed room whose walls all emit 1/2 and reflect 1/2: seen from within, radiance is 1
/// everywhere.
osg::ref_ptr<osg::Group> furnace();

} // namespace osgRayTrace::data
