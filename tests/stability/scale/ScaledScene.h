// ScaledScene.h - one scene graph at any place and size, and its pictures. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Renderer>

#include <osg/Group>

#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// How the vertices are stored.
enum class Storage
{
    Local,  ///< floats of about 1 below one transform that has scale and offset
    Float,  ///< scale and offset are in the vertices
    Double, ///< scale and offset are in the vertices, in double arrays
};

/// A point p becomes scale * p + offset. Attenuation, camera and clipping planes are changed alike.
struct Placement
{
    double scale = 1.0;
    osg::Vec3d offset;
    Storage storage = Storage::Local;
    bool attenuated = true; ///< OSG's coefficients of attenuation are floats
};

/// Returns a floor, two turned boxes that share a geometry, and a smooth ball, all of OpenGL's
/// materials, lit by the sun, a point light, a spot and a point light in eye space.
osg::ref_ptr<osg::Group> classicScene(const Placement& placement);

/// Returns the same bodies of white, metal and glass, with an area light and an emitting panel.
osg::ref_ptr<osg::Group> physicalScene(const Placement& placement);

/// These are the places of the camera and its target before placement.
extern const osg::Vec3d kEye, kTarget;
constexpr int kWidth = 60, kHeight = 40;
constexpr double kFovyDegrees = 45.0;

struct Picture
{
    Statistics statistics;
    std::vector<float> rgba; ///< 4 floats a pixel
    std::vector<float> depth, distance, position, normal, id;
};

struct Recipe
{
    RayTraceSettings::Integrator integrator = RayTraceSettings::WHITTED;
    int bounces = 4;
    int passes = 8;
};

/// Renders the scene. Channels of a failed render stay empty, as the statistics tell.
Picture pictureOf(osg::Node& scene, const Placement& placement, const Recipe& recipe);

/// Returns mean((x - r)^2 / (r^2 + 0.01)) over the pixels' RGB.
double relativeMse(const Picture& picture, const Picture& reference);

/// Returns the largest |x - r| / max(r, 0.01) of the pixels' RGB.
double largestDifference(const Picture& picture, const Picture& reference);

bool allFinite(const std::vector<float>& values);

} // namespace osgRayTrace::test
