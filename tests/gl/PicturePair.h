// PicturePair.h - one scene as OSG draws it and as it is traced, by the same viewer. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/MatrixTransform>
#include <osgDB/WriteFile>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

namespace osgRayTrace::test
{

constexpr int kPairWidth = 320, kPairHeight = 240;
constexpr int kPairSamples =
    4; ///< a pixel and axis, of the rasterized picture: the traced one is antialiased

struct PicturePair
{
    osg::ref_ptr<osg::Image> rasterized, traced;
    Statistics statistics;
    double difference = 0.0; ///< mean over all pixels, 0 to 255
    double worst = 0.0;      ///< largest mean of 8 x 8 pixels: finds a cluster that is wrong
    long covered = 0;        ///< pixels of the rasterized picture that are not background

    uint64_t count(const std::string& what) const
    {
        const auto found = statistics.conversion.find(what);
        return found == statistics.conversion.end() ? 0 : found->second;
    }
};

inline double worstTile(const osg::Image& a, const osg::Image& b)
{
    double worst = 0.0;
    for (int y0 = 0; y0 < kPairHeight; y0 += 8)
        for (int x0 = 0; x0 < kPairWidth; x0 += 8)
            worst = std::max(worst, meanDifference(a, b,
                                                   [&](int x, int y) {
                                                       return x >= x0 && x < x0 + 8 && y >= y0 &&
                                                              y < y0 + 8;
                                                   }));
    return worst;
}

using SceneMaker = std::function<osg::ref_ptr<osg::Node>()>;

/// Makes OpenGL light by normals of unit length, as tracing does: OpenGL's own lengths depend on
/// how a transform scales them.
inline void normalize(TestViewer& view)
{
    view.camera().getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
}

/// Returns both pictures of frame number `frames`, by which OSG has prepared, loaded and animated
/// the scene. The pictures are of two scenes made alike, because a viewer changes its scene: images
/// are released, and particles keep the time. Shadows are off. If OSGRAYTRACE_TEST_PICTURES names a
/// folder, both pictures are written there.
inline PicturePair picturePair(const std::string& name, const SceneMaker& makeScene,
                               const std::function<void(TestViewer&)>& setUp, int frames = 3)
{
    PicturePair pair;
    {
        TestViewer view(kPairWidth * kPairSamples, kPairHeight * kPairSamples, makeScene().get());
        view.camera().setClearColor(osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
        setUp(view);
        for (int i = 0; i < frames; ++i)
            view.viewer.frame(0.1 * i);
        pair.rasterized = reduced(*view.frames(0), kPairSamples);
    }
    osg::ref_ptr<RayTracedScene> traced = tracedScene(makeScene().get());
    traced->getSettings()->setPassesPerFrame(1);
    TestViewer view(kPairWidth, kPairHeight, traced.get());
    view.camera().setClearColor(osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
    setUp(view);
    for (int i = 0; i < frames; ++i)
    {
        if (i == frames - 1) traced->getSettings()->setPassesPerFrame(64);
        view.viewer.frame(0.1 * i);
    }
    pair.traced = view.frames(0);
    pair.statistics = traced->getDrawable()->getStatistics();

    pair.difference = meanDifference(*pair.rasterized, *pair.traced);
    pair.worst = worstTile(*pair.rasterized, *pair.traced);
    const osg::Vec4 background(51, 51, 102, 255);
    for (int y = 0; y < kPairHeight; ++y)
        for (int x = 0; x < kPairWidth; ++x)
            pair.covered += (pixel(*pair.rasterized, x, y) - background).length() > 3.0f;
    if (const char* folder = std::getenv("OSGRAYTRACE_PICTURES"))
    {
        osgDB::writeImageFile(*pair.rasterized, std::string(folder) + "/" + name + "-osg.png");
        osgDB::writeImageFile(*pair.traced, std::string(folder) + "/" + name + "-traced.png");
    }
    return pair;
}

/// Returns whether few pixels differ and no 8 x 8 pixels are plainly wrong: edges alone give up
/// to 12.
inline bool agree(const PicturePair& pair)
{
    UNSCOPED_INFO("mean difference " << pair.difference << ", worst tile " << pair.worst << ", "
                                     << pair.covered << " pixels covered");
    return pair.covered > 1000 && pair.difference < 2.0 && pair.worst < 24.0;
}

inline PicturePair checkSame(const std::string& name, const SceneMaker& makeScene,
                             const std::function<void(TestViewer&)>& setUp, int frames = 3)
{
    const PicturePair pair = picturePair(name, makeScene, setUp, frames);
    std::cout << name << ": mean difference " << pair.difference << "/255, worst tile "
              << pair.worst << ", " << pair.covered << " pixels covered" << std::endl;
    CHECK(agree(pair));
    return pair;
}

/// Sets a view of the plane z = 0 from above, askew.
inline void lookDown(TestViewer& view)
{
    normalize(view);
    view.look(osg::Vec3d(1.0, -2.0, 8.0), osg::Vec3d());
}

inline osg::ref_ptr<osg::MatrixTransform> at(const osg::Matrix& matrix, osg::Node* node)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(node);
    return transform;
}

} // namespace osgRayTrace::test
