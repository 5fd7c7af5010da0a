// Surfaces.h - the few building blocks of our own scenes. Part of the scene generator.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <osg/CameraView>
#include <osg/Geode>
#include <osg/Group>
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

/// Mirror-like, of this colour.
osg::ref_ptr<PhysicalMaterial> metal(const osg::Vec3& color);

/// What the rasterizer shows: the base colour, brighter on faces that look up or to the viewer's
/// left.
osg::ref_ptr<osg::Material> rasterMaterial(const PhysicalMaterial& physical,
                                           const osg::Vec3& normal);

/// The quads with the material. Each has an osg::Material as well, so that it can be told from its
/// neighbours when rasterized without any light.
osg::ref_ptr<osg::Geode> surface(const std::string& name, const std::vector<Quad>& quads,
                                 PhysicalMaterial* material);

/// Finely tessellated, with smooth normals.
osg::ref_ptr<osg::Geode> sphere(const std::string& name, const osg::Vec3& center, float radius,
                                PhysicalMaterial* material);

/// A point of a profile that is turned around the z axis, and the normal there.
struct ProfilePoint
{
    double radius, z;
    double outwards, up; ///< unit normal
};

/// The profile around an upright axis through base: columns facets with smooth normals. Going along
/// it, what the normals point to lies on the right.
osg::ref_ptr<osg::Geode> turned(const std::string& name, const std::vector<ProfilePoint>& profile,
                                const osg::Vec3d& base, int columns, PhysicalMaterial* material);

/// Adds an arc of a circle around (radius, z): from angle to angle above the outward direction
/// [degrees]. Its normals point away from the centre, or to it if the size is negative.
void addArc(std::vector<ProfilePoint>& profile, double radius, double z, double size,
            double fromDegrees, double toDegrees, int steps);

/// The six sides of a box along the axes.
std::vector<Quad> boxQuads(const osg::Vec3& low, const osg::Vec3& high);

/// A view of a scene, in the coordinates that its content is described in.
struct SceneView
{
    osg::Vec3d eye;
    osg::Vec3d center; ///< the middle of what is to be seen
    osg::Vec3d up;
    double fovyDegrees = 0.0; ///< vertical
};

/// An empty scene on a black background that area lights and emission alone light: osgviewer's
/// headlight is off, and the rasterizer shows the materials' ambient colours.
osg::ref_ptr<osg::Group> newGraph(const std::string& name);

/// The same for a file that viewers open.
///
/// stored: where osgraytrace and osgraytraceviewer look from unless they are told otherwise.
/// home: what a viewer shows that knows of no stored view, as osgviewer. The home position of
/// osgGA's trackball looks along +y, with z up, at the middle of the scene's bound, so the scene is
/// turned to that, and its bound is stored: a sphere around the view's centre, as large as what the
/// view shows there, from which the trackball's distance follows. The content may be larger; it is
/// not culled by that bound.
osg::ref_ptr<osg::MatrixTransform> newScene(const std::string& name, const SceneView& stored,
                                            const SceneView& home);

} // namespace osgRayTrace::data
