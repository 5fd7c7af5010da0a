// Surfaces.h - the few building blocks of our own scenes. Part of the scene generator.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <osg/CameraView>
#include <osg/Geode>
#include <osg/Group>
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

/// The quads with the material. Each has an osg::Material as well, so that it can be told from its
/// neighbours when rasterized without any light.
osg::ref_ptr<osg::Geode> surface(const std::string& name, const std::vector<Quad>& quads,
                                 PhysicalMaterial* material);

/// Finely tessellated, with smooth normals.
osg::ref_ptr<osg::Geode> sphere(const std::string& name, const osg::Vec3& center, float radius,
                                PhysicalMaterial* material);

/// The six sides of a box along the axes.
std::vector<Quad> boxQuads(const osg::Vec3& low, const osg::Vec3& high);

/// Where osgraytrace and osgraytraceviewer look from unless they are told otherwise.
osg::ref_ptr<osg::CameraView> storedView(const osg::Vec3d& eye, const osg::Vec3d& center,
                                         const osg::Vec3d& up, double fovyDegrees);

/// An empty scene on a black background that area lights and emission alone light: osgviewer's
/// headlight is off, and the rasterizer shows the materials' ambient colours.
osg::ref_ptr<osg::Group> newScene(const std::string& name);

} // namespace osgRayTrace::data
