// ScaledScene.h - one scene graph at any place and size, and its pictures. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Renderer>

#include <osg/Group>

#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// What the vertices are stored as.
enum class Storage
{
    Local,  ///< floats of about 1 below one transform that has scale and offset
    Float,  ///< scale and offset are in the vertices
    Double, ///< the same, in double arrays
};

/// p becomes scale * p + offset. Attenuation, camera and clipping planes go with it.
struct Placement
{
    double scale = 1.0;
    osg::Vec3d offset;
    Storage storage = Storage::Local;
    bool attenuated = true; ///< else lights without attenuation: its coefficients are floats in OSG
};

/// A floor, two turned boxes that share a geometry and a smooth ball, lit by the sun, a point
/// light, a spot and a point light in eye space: OpenGL's materials.
osg::ref_ptr<osg::Group> classicScene(const Placement& placement);

/// The same bodies of white, metal and glass, with an area light and an emitting panel.
osg::ref_ptr<osg::Group> physicalScene(const Placement& placement);

/// Where the camera is before it is placed.
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

/// Null images stay empty: see statistics.
Picture pictureOf(osg::Node& scene, const Placement& placement, const Recipe& recipe);

/// mean((x - r)^2 / (r^2 + 0.01)) over the pixels' RGB.
double relativeMse(const Picture& picture, const Picture& reference);

/// Largest |x - r| / max(r, 0.01) of the pixels' RGB.
double largestDifference(const Picture& picture, const Picture& reference);

bool allFinite(const std::vector<float>& values);

} // namespace osgRayTrace::test
