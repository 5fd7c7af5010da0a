// PicturePair.h - one scene as OSG draws it and as it is traced, by the same viewer. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "TestViewer.h"

#include <osgDB/WriteFile>

#include <cstdlib>
#include <functional>
#include <string>

namespace osgRayTrace::test
{

constexpr int kPairWidth = 320, kPairHeight = 240;
constexpr int kPairSamples =
    4; ///< a pixel and axis, of the rasterized picture: the traced one is antialiased

/// Means of kPairSamples * kPairSamples pixels.
inline osg::ref_ptr<osg::Image> reduced(const osg::Image& image)
{
    osg::ref_ptr<osg::Image> small = new osg::Image;
    small->allocateImage(kPairWidth, kPairHeight, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < kPairHeight; ++y)
        for (int x = 0; x < kPairWidth; ++x)
        {
            osg::Vec4 sum;
            for (int i = 0; i < kPairSamples * kPairSamples; ++i)
                sum += pixel(image, x * kPairSamples + i % kPairSamples,
                             y * kPairSamples + i / kPairSamples);
            for (int c = 0; c < 4; ++c)
                small->data(x, y)[c] =
                    static_cast<unsigned char>(sum[c] / (kPairSamples * kPairSamples) + 0.5f);
        }
    return small;
}

struct PicturePair
{
    osg::ref_ptr<osg::Image> rasterized, traced;
    Statistics statistics;
    double difference = 0.0; ///< mean over all pixels, 0 to 255
    double worst = 0.0; ///< mean of the worst 8 x 8 pixels: what a cluster that is wrong would show
    long covered = 0;   ///< pixels of the rasterized picture that are not background

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

/// Light by normals of unit length, as traced: OpenGL's own depends on how a transform scales them.
inline void normalize(TestViewer& view)
{
    view.camera().getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
}

/// Both pictures of frame number `frames`, so that OSG may have prepared, loaded and animated; of
/// two scenes made alike, as a viewer leaves its mark on one: images are let go, particles keep the
/// time. Shadows are off. With OSGRAYTRACE_TEST_PICTURES both are written there, to be looked at.
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
        pair.rasterized = reduced(*view.frames(0));
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
    if (const char* folder = std::getenv("OSGRAYTRACE_TEST_PICTURES"))
    {
        osgDB::writeImageFile(*pair.rasterized, std::string(folder) + "/" + name + "-osg.png");
        osgDB::writeImageFile(*pair.traced, std::string(folder) + "/" + name + "-traced.png");
    }
    return pair;
}

} // namespace osgRayTrace::test
