// ReportScene.h - a scene of the report, its methods and its reference. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/appearance/lights/LightSizes.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"

#include <osg/Group>
#include <osg/Matrixd>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Describes an algorithm with all its options but the seed.
struct Method
{
    std::string name;
    engine::RenderOptions options;
};

/// Tells where the scene lies in the world: a rigid transform of scene and camera.
struct Placement
{
    std::string name;
    osg::Matrixd worldFromScene;
};

/// Returns the radiance along a ray from the origin, in scene coordinates. The direction is not
/// unit.
using Formula = std::function<osg::Vec3d(const osg::Vec3d& origin, const osg::Vec3d& direction)>;

/// Returns means over the pixels of a picture of this size, linear RGB, row 0 at the bottom.
using PictureFormula =
    std::function<std::vector<double>(int width, int height, const engine::Workers& workers)>;

struct ReportScene
{
    std::string name;  ///< name in files and rows
    std::string title; ///< title for people
    osg::ref_ptr<osg::Node> graph;
    osg::Matrixd view; ///< scene coordinates
    osg::Matrixd projection;
    double aspect = 1.0; ///< width / height
    osg::Vec4 clearColor{0.0f, 0.0f, 0.0f, 1.0f};
    bool headlight = false; ///< true: with osgViewer's headlight
    engine::LightSizes lightSizes;
    std::vector<Method> methods;       ///< methods that are right for the scene
    std::vector<Placement> placements; ///< the first is the scene itself
    Formula formula;                   ///< empty: see pictureFormula
    int formulaNodes = 4;              ///< nodes of Gauss's quadrature, along each side of a pixel
    PictureFormula pictureFormula;     ///< empty as formula is: the reference is rendered
    Method reference;                  ///< method of a rendered reference
    int referencePhotons = 1; ///< factor of the methods' photons: the reference's radii are smaller
    bool quick = true;        ///< true: part of a quick report
};

Placement atOrigin();
Placement displaced(); ///< moved by 6378137 along x: the earth's radius in metres

/// Returns direct light by all four strategies, 16 samples a hit and pass, and by path tracing cut
/// after one bounce.
std::vector<Method> directMethods();

/// Returns path tracing with this many edges after the camera ray.
Method pathMethod(int maxBounces);

/// Returns Whitted's method with one strategy.
Method whittedMethod(engine::LightSampling strategy, int lightSamples);

/// Returns PPM, SPPM and, if the scene holds objects that make caustics, PHOTON_CAUSTICS with this
/// many edges after the camera ray.
std::vector<Method> photonMethods(int maxBounces, bool caustics);

/// Returns whether the method's mean is biased by the width of its kernel, less and less from pass
/// to pass.
bool hasKernel(const Method& method);

/// Returns all scenes, the ones with formulas first. A new scene is one function and one line.
std::vector<ReportScene> reportScenes();

} // namespace osgRayTrace::bench
