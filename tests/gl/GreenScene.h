// GreenScene.h - a ray traced scene of one green square, and what is asked of its pictures. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"

namespace osgRayTrace::test
{

inline const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
inline const osg::Vec4 kGreenPixel(0, 255, 0, 255);
inline const osg::Vec4 kBlackPixel(0, 0, 0, 255);
constexpr int kSize = 64;
constexpr int kMiddle = kSize / 2;

inline osg::ref_ptr<RayTracedScene> greenScene()
{
    return tracedScene(unlitSquare(1.0f, kGreen).get());
}

/// Selects the debug channel of normals, which no rasterizer shows.
inline void showNormals(RayTracedScene& scene)
{
    scene.getSettings()->setIntegrator(RayTraceSettings::DEBUG);
}

inline int passes(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics().passes;
}

inline int countGreen(const osg::Image& image)
{
    int count = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            count += pixel(image, x, y) == kGreenPixel;
    return count;
}

} // namespace osgRayTrace::test
