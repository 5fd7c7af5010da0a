// ReportScene.h - what the report measures: a scene, how to trace it, what is right. Layer: apps.
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

/// An algorithm with all its options but the seed.
struct Method
{
    std::string name;
    engine::RenderOptions options;
};

/// Where the scene lies in the world: a rigid transform of it and of the camera.
struct Placement
{
    std::string name;
    osg::Matrixd worldFromScene;
};

/// Radiance along a ray from the origin, in scene coordinates. The direction is not unit.
using Formula = std::function<osg::Vec3d(const osg::Vec3d& origin, const osg::Vec3d& direction)>;

/// Means over the pixels of a picture of this size, linear RGB, row 0 at the bottom.
using PictureFormula =
    std::function<std::vector<double>(int width, int height, const engine::Workers& workers)>;

struct ReportScene
{
    std::string name;  ///< of files and rows
    std::string title; ///< for people
    osg::ref_ptr<osg::Node> graph;
    osg::Matrixd view; ///< scene coordinates
    osg::Matrixd projection;
    double aspect = 1.0; ///< width / height
    osg::Vec4 clearColor{0.0f, 0.0f, 0.0f, 1.0f};
    bool headlight = false; ///< of osgViewer
    engine::LightSizes lightSizes;
    std::vector<Method> methods;       ///< those that are right for it
    std::vector<Placement> placements; ///< the first is the scene itself
    Formula formula;                   ///< empty: see pictureFormula
    int formulaNodes = 4;              ///< of Gauss's quadrature, along each side of a pixel
    PictureFormula pictureFormula;     ///< empty as well: the reference is rendered
    Method reference;                  ///< of a rendered one
    int referencePhotons = 1; ///< times those of the methods: its radii are smaller by more
    bool quick = true;        ///< part of a quick report
};

Placement atOrigin();
Placement displaced(); ///< by 6378137 along x: the earth's radius in metres

/// Direct light by all four strategies, 16 samples a hit and pass, and by path tracing cut after
/// one bounce.
std::vector<Method> directMethods();

/// Path tracing with this many edges after the camera ray.
Method pathMethod(int maxBounces);

/// One strategy.
Method whittedMethod(engine::LightSampling strategy, int lightSamples);

/// PPM, SPPM and, if the scene holds what makes caustics, PHOTON_CAUSTICS with this many edges
/// after the camera ray.
std::vector<Method> photonMethods(int maxBounces, bool caustics);

/// Whether its mean differs from what is right by the width of its kernel, less and less from pass
/// to pass.
bool hasKernel(const Method& method);

/// All that there are, the ones with formulas first. A new scene is one function and one line.
std::vector<ReportScene> reportScenes();

} // namespace osgRayTrace::bench
