// Transport.h - scenes that are hard for light transport, each with a size. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/Vec3d>

#include <vector>

namespace osgRayTrace::data
{

/// Returns two white spheres of radius 1 that a round port joins, whose cap is the share f of
/// either sphere. The lower one shines by itself. See portRadiance for the light in them.
osg::ref_ptr<osg::Group> twoSpheres(double f);

/// Holds the radiance within twoSpheres, which is even in each sphere.
struct PortRadiance
{
    double shining = 0.0, dark = 0.0;
};
PortRadiance portRadiance(double f);

/// Holds a lamp of lampField: a parallelogram in the plane z = 1 that shines down.
struct FieldLamp
{
    osg::Vec3d corner, edgeU, edgeV;
    double radiance = 0.0;
};
/// Returns lamps that do not hide each other, over the square of side 10 around the origin.
std::vector<FieldLamp> fieldLamps(int count);
constexpr double kFieldAlbedo = 0.5;
osg::ref_ptr<osg::Group> lampField(int count);

/// Returns two rooms and a door between them that is ajar: light of a lamp that is turned to the
/// ceiling comes through a slit of this width [m]. glossy: the seen room's floor is.
osg::ref_ptr<osg::Group> ajar(double slit, bool glossy);

enum class WindowKind
{
    Open,
    Pane, ///< a sheet without thickness, thin-walled
    Box,  ///< a box of glass of index 1.5, 1 cm thick
};
/// Returns a room with a window of this side [m] below a sky with a sun.
osg::ref_ptr<osg::Group> window(WindowKind kind, double side);

/// Returns streets between houses at night, under so many street lamps.
osg::ref_ptr<osg::Group> city(int lamps);

/// Returns water of depth 1 over a pale floor, below a sun of 0.53 degrees and a lamp. Its surface
/// is a sum of five sines of this height [m], with smooth normals.
osg::ref_ptr<osg::Group> pool(double waves);

/// Returns a chain of 40 rings of brushed metal of this roughness on dark cloth.
osg::ref_ptr<osg::Group> necklace(double roughness);

/// Returns four plates of roughness 0.005 to 0.3 times scale that mirror four lamps of equal power
/// [Veach97, fig. 9.2].
osg::ref_ptr<osg::Group> veachPlates(double scale);

/// Returns a room with a spot that lights the ceiling, a floor lamp and an egg of glass [Veach97,
/// fig. 10.2]. egg: length of the egg [m].
osg::ref_ptr<osg::Group> veachRoom(double egg);

} // namespace osgRayTrace::data
