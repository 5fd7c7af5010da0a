// BenchScenes.h - the scenes that are measured, made by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/View.h"

#include <osg/Geometry>
#include <osg/ref_ptr>

#include <memory>

namespace osgRayTrace::bench
{

struct BenchScene
{
    std::shared_ptr<const engine::Scene> scene;
    engine::View view; ///< the scene fills the view
};

/// Returns the Cornell box from its published measurements, diffuse, seen from within so that it
/// fills a frame of any aspect ratio.
BenchScene cornellBox(int width, int height);

/// Returns a sphere of about a million triangles, displaced by waves, under an area light, seen so
/// that it fills the frame.
BenchScene displacedSphere(int width, int height);

/// Returns the geometry of displacedSphere: indexed triangles with vertex normals.
osg::ref_ptr<osg::Geometry> displacedSphereGeometry();

} // namespace osgRayTrace::bench
