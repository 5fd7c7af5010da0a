// Surfaces.h - the few building blocks of our own scenes. Part of the scene generator.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <osg/CameraView>
#include <osg/Geode>
#include <osg/Group>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Vec3>

#include <array>
#include <string>
#include <vector>

namespace osgRayTrace::data
{

using Quad = std::array<osg::Vec3, 4>;

osg::ref_ptr<PhysicalMaterial> lambert(const osg::Vec3& albedo);
osg::ref_ptr<PhysicalMaterial> mirror();
osg::ref_ptr<PhysicalMaterial> glass(float ior);

/// Returns a mirror-like material of this colour.
osg::ref_ptr<PhysicalMaterial> metal(const osg::Vec3& color);

/// Returns the material for the rasterizer: the base colour, brighter on faces that look up or to
/// the viewer's left.
osg::ref_ptr<osg::Material> rasterMaterial(const PhysicalMaterial& physical,
                                           const osg::Vec3& normal);

/// Returns the quads with the material. Each quad has an osg::Material as well, so that it can be
/// told from its neighbours when rasterized without any light.
osg::ref_ptr<osg::Geode> surface(const std::string& name, const std::vector<Quad>& quads,
                                 PhysicalMaterial* material);

/// Returns a finely tessellated sphere with smooth normals.
osg::ref_ptr<osg::Geode> sphere(const std::string& name, const osg::Vec3& center, float radius,
                                PhysicalMaterial* material);

/// Holds a point of a profile that is turned around the z axis, and its normal.
struct ProfilePoint
{
    double radius, z;
    double outwards, up; ///< unit normal
};

/// Returns the profile turned around an upright axis through base: columns facets with smooth
/// normals. Seen along the profile, the normals point to the right.
osg::ref_ptr<osg::Geode> turned(const std::string& name, const std::vector<ProfilePoint>& profile,
                                const osg::Vec3d& base, int columns, PhysicalMaterial* material);

/// Adds an arc of a circle around (radius, z): from angle to angle above the outward direction
/// [degrees]. Its normals point away from the centre, or to it if the size is negative.
void addArc(std::vector<ProfilePoint>& profile, double radius, double z, double size,
            double fromDegrees, double toDegrees, int steps);

/// Returns the six sides of a box along the axes.
std::vector<Quad> boxQuads(const osg::Vec3& low, const osg::Vec3& high);

/// Returns the light of a sun in a direction, without ambient and specular light.
osg::ref_ptr<osg::LightSource> sun(const osg::Vec3& towards, const osg::Vec3& color);

/// Describes a view of a scene, in the coordinates of the scene's content.
struct SceneView
{
    osg::Vec3d eye;
    osg::Vec3d center; ///< middle of the visible content
    osg::Vec3d up;
    double fovyDegrees = 0.0; ///< vertical [degrees]
};

/// Returns an empty scene on a black background that area lights and emission alone light:
/// osgviewer's headlight is off, and the rasterizer shows the materials' ambient colours.
osg::ref_ptr<osg::Group> newGraph(const std::string& name);

/// Returns an empty scene for a file that viewers open.
///
/// stored: the view of osgraytrace and osgraytraceviewer unless they are told otherwise. home: the
/// view of a viewer that knows of no stored view, as osgviewer. The home position of osgGA's
/// trackball looks along +y, with z up, at the middle of the scene's bound, so the scene is turned
/// to that. The scene's bound is stored: a sphere around the view's centre, as large as the part
/// that the view shows there, from which the trackball's distance follows. The content may be
/// larger; it is not culled by that bound.
osg::ref_ptr<osg::MatrixTransform> newScene(const std::string& name, const SceneView& stored,
                                            const SceneView& home);

} // namespace osgRayTrace::data
