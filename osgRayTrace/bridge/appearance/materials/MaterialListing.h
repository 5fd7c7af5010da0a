// MaterialListing.h - the materials of a scene graph as a material file. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <cstddef>
#include <string>

namespace osgRayTrace::engine
{

struct MaterialListing
{
    std::string text;         ///< material file, see MaterialLibrary.h
    std::size_t entries = 0;  ///< entries of the file
    std::size_t nameless = 0; ///< geometries that no entry fits
    bool complete = true;     ///< false: parts were left out, see listMaterials
};

/// Returns a material file with an entry for each material of the geometries below a node, whether
/// they are shown or not. Entries edit with the values that are there already, so that nothing
/// changes before somebody changes the file. Its values are left out if an entry fits geometries
/// with different ones.
///
/// An entry is named after the osg::Material; if that has no name, after the image file of the
/// texture on unit 0; if there is none, after the nearest node above the geometry with a name, or
/// the geometry itself. A node's name does not serve if geometry below it has one of the other
/// names, because entries of nodes win. Names that are no UTF-8 or have a "*" do not serve.
///
/// A node counts once for each state and chain of names that it is met below. What is beyond
/// mostVisits, as in conversions, or deeper than 5000 nodes is left out.
MaterialListing listMaterials(osg::Node& scene, std::size_t mostVisits = std::size_t(1) << 22);

} // namespace osgRayTrace::engine
